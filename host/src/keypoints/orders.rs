//! In which order detectors write their points.

use super::detections::Detections;
use super::layout::{DetectedFrame, Keypoint, Part, Side, check_position};
use crate::motion::joint_names::{HIP_CENTER, NECK};
use sinew_core::skeleton::stick_figure::HUMAN;
use std::collections::BTreeMap;

/// x, y and confidence of each point of one person; NaN where a point was not found.
pub type Points = Vec<[f64; 3]>;

/// Everybody in one frame, their points not named yet.
#[derive(Debug, Clone, PartialEq)]
pub struct PointFrame {
    /// Number of the frame in the recording.
    pub frame: u64,
    /// The people, in the detector's order.
    pub people: Vec<Points>,
}

/// An order of points.
#[derive(Debug)]
struct Order {
    name: &'static str,
    /// Its short name, for programs.
    key: &'static str,
    /// How many points there are. Those after `parts` are not used.
    count: usize,
    /// Short names of the parts, see [`part`].
    parts: &'static str,
}

/// COCO: face, then left and right shoulders, elbows, wrists, hips, knees, ankles.
const COCO: &str = "nose - - - - ls rs le re lw rw lh rh lk rk la ra";
/// What HALPE adds to COCO: head, neck, hip centre, big toes, small toes, heels.
const HALPE: &str = "nose - - - - ls rs le re lw rw lh rh lk rk la ra - neck mid lt rt - - lhl rhl";
/// What COCO-WholeBody adds to COCO: big toe, small toe, heel of the left foot, then of the right.
const WHOLE_BODY: &str = "nose - - - - ls rs le re lw rw lh rh lk rk la ra lt - lhl rt - rhl";
/// OpenPose `BODY_25B`: COCO, upper neck, head, feet. The upper neck lies above the shoulders'
/// middle.
const BODY_25B: &str = "nose - - - - ls rs le re lw rw lh rh lk rk la ra - - lt - lhl rt - rhl";

/// All orders; of those with as many points the usual one is first. Sources are the documentations
/// of the detectors and data sets that the names say.
const ORDERS: [Order; 18] = [
    Order { name: "head and arms", key: "arms7", count: 7, parts: "- rs re rw ls le lw" },
    Order { name: "CrowdPose", key: "crowdpose14", count: 14, parts: "ls rs le re lw rw lh rh lk rk la ra - neck" },
    Order { name: "LSP", key: "lsp14", count: 14, parts: "ra rk rh lh lk la rw re rs ls le lw neck -" },
    Order { name: "AI Challenger", key: "aic14", count: 14, parts: "rs re rw ls le lw rh rk ra lh lk la - neck" },
    Order { name: "OpenPose MPI", key: "mpi15", count: 15, parts: "- neck rs re rw ls le lw rh rk ra lh lk la -" },
    Order { name: "MPII", key: "mpii16", count: 16, parts: "ra rk rh lh lk la mid neck - - rw re rs ls le lw" },
    Order { name: "COCO", key: "coco17", count: 17, parts: COCO },
    Order { name: "Human3.6M", key: "h36m17", count: 17, parts: "mid rh rk ra lh lk la - neck - - ls le lw rs re rw" },
    Order {
        name: "OpenPose COCO",
        key: "openpose18",
        count: 18,
        parts: "nose neck rs re rw ls le lw rh rk ra lh lk la",
    },
    Order {
        name: "COCO and neck",
        key: "coco18",
        count: 18,
        parts: "nose - - - - ls rs le re lw rw lh rh lk rk la ra neck",
    },
    Order { name: "COCO and feet", key: "coco23", count: 23, parts: WHOLE_BODY },
    Order {
        name: "OpenPose BODY_25",
        key: "body25",
        count: 25,
        parts: "nose neck rs re rw ls le lw mid rh rk ra lh lk la - - - - lt - lhl rt - rhl",
    },
    Order { name: "OpenPose BODY_25B", key: "body25b", count: 25, parts: BODY_25B },
    Order { name: "HALPE", key: "halpe26", count: 26, parts: HALPE },
    Order {
        name: "MediaPipe",
        key: "mediapipe33",
        count: 33,
        parts: "nose - - - - - - - - - - ls rs le re lw rw - - - - - - lh rh lk rk la ra lhl rhl lt rt",
    },
    Order { name: "COCO-WholeBody", key: "wholebody133", count: 133, parts: WHOLE_BODY },
    Order { name: "OpenPose BODY_135", key: "body135", count: 135, parts: BODY_25B },
    Order { name: "HALPE full body", key: "halpe136", count: 136, parts: HALPE },
];

/// How many people are looked at to tell orders of as many points apart. Chosen: enough to average
/// out single wrong points, and no matter of time.
const MAX_LOOKED_AT: usize = 300;
/// The second best order is as good as the best if it is worse by less than this. Chosen: wrong
/// orders of the walks in the tests are worse by 0.5 and more.
const CLEARLY_WORSE: f64 = 0.1;
/// Share of a figure's mean segment that is added to lengths before they are compared. So points at
/// one place weigh no more than others. Chosen.
const SHORTEST_SHARE: f64 = 0.1;

/// The part of a short name: `l` or `r` before `s`houlder, `e`lbow, `w`rist, `h`ip, `k`nee,
/// `a`nkle, `t`oe and `hl` (heel).
fn part(short: &str) -> Part {
    let (side, rest) = match short.split_at(1) {
        ("l", rest) => (Side::Left, rest),
        ("r", rest) => (Side::Right, rest),
        _ => (Side::Left, ""),
    };
    let arm_or_leg = ["s", "e", "w", "h", "k", "a"].iter().position(|name| *name == rest);
    match (short, rest) {
        ("nose", _) => Part::Nose,
        ("neck", _) => Part::Joint(NECK),
        ("mid", _) => Part::Joint(HIP_CENTER),
        (_, "t") => Part::Toe(side),
        (_, "hl") => Part::Heel(side),
        _ => arm_or_leg.map_or(Part::Other, |joint| {
            // Left and right shoulders, elbows, wrists are the joints 2 to 7, the legs 8 to 13.
            let leg = if joint < 3 { 2 } else { 8 };
            Part::Joint(leg + joint % 3 + if side == Side::Right { 3 } else { 0 })
        }),
    }
}

impl Order {
    fn parts(&self) -> Vec<Part> {
        let named = self.parts.split(' ').map(part);
        named.chain(std::iter::repeat(Part::Other)).take(self.count).collect()
    }
}

/// The parts of the usual order of `count` points; `None` for a number that no order has.
#[must_use]
pub fn parts(count: usize) -> Option<Vec<Part>> {
    ORDERS.iter().find(|order| order.count == count).map(Order::parts)
}

/// What is said about a number of points that no order has.
#[must_use]
pub fn unknown_count(count: usize) -> String {
    let known: Vec<String> = ORDERS.iter().map(|order| format!("{} ({})", order.count, order.name)).collect();
    format!("{count} keypoints; {} are known; give a .csv table with the points' names", known.join(", "))
}

/// Points from a flat list x, y, confidence. Those that are not finite, or all zero as detectors
/// write what they did not find, are NaN.
///
/// # Errors
/// Says what is wrong with the list.
pub fn points(values: &[f64]) -> Result<Points, String> {
    if !values.len().is_multiple_of(3) {
        return Err(format!("{} numbers; each keypoint needs x, y and confidence", values.len()));
    }
    let count = values.len() / 3;
    let parts = parts(count).ok_or_else(|| unknown_count(count))?;
    (0..).zip(parts).zip(values.chunks(3)).map(|(place, value)| found([value[0], value[1], value[2]], place)).collect()
}

/// A point with its number and part, as [`points`] gives it.
///
/// # Errors
/// A place that no picture has.
pub fn found(value: [f64; 3], (number, part): (usize, Part)) -> Result<[f64; 3], String> {
    let is_found = value.iter().all(|number| number.is_finite()) && (value[0] != 0.0 || value[1] != 0.0);
    if is_found {
        check_position([value[0], value[1]], part, &number.to_string())?;
    }
    Ok(if is_found { value } else { [f64::NAN; 3] })
}

/// The joints of the stick figure in their own order, which no detector writes.
const STICK_FIGURE: Order =
    Order { name: "stick figure", key: "stick14", count: 14, parts: "mid neck ls le lw rs re rw lh lk la rh rk ra" };

/// Short names of all orders.
pub fn keys() -> impl Iterator<Item = &'static str> {
    ORDERS.iter().chain([&STICK_FIGURE]).map(|order| order.key)
}

/// Name and parts of the order with this short name.
#[must_use]
pub fn by_key(key: &str) -> Option<(&'static str, Vec<Part>)> {
    let order = ORDERS.iter().chain([&STICK_FIGURE]).find(|order| order.key == key)?;
    Some((order.name, order.parts()))
}

/// Names the points. Of several orders with as many points it takes the one whose figure has short
/// segments, as long on the left as on the right. A wrong order joins other points.
#[must_use]
pub fn name_points(frames: &[PointFrame]) -> Detections {
    let mut samples: BTreeMap<usize, Vec<&Points>> = BTreeMap::new();
    for person in frames.iter().flat_map(|frame| &frame.people).filter(|person| !person.is_empty()) {
        let sample = samples.entry(person.len()).or_default();
        if sample.len() < MAX_LOOKED_AT {
            sample.push(person);
        }
    }
    let (mut notes, mut doubts, mut layouts) = (Vec::new(), Vec::new(), Vec::new());
    let mut parts_of: BTreeMap<usize, Vec<Part>> = BTreeMap::new();
    for (count, sample) in samples {
        let mut orders: Vec<(f64, &Order)> = ORDERS
            .iter()
            .filter(|order| order.count == count)
            .map(|order| (unlikeness(&order.parts(), &sample), order))
            .collect();
        let Some(usual) = orders.first().map(|(_, order)| order.name) else { continue };
        orders.sort_by(|a, b| a.0.total_cmp(&b.0));
        let best = orders[0];
        if best.1.name != usual {
            notes.push(format!("the {count} points are in the order {}, as where they lie shows", best.1.name));
        }
        if let Some(second) = orders.get(1).filter(|second| second.0 < best.0 + CLEARLY_WORSE) {
            doubts.push(format!(
                "{count} points may be in the order {} or {}; {} was taken: give a .csv table with the points' names",
                best.1.name, second.1.name, best.1.name
            ));
        }
        layouts.push(format!("{}, {count} points", best.1.name));
        parts_of.insert(count, best.1.parts());
    }
    let none = Vec::new();
    let person = |points: &Points| named(points, parts_of.get(&points.len()).unwrap_or(&none));
    let frames = frames
        .iter()
        .map(|frame| DetectedFrame { frame: frame.frame, people: frame.people.iter().map(person).collect() })
        .collect();
    Detections { frames, layout: layouts.join("; "), notes, doubts, ..Detections::default() }
}

/// Names points by parts that a table has named.
#[must_use]
pub fn named_by(frames: &[PointFrame], parts: &[Part]) -> Detections {
    let person = |points: &Points| named(points, parts);
    let frames = frames
        .iter()
        .map(|frame| DetectedFrame { frame: frame.frame, people: frame.people.iter().map(person).collect() })
        .collect();
    Detections { frames, layout: format!("{} named points", parts.len()), ..Detections::default() }
}

fn named(points: &Points, parts: &[Part]) -> Vec<Keypoint> {
    let found = points.iter().zip(parts).filter(|([u, v, _], _)| u.is_finite() && v.is_finite());
    found.map(|([u, v, confidence], &part)| Keypoint { part, position_px: [*u, *v], confidence: *confidence }).collect()
}

/// Logarithm of the mean length of the segments, and the mean of |log(left / right)|; infinite
/// where no segment is seen.
fn unlikeness(parts: &[Part], people: &[&Points]) -> f64 {
    let (mut total_px, mut segments, mut asymmetry, mut pairs) = (0.0, 0.0, 0.0, 0.0);
    for person in people {
        let joints = super::layout::stick_joints(&named(person, parts));
        let length = |joint: usize| {
            let parent = HUMAN.joints()[joint].parent.map_or(0, usize::from);
            let (a, b) = (joints[joint]?, joints[parent]?);
            Some((a[0] - b[0]).hypot(a[1] - b[1]))
        };
        let lengths: Vec<f64> = (1..joints.len()).filter_map(length).collect();
        let sum: f64 = lengths.iter().sum();
        total_px += sum;
        segments += lengths.len() as f64;
        let least = SHORTEST_SHARE * sum / lengths.len() as f64;
        for left in [2, 3, 4, 8, 9, 10] {
            if let (Some(left), Some(right), true) = (length(left), length(left + 3), least > 0.0) {
                asymmetry += ((left + least) / (right + least)).ln().abs();
                pairs += 1.0;
            }
        }
    }
    if total_px == 0.0 || pairs == 0.0 { f64::INFINITY } else { (total_px / segments).ln() + asymmetry / pairs }
}

#[cfg(test)]
mod tests;
