//! What makes a recording unfit for a side view's angles.

use super::facing::{self, CLEAR_TRUNKS, TRAVEL_TRUNKS};
use super::layout::Keypoint;
use crate::cyclic::facing::Facing;
use crate::cyclic::image_joints::{ImageJoints, Point};
use crate::motion::joint_names::{HIP_CENTER, NECK};

/// A way that turns more often turns with each cycle. Chosen: who walks to and fro before a camera
/// is cut at each turn, and a rower turns twice a cycle.
const MOST_TURNS: usize = 3;
/// Rate of a recording that does not say it, frames per second. Chosen: that of most videos.
const USUAL_RATE_HZ: f64 = 30.0;
/// For how long a person has to face the other way to have turned (the half second).
const TURN_S: f64 = 0.5;
/// Step of the root between two frames that nobody makes, in lengths of the trunk (the issue's).
const MAX_STEP_TRUNKS: f64 = 0.5;
/// Largest ratio of the long and the short lengths of a thigh or shank (the half).
const MAX_LENGTH_RATIO: f64 = 1.5;
/// The long and the short lengths are those that this share of the frames is beyond. Chosen: more
/// than single wrong points.
const OUTER_SHARE: f64 = 0.1;
/// How far the neck has to be below the hips, in lengths of the trunk. Chosen: who swims lies
/// level.
const MIN_BELOW_TRUNKS: f64 = 0.3;
/// Share of frames with the neck below the hips that is doubtful. Chosen.
const MAX_BELOW_SHARE: f64 = 0.1;
/// Fewest frames for shares of them. Chosen.
const MIN_FRAMES: usize = 10;
/// How near each other the middles and the ends of both limbs are where one limb was found twice,
/// in lengths of the limb. Chosen: noise of 1.5 % of the limb on each point is below it, and a
/// camera at 4 m shows two ankles that stand side by side 9 % apart.
const MAX_TWIN_SHARE: f64 = 0.05;
/// Share of the frames from which they are doubtful. Chosen: legs that pass each other are that
/// near in a tenth of a walk.
const MIN_TWIN_FRAMES: f64 = 0.5;
/// How far the end of a limb travels under its root for its motion to be doubted, in lengths of the
/// limb. Chosen: who stands does less, and a squat is beyond it.
const MIN_TWIN_TRAVEL: f64 = 0.2;
/// Limbs with the root, the middle and the end of the left and the right one.
const LIMBS: [(&str, &str, [[usize; 3]; 2]); 2] =
    [("leg", "knees and ankles", [[8, 9, 10], [11, 12, 13]]), ("arm", "elbows and wrists", [[2, 3, 4], [5, 6, 7]])];
/// Thighs and shanks by the joints at their ends.
const SEGMENTS: [(&str, usize, usize); 4] =
    [("left thigh", 8, 9), ("left shank", 9, 10), ("right thigh", 11, 12), ("right shank", 12, 13)];

/// One person over time.
pub struct Followed<'a> {
    /// The joints.
    pub joints: &'a ImageJoints,
    /// The person's points in each frame.
    pub people: &'a [Option<&'a Vec<Keypoint>>],
    /// Which way they face over all.
    pub facing: Option<Facing>,
    /// Frames per second where they are known.
    pub rate_hz: Option<f64>,
}

/// One sentence for each reason to doubt, with its remedy.
#[must_use]
pub fn find(followed: &Followed) -> Vec<String> {
    let Some(trunk_px) = facing::trunk_px(followed.joints).filter(|trunk| *trunk > 0.0) else { return Vec::new() };
    let doubts = [
        turn(followed, trunk_px)
            .or_else(|| turned_way(followed, trunk_px))
            .or_else(|| against_travel(followed, trunk_px)),
        below(followed, trunk_px),
        lengths(followed),
        jumps(followed, trunk_px),
    ];
    doubts.into_iter().flatten().chain(LIMBS.iter().filter_map(|limb| twins(followed, *limb))).collect()
}

/// The person moves away from where they face: the camera pans, or they walk backwards.
fn against_travel(followed: &Followed, trunk_px: f64) -> Option<String> {
    let way = facing::travel(followed.joints)?;
    let facing = followed.facing?;
    let is_against = (way < 0.0) == (facing == Facing::Right);
    let (faced, moved) = if way < 0.0 { ("right", "left") } else { ("left", "right") };
    is_against.then(|| {
        format!(
            "the person faces {faced} and moves {:.0} px ({:.1} trunks) to the {moved}: the camera pans, or they walk backwards; speeds and places in the picture are the camera's too",
            way.abs(),
            way.abs() / trunk_px
        )
    })
}

/// The facing changes for longer than half a second.
fn turn(followed: &Followed, trunk_px: f64) -> Option<String> {
    let window = ((followed.rate_hz.unwrap_or(USUAL_RATE_HZ) * TURN_S).round() as usize).clamp(3, 100_000);
    let hints: Vec<(u64, f64)> = followed
        .joints
        .frames
        .iter()
        .zip(followed.people)
        .filter_map(|(frame, person)| Some((frame.frame, facing::hint_px((*person)?)?)))
        .collect();
    // The mean of each half second with a clear side: its first frame and the side.
    let mut runs: Vec<(u64, bool)> = Vec::new();
    for window in hints.windows(window) {
        let mean = window.iter().map(|hint| hint.1).sum::<f64>() / window.len() as f64;
        let agreed = window.iter().filter(|hint| (hint.1 > 0.0) == (mean > 0.0)).count();
        // A half second is of one side if nearly all of its frames are.
        if mean.abs() > CLEAR_TRUNKS * trunk_px && agreed * 10 >= window.len() * 9 {
            let is_right = mean > 0.0;
            if runs.last().is_none_or(|last| last.1 != is_right) {
                runs.push((window[0].0, is_right));
            }
        }
    }
    let second = runs.get(1)?;
    Some(format!(
        "the person faces {} at first and {} from about frame {}: cut the recording there into two, and read each alone",
        if runs[0].1 { "right" } else { "left" },
        if second.1 { "right" } else { "left" },
        second.0
    ))
}

/// The person walks one way and back. Who goes there and back with each cycle, as on a rowing
/// machine, turns more often.
fn turned_way(followed: &Followed, trunk_px: f64) -> Option<String> {
    let roots: Vec<(u64, f64)> =
        followed.joints.frames.iter().filter_map(|frame| Some((frame.frame, frame.joints[HIP_CENTER]?[0]))).collect();
    let turns = turning_frames(&roots, TRAVEL_TRUNKS * trunk_px);
    let frame = turns.first().filter(|_| turns.len() <= MOST_TURNS)?;
    Some(format!("the person's way turns back at frame {frame}: cut the recording there into two, and read each alone"))
}

/// Frames at which a way that was `far` long goes back by as much.
fn turning_frames(way: &[(u64, f64)], far: f64) -> Vec<u64> {
    let (mut turns, mut sign) = (Vec::new(), 0.0);
    let Some(&(mut farthest)) = way.first() else { return turns };
    for &(frame, place) in way {
        let ahead = place - farthest.1;
        if sign == 0.0 && ahead.abs() > far || sign * ahead > 0.0 {
            (sign, farthest) = (ahead.signum(), (frame, place));
        } else if -sign * ahead > far {
            turns.push(farthest.0);
            (sign, farthest) = (-sign, (frame, place));
        }
    }
    turns
}

fn below(followed: &Followed, trunk_px: f64) -> Option<String> {
    let depths: Vec<f64> = followed
        .joints
        .frames
        .iter()
        .filter_map(|frame| Some(frame.joints[NECK]?[1] - frame.joints[HIP_CENTER]?[1]))
        .collect();
    let below = depths.iter().filter(|depth| **depth > MIN_BELOW_TRUNKS * trunk_px).count();
    (depths.len() >= MIN_FRAMES && below as f64 > MAX_BELOW_SHARE * depths.len() as f64).then(|| {
        format!(
            "the neck lies below the hips in {below} of {} frames: the picture is upside down, or points have wrong names; look at an overlay",
            depths.len()
        )
    })
}

/// A thigh or shank changes its length, measured in trunks.
fn lengths(followed: &Followed) -> Option<String> {
    let ratio = |&(name, start, end): &(&'static str, usize, usize)| {
        let mut lengths: Vec<f64> = followed
            .joints
            .frames
            .iter()
            .filter_map(|frame| {
                let trunk = apart(frame.joints[NECK]?, frame.joints[HIP_CENTER]?);
                Some(apart(frame.joints[start]?, frame.joints[end]?) / trunk).filter(|ratio| ratio.is_finite())
            })
            .collect();
        let [short, long] = inner_range(&mut lengths)?;
        (lengths.len() >= MIN_FRAMES && long > MAX_LENGTH_RATIO * short).then_some((name, short, long))
    };
    let (name, short, long) = SEGMENTS.iter().filter_map(ratio).max_by(|a, b| (a.2 / a.1).total_cmp(&(b.2 / b.1)))?;
    Some(format!(
        "the {name} is {short:.2} to {long:.2} trunks long: it is not seen from the side, or points are wrong; film square to the way, or look at an overlay"
    ))
}

/// Both limbs move, and the left one lies on the right one.
fn twins(followed: &Followed, (limb, names, sides): (&str, &str, [[usize; 3]; 2])) -> Option<String> {
    // Of both limbs from their roots: whether they are twins, and the left end in limb lengths.
    let seen: Vec<(bool, Point)> = followed
        .joints
        .frames
        .iter()
        .filter_map(|frame| {
            let [left, right] = sides.map(|side| side.map(|joint| frame.joints[joint]));
            let (left, right) = (all(left)?, all(right)?);
            let length_px = apart(left[0], left[1]) + apart(left[1], left[2]);
            let is_twin = (1..3).all(|joint| apart(left[joint], right[joint]) <= MAX_TWIN_SHARE * length_px);
            let end = [0, 1].map(|axis| (left[2][axis] - left[0][axis]) / length_px);
            Some((is_twin, end)).filter(|_| length_px > 0.0)
        })
        .collect();
    let travel = |axis: usize| {
        let mut places: Vec<f64> = seen.iter().map(|(_, end)| end[axis]).collect();
        inner_range(&mut places).map_or(0.0, |[low, high]| high - low)
    };
    let count = seen.iter().filter(|(is_twin, _)| *is_twin).count();
    let is_most = seen.len() >= MIN_FRAMES && count as f64 > MIN_TWIN_FRAMES * seen.len() as f64;
    (is_most && travel(0).max(travel(1)) > MIN_TWIN_TRAVEL).then(|| {
        format!(
            "left and right {names} lie within {:.0} % of the {limb}'s length of each other in {count} of {} frames: one {limb} was found twice, or both move together; look at an overlay, and compare no sides",
            100.0 * MAX_TWIN_SHARE,
            seen.len()
        )
    })
}

/// Smallest and largest of the numbers without the outer ones on both sides.
fn inner_range(numbers: &mut [f64]) -> Option<[f64; 2]> {
    numbers.sort_by(f64::total_cmp);
    let outer = (numbers.len() as f64 * OUTER_SHARE) as usize;
    Some([*numbers.get(outer)?, *numbers.get(numbers.len().checked_sub(1 + outer)?)?])
}

/// The points, if all are seen.
fn all(points: [Option<Point>; 3]) -> Option<[Point; 3]> {
    let [Some(a), Some(b), Some(c)] = points else { return None };
    Some([a, b, c])
}

fn apart(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// The root makes steps that are far from the usual ones.
fn jumps(followed: &Followed, trunk_px: f64) -> Option<String> {
    let roots: Vec<(u64, Point)> =
        followed.joints.frames.iter().filter_map(|frame| Some((frame.frame, frame.joints[HIP_CENTER]?))).collect();
    let steps: Vec<(u64, Point)> = roots
        .windows(2)
        .filter(|pair| pair[1].0 == pair[0].0 + 1)
        .map(|pair| (pair[1].0, [0, 1].map(|axis| pair[1].1[axis] - pair[0].1[axis])))
        .collect();
    let usual = [0, 1].map(|axis| {
        let mut along: Vec<f64> = steps.iter().map(|step| step.1[axis]).collect();
        along.sort_by(f64::total_cmp);
        along.get(along.len() / 2).copied().unwrap_or(0.0)
    });
    let is_jump =
        |step: &&(u64, Point)| (step.1[0] - usual[0]).hypot(step.1[1] - usual[1]) > MAX_STEP_TRUNKS * trunk_px;
    let mut jumps = steps.iter().filter(is_jump);
    let first = jumps.next()?;
    Some(format!(
        "the hips jump by more than half a trunk in {} frames, first in frame {}: another person, or a cut; choose with --person, or cut there",
        1 + jumps.count(),
        first.0
    ))
}

#[cfg(test)]
mod tests;
