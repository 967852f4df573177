//! Left and right that a detector exchanged in some frames: found by how smoothly limbs move, and
//! mended.
//!
//! For the legs and for the arms, each frame is either as the detector says or exchanged. The path
//! of least cost (Viterbi 1967) weighs how far points are from where the two frames before let them
//! expect to be. Against that it sets a price for each exchanged frame and for each change.

use super::layout::{Keypoint, Part, Side};
use crate::cyclic::image_joints::Point;

/// Points of the left and of the right limb.
type Pair = [Part; 2];

const fn pair(left: usize) -> Pair {
    [Part::Joint(left), Part::Joint(left + 3)]
}

const LEGS: [Pair; 5] = [
    pair(8),
    pair(9),
    pair(10),
    [Part::Toe(Side::Left), Part::Toe(Side::Right)],
    [Part::Heel(Side::Left), Part::Heel(Side::Right)],
];
const ARMS: [Pair; 3] = [pair(2), pair(3), pair(4)];

/// Points of a pair farther apart in time than this are not compared, frames. Chosen: over longer
/// gaps a step may have been made.
const MAX_GAP_FRAMES: u64 = 3;
/// Price of a change between as-said and exchanged. Chosen: 8 to 20 find the same frames of the
/// walk in the tests; less takes legs that cross for exchanged.
const CHANGE_COST: f64 = 12.0;
/// Price of an exchanged frame. Chosen: most frames are right, and an exchange of 100 frames is
/// still found by its two ends.
const EXCHANGED_COST: f64 = 0.5;
/// Smallest standard deviation of a point's second difference, in lengths of the trunk. Chosen: a
/// detector's pixel noise is larger.
const MIN_STD_TRUNKS: f64 = 0.03;
/// Share of the misfits from which the standard deviation is taken, and the quantile of chi-square
/// at that share. Chi-square has four degrees of freedom (four coordinates). Feet accelerate much
/// in a small part of a cycle, which the median would not see.
const STD_QUANTILE: (f64, f64) = (0.75, 5.39);

/// Frames in which limbs were exchanged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Mended {
    /// Frames in which the legs were.
    pub legs: usize,
    /// Frames in which the arms were.
    pub arms: usize,
    /// Frames in which either was.
    pub frames: usize,
}

/// Finds exchanged legs and arms of one person and mends them. `frames` are the numbers of the
/// frames, `trunk_px` is the length of the trunk.
pub fn mend(frames: &[u64], people: &mut [Option<Vec<Keypoint>>], trunk_px: f64) -> Mended {
    let [legs, arms] = [&LEGS[..], &ARMS[..]].map(|pairs| exchanged(frames, people, pairs, trunk_px));
    for (pairs, exchanged) in [(&LEGS[..], &legs), (&ARMS[..], &arms)] {
        for (person, _) in people.iter_mut().zip(exchanged).filter(|(_, exchanged)| **exchanged) {
            person.iter_mut().flatten().for_each(|keypoint| exchange(keypoint, pairs));
        }
    }
    let count = |exchanged: &[bool]| exchanged.iter().filter(|exchanged| **exchanged).count();
    let either: Vec<bool> = legs.iter().zip(&arms).map(|(legs, arms)| *legs || *arms).collect();
    Mended { legs: count(&legs), arms: count(&arms), frames: count(&either) }
}

fn exchange(keypoint: &mut Keypoint, pairs: &[Pair]) {
    for [left, right] in pairs {
        if keypoint.part == *left {
            keypoint.part = *right;
            return;
        }
        if keypoint.part == *right {
            keypoint.part = *left;
            return;
        }
    }
}

/// One frame of the limbs: both points of each pair where both were seen.
struct Seen {
    index: usize,
    frame: u64,
    points: Vec<Option<[Point; 2]>>,
    /// Mean confidence of the points, at most 1.
    confidence: f64,
}

fn seen(frames: &[u64], people: &[Option<Vec<Keypoint>>], pairs: &[Pair]) -> Vec<Seen> {
    let mut all = Vec::new();
    for (index, (frame, person)) in frames.iter().zip(people).enumerate() {
        let Some(person) = person else { continue };
        let find = |part: Part| person.iter().find(|keypoint| keypoint.part == part);
        let both = |pair: &Pair| Some([find(pair[0])?, find(pair[1])?]);
        let found: Vec<Option<[&Keypoint; 2]>> = pairs.iter().map(both).collect();
        let points: Vec<&Keypoint> = found.iter().flatten().flatten().copied().collect();
        if points.is_empty() {
            continue;
        }
        let confidence = points.iter().map(|point| point.confidence).sum::<f64>() / points.len() as f64;
        all.push(Seen {
            index,
            frame: *frame,
            points: found.iter().map(|pair| pair.map(|pair| pair.map(|point| point.position_px))).collect(),
            confidence: confidence.clamp(0.0, 1.0),
        });
    }
    all
}

/// How far the points of a pair are from where `before` and `first` let them expect to be, squared
/// and summed. Each of the three frames is `exchanged` or not.
fn misfit_px2(frames: [&Seen; 3], pair: usize, exchanged: [bool; 3]) -> Option<f64> {
    let [first, before, now] = frames;
    let (step, last) = (now.frame - before.frame, before.frame - first.frame);
    if step > MAX_GAP_FRAMES || last > MAX_GAP_FRAMES || last == 0 {
        return None;
    }
    let ahead = step as f64 / last as f64;
    let points: Vec<[Point; 2]> = frames.iter().map(|frame| frame.points[pair]).collect::<Option<_>>()?;
    let of_side = |side: usize| {
        let place = |index: usize| points[index][side ^ usize::from(exchanged[index])];
        let (first, before, now) = (place(0), place(1), place(2));
        let off = |axis: usize| now[axis] - before[axis] - ahead * (before[axis] - first[axis]);
        off(0) * off(0) + off(1) * off(1)
    };
    Some(of_side(0) + of_side(1))
}

/// The four ways in which three frames may differ; which of them is right does not matter.
const RELATIONS: [[bool; 3]; 4] =
    [[false, false, false], [false, false, true], [false, true, false], [false, true, true]];

/// Standard deviation of the misfit of one coordinate of each pair, of the smoothest relation of
/// each three frames, so that exchanges do not count.
fn deviations_px(seen: &[Seen], pairs: usize, trunk_px: f64) -> Vec<f64> {
    (0..pairs)
        .map(|pair| {
            let least = |three: &[Seen]| {
                let frames = [&three[0], &three[1], &three[2]];
                RELATIONS.iter().filter_map(|relation| misfit_px2(frames, pair, *relation)).reduce(f64::min)
            };
            let mut least: Vec<f64> = seen.windows(3).filter_map(least).collect();
            least.sort_by(f64::total_cmp);
            let (share, chi_square) = STD_QUANTILE;
            let quantile = least.get((least.len() as f64 * share) as usize).copied().unwrap_or(0.0);
            (quantile / chi_square).sqrt().max(MIN_STD_TRUNKS * trunk_px).max(f64::MIN_POSITIVE)
        })
        .collect()
}

/// Half of a sum of squares where it is small. It grows like its root where it is large, so that a
/// wrong point is no proof. Source: pseudo-Huber loss, Charbonnier et al. 1997.
fn robust(squares: f64) -> f64 {
    2.0 * ((1.0 + 0.5 * squares).sqrt() - 1.0)
}

/// Whether the limbs are exchanged in each frame.
fn exchanged(frames: &[u64], people: &[Option<Vec<Keypoint>>], pairs: &[Pair], trunk_px: f64) -> Vec<bool> {
    let mut found = vec![false; people.len()];
    let seen = seen(frames, people, pairs);
    if seen.len() < 3 {
        return found;
    }
    let deviations = deviations_px(&seen, pairs.len(), trunk_px);
    let path = least_path(seen.len(), |now, states| {
        let mut cost = if states[2] { EXCHANGED_COST * seen[now].confidence } else { 0.0 };
        let is_joined = now > 0 && seen[now].frame - seen[now - 1].frame <= MAX_GAP_FRAMES;
        if is_joined && states[1] != states[2] {
            cost += CHANGE_COST;
        }
        if now >= 2 {
            let three = [&seen[now - 2], &seen[now - 1], &seen[now]];
            for (pair, deviation) in deviations.iter().enumerate() {
                if let Some(misfit) = misfit_px2(three, pair, states) {
                    cost += robust(misfit / (deviation * deviation));
                }
            }
        }
        cost
    });
    for (seen, state) in seen.iter().zip(path) {
        found[seen.index] = state;
    }
    found
}

/// The states of `count` steps of the least sum of `cost(step, states of the last three)`.
fn least_path(count: usize, cost: impl Fn(usize, [bool; 3]) -> f64) -> Vec<bool> {
    const STATES: [bool; 2] = [false, true];
    // Sums by the states of the step before and of this one, and the state before these.
    let mut sums = [[0.0; 2]; 2];
    for state in STATES {
        // A first step has no step before: both are the same.
        let alone = cost(0, [state; 3]);
        sums[0][usize::from(state)] = alone;
        sums[1][usize::from(state)] = alone;
    }
    let mut from: Vec<[[bool; 2]; 2]> = Vec::with_capacity(count);
    for now in 1..count {
        let mut next = [[f64::INFINITY; 2]; 2];
        let mut chosen = [[false; 2]; 2];
        for state in STATES {
            for before in STATES {
                for first in STATES {
                    let sum = sums[usize::from(first)][usize::from(before)] + cost(now, [first, before, state]);
                    if sum < next[usize::from(before)][usize::from(state)] {
                        next[usize::from(before)][usize::from(state)] = sum;
                        chosen[usize::from(before)][usize::from(state)] = first;
                    }
                }
            }
        }
        sums = next;
        from.push(chosen);
    }
    let ends = STATES.iter().flat_map(|before| STATES.map(|state| (*before, state)));
    let least = ends
        .min_by(|a, b| sums[usize::from(a.0)][usize::from(a.1)].total_cmp(&sums[usize::from(b.0)][usize::from(b.1)]));
    let (mut before, mut state) = least.unwrap_or((false, false));
    let mut path = vec![state; count];
    for now in (1..count).rev() {
        path[now] = state;
        let first = from[now - 1][usize::from(before)][usize::from(state)];
        (before, state) = (first, before);
        path[now - 1] = state;
    }
    path
}

#[cfg(test)]
mod tests;
