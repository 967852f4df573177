//! Which way a person in a side view faces.

use super::layout::{Keypoint, Part, Side};
use crate::cyclic::image_joints::{ImageJoints, Point};
use crate::motion::joint_names::{HIP_CENTER, JOINTS, NECK};

/// Direction in the image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "command", derive(clap::ValueEnum))]
pub enum Facing {
    /// Towards smaller u.
    Left,
    /// Towards larger u.
    Right,
}

/// Way across the image, in lengths of the trunk, beyond which travel decides.
const TRAVEL_TRUNKS: f64 = 1.5;

/// Travel decides if the person gets far enough. Next come toes before heels (or ankles), then the
/// nose before the neck, then knees before the line from hip to ankle. Each is a sum over all
/// frames. `None` if none of these was seen.
#[must_use]
pub fn find(joints: &ImageJoints, people: &[Option<&Vec<Keypoint>>]) -> Option<Facing> {
    let hints = [travel(joints), sum_over(people, toes), sum_over(people, nose), knees(joints)];
    let hint = hints.into_iter().flatten().find(|hint| *hint != 0.0)?;
    Some(if hint < 0.0 { Facing::Left } else { Facing::Right })
}

/// Way of the root if it is long enough.
fn travel(joints: &ImageJoints) -> Option<f64> {
    let roots: Vec<Point> = joints.frames.iter().filter_map(|frame| frame.joints[HIP_CENTER]).collect();
    let trunk = |joints: &[Option<Point>; JOINTS]| {
        let (neck, hip) = (joints[NECK]?, joints[HIP_CENTER]?);
        Some((neck[0] - hip[0]).hypot(neck[1] - hip[1]))
    };
    let trunks: Vec<f64> = joints.frames.iter().filter_map(|frame| trunk(&frame.joints)).collect();
    if trunks.is_empty() {
        return None;
    }
    let way = roots.last()?[0] - roots.first()?[0];
    let mean_trunk = trunks.iter().sum::<f64>() / trunks.len() as f64;
    (way.abs() > TRAVEL_TRUNKS * mean_trunk).then_some(way)
}

fn sum_over(people: &[Option<&Vec<Keypoint>>], hint: fn(&[Keypoint]) -> Option<f64>) -> Option<f64> {
    let hints: Vec<f64> = people.iter().flatten().filter_map(|person| hint(person)).collect();
    (!hints.is_empty()).then(|| hints.iter().sum())
}

fn place(person: &[Keypoint], part: Part) -> Option<f64> {
    person.iter().find(|keypoint| keypoint.part == part).map(|keypoint| keypoint.position_px[0])
}

fn toes(person: &[Keypoint]) -> Option<f64> {
    let foot = |side: Side, ankle: usize| {
        let back = place(person, Part::Heel(side)).or_else(|| place(person, Part::Joint(ankle)));
        Some(place(person, Part::Toe(side))? - back?)
    };
    let feet = [foot(Side::Left, 10), foot(Side::Right, 13)];
    feet.iter().any(Option::is_some).then(|| feet.iter().flatten().sum())
}

fn nose(person: &[Keypoint]) -> Option<f64> {
    let shoulders = || Some((place(person, Part::Joint(2))? + place(person, Part::Joint(5))?) / 2.0);
    Some(place(person, Part::Nose)? - place(person, Part::Joint(NECK)).or_else(shoulders)?)
}

/// How far the knees stand before the middle of hip and ankle.
fn knees(joints: &ImageJoints) -> Option<f64> {
    let leg = |joints: &[Option<Point>; JOINTS], hip: usize| {
        let (hip, knee, ankle) = (joints[hip]?, joints[hip + 1]?, joints[hip + 2]?);
        let share = if ankle[1] == hip[1] { 0.5 } else { ((knee[1] - hip[1]) / (ankle[1] - hip[1])).clamp(0.0, 1.0) };
        Some(knee[0] - (hip[0] + share * (ankle[0] - hip[0])))
    };
    let bends: Vec<f64> =
        joints.frames.iter().flat_map(|frame| [leg(&frame.joints, 8), leg(&frame.joints, 11)]).flatten().collect();
    (!bends.is_empty()).then(|| bends.iter().sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::image_joints::JointFrame;

    fn joints(speed: f64, knee: f64) -> ImageJoints {
        let frame = |frame: u64| {
            let u = speed * frame as f64;
            let mut joints = [None; JOINTS];
            joints[HIP_CENTER] = Some([u, 100.0]);
            joints[NECK] = Some([u, 50.0]);
            (joints[8], joints[9], joints[10]) = (Some([u, 100.0]), Some([u + knee, 140.0]), Some([u, 180.0]));
            JointFrame { frame, joints, feet: Default::default() }
        };
        ImageJoints { frames: (0..30).map(frame).collect(), unit: "px" }
    }

    fn point(part: Part, u: f64) -> Keypoint {
        Keypoint { part, position_px: [u, 0.0], confidence: 1.0 }
    }

    #[test]
    fn travel_counts_before_toes_before_nose_before_knees() {
        let toes_left = vec![point(Part::Toe(Side::Left), 3.0), point(Part::Heel(Side::Left), 9.0)];
        let nose_right = [toes_left.clone(), vec![point(Part::Nose, 9.0), point(Part::Joint(NECK), 3.0)]].concat();
        assert_eq!(find(&joints(4.0, -5.0), &[Some(&nose_right)]), Some(Facing::Right));
        assert_eq!(find(&joints(0.5, 5.0), &[Some(&nose_right)]), Some(Facing::Left));
        let nose_only = nose_right[2..].to_vec();
        assert_eq!(find(&joints(0.0, -5.0), &[None, Some(&nose_only)]), Some(Facing::Right));
        assert_eq!(find(&joints(0.0, -5.0), &[]), Some(Facing::Left));
        assert_eq!(find(&joints(0.0, 0.0), &[]), None);
    }
}
