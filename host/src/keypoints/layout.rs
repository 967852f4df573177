//! Keypoints of a body, by name.

use crate::cyclic::image_joints::Point;
use crate::limits::MAX_NUMBER;
use crate::motion::joint_names::{HIP_CENTER, HIPS, JOINTS, NECK, SHOULDERS};
use sinew_core::skeleton::stick_figure::HUMAN;

/// A point of the body that a detector can find.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// A joint of the stick figure, by its number.
    Joint(usize),
    /// The nose.
    Nose,
    /// The tip of a big toe, left or right.
    Toe(Side),
    /// A heel.
    Heel(Side),
    /// Something that is not used (eyes, ears, small toes, fingers).
    Other,
}

/// A side of the body: the person's own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Left.
    Left,
    /// Right.
    Right,
}

/// A point that was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Keypoint {
    /// What it is.
    pub part: Part,
    /// Where it is, pixels: u right, v down.
    pub position_px: Point,
    /// How sure the detector was, from 0; 1 where it does not say.
    pub confidence: f64,
}

/// Everybody in one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct DetectedFrame {
    /// Number of the frame in the recording.
    pub frame: u64,
    /// The people, in the detector's order.
    pub people: Vec<Vec<Keypoint>>,
}

/// Refuses a place that no picture has. `keypoint` is its number or column.
///
/// # Errors
/// Names the keypoint, its part and the place.
pub fn check_position(position_px: Point, part: Part, keypoint: &str) -> Result<(), String> {
    if position_px.iter().all(|coordinate| coordinate.abs() <= f64::from(MAX_NUMBER)) {
        return Ok(());
    }
    let [u, v] = position_px;
    let name = part_name(part);
    Err(format!("keypoint `{keypoint}` ({name}) lies at ({u:e}, {v:e}), and {MAX_NUMBER:e} pixels are the most"))
}

/// The part in words.
fn part_name(part: Part) -> String {
    match part {
        Part::Joint(joint) => HUMAN.joints()[joint].name.to_owned(),
        Part::Nose => "nose".to_owned(),
        Part::Toe(side) => format!("{side:?} toe").to_lowercase(),
        Part::Heel(side) => format!("{side:?} heel").to_lowercase(),
        Part::Other => "not used".to_owned(),
    }
}

/// The frame without points of which the detector was less sure than `min_confidence`, and without
/// people of none.
#[must_use]
pub fn sure_of(frame: &DetectedFrame, min_confidence: f64) -> DetectedFrame {
    let keep = |person: &Vec<Keypoint>| -> Vec<Keypoint> {
        let sure = |keypoint: &&Keypoint| keypoint.confidence >= min_confidence && keypoint.part != Part::Other;
        person.iter().filter(sure).copied().collect()
    };
    let people = frame.people.iter().map(keep).filter(|person| !person.is_empty()).collect();
    DetectedFrame { frame: frame.frame, people }
}

/// The joints of the stick figure; neck and hip centre are the middle of shoulders and hips where
/// the detector has none.
#[must_use]
pub fn stick_joints(person: &[Keypoint]) -> [Option<Point>; JOINTS] {
    let mut joints = [None; JOINTS];
    for keypoint in person {
        if let Part::Joint(number) = keypoint.part {
            joints[number] = Some(keypoint.position_px);
        }
    }
    for (middle, sides) in [(NECK, SHOULDERS), (HIP_CENTER, HIPS)] {
        if let (None, Some(left), Some(right)) = (joints[middle], joints[sides[0]], joints[sides[1]]) {
            joints[middle] = Some([(left[0] + right[0]) / 2.0, (left[1] + right[1]) / 2.0]);
        }
    }
    joints
}
