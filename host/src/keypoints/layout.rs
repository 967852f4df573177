//! Which keypoint of a detector is which: the orders of COCO, OpenPose and HALPE.

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

const fn joint(number: usize) -> Part {
    Part::Joint(number)
}

/// Head and arms of a swimmer, 7 points: head, shoulder, elbow and wrist of the right arm, then of
/// the left.
const HEAD_AND_ARMS: [Part; 7] = [Part::Other, joint(5), joint(6), joint(7), joint(2), joint(3), joint(4)];

/// COCO, 17 points: face, then left and right shoulders, elbows, wrists, hips, knees, ankles.
const COCO_17: [Part; 17] = [
    Part::Nose,
    Part::Other,
    Part::Other,
    Part::Other,
    Part::Other,
    joint(2),
    joint(5),
    joint(3),
    joint(6),
    joint(4),
    joint(7),
    joint(8),
    joint(11),
    joint(9),
    joint(12),
    joint(10),
    joint(13),
];

/// What HALPE-26 adds to COCO: head, neck, hip centre, big toes, small toes, heels.
const HALPE_TAIL: [Part; 9] = [
    Part::Other,
    joint(NECK),
    joint(HIP_CENTER),
    Part::Toe(Side::Left),
    Part::Toe(Side::Right),
    Part::Other,
    Part::Other,
    Part::Heel(Side::Left),
    Part::Heel(Side::Right),
];

/// What COCO-WholeBody adds next: feet (big toe, small toe, heel of the left, then of the right).
const WHOLE_BODY_FEET: [Part; 6] = [
    Part::Toe(Side::Left),
    Part::Other,
    Part::Heel(Side::Left),
    Part::Toe(Side::Right),
    Part::Other,
    Part::Heel(Side::Right),
];

/// OpenPose with the COCO network, 18 points.
const OPENPOSE_18: [Part; 14] = [
    Part::Nose,
    joint(NECK),
    joint(5),
    joint(6),
    joint(7),
    joint(2),
    joint(3),
    joint(4),
    joint(11),
    joint(12),
    joint(13),
    joint(8),
    joint(9),
    joint(10),
];

/// OpenPose `BODY_25`.
const BODY_25: [Part; 25] = [
    Part::Nose,
    joint(NECK),
    joint(5),
    joint(6),
    joint(7),
    joint(2),
    joint(3),
    joint(4),
    joint(HIP_CENTER),
    joint(11),
    joint(12),
    joint(13),
    joint(8),
    joint(9),
    joint(10),
    Part::Other,
    Part::Other,
    Part::Other,
    Part::Other,
    Part::Toe(Side::Left),
    Part::Other,
    Part::Heel(Side::Left),
    Part::Toe(Side::Right),
    Part::Other,
    Part::Heel(Side::Right),
];

/// The parts of a person with `count` points; `None` for a number that no layout here has.
#[must_use]
pub fn parts(count: usize) -> Option<Vec<Part>> {
    let parts = match count {
        7 => HEAD_AND_ARMS.to_vec(),
        17 => COCO_17.to_vec(),
        18 => OPENPOSE_18.to_vec(),
        25 => BODY_25.to_vec(),
        26 => [&COCO_17[..], &HALPE_TAIL[..]].concat(),
        133 => [&COCO_17[..], &WHOLE_BODY_FEET[..]].concat(),
        _ => return None,
    };
    let rest = count - parts.len();
    Some(parts.into_iter().chain(std::iter::repeat_n(Part::Other, rest)).collect())
}

/// What is said about a number of points that no layout has.
#[must_use]
pub fn unknown_count(count: usize) -> String {
    format!(
        "{count} keypoints; 7 (head and arms), 17 (COCO), 18 (OpenPose COCO), 25 (OpenPose BODY_25), 26 (HALPE) and 133 (COCO-WholeBody) are known"
    )
}

/// A person from a flat list x, y, confidence; points that are not finite, or all zero as detectors
/// write what they did not find, are left out.
///
/// # Errors
/// Says what is wrong with the list.
pub fn person(values: &[f64]) -> Result<Vec<Keypoint>, String> {
    if !values.len().is_multiple_of(3) {
        return Err(format!("{} numbers; each keypoint needs x, y and confidence", values.len()));
    }
    let count = values.len() / 3;
    let parts = parts(count).ok_or_else(|| unknown_count(count))?;
    let mut found = Vec::with_capacity(count);
    for (number, (part, value)) in parts.into_iter().zip(values.chunks(3)).enumerate() {
        let is_found = value.iter().all(|number| number.is_finite()) && (value[0] != 0.0 || value[1] != 0.0);
        if is_found {
            check_position([value[0], value[1]], part, &number.to_string())?;
            found.push(Keypoint { part, position_px: [value[0], value[1]], confidence: value[2] });
        }
    }
    Ok(found)
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Points at (number + 1, 10) with confidence 0.9.
    fn numbered(count: usize) -> Vec<Keypoint> {
        let values: Vec<f64> = (0..count).flat_map(|i| [i as f64 + 1.0, 10.0, 0.9]).collect();
        person(&values).unwrap()
    }

    fn joints(count: usize) -> [Option<f64>; JOINTS] {
        stick_joints(&numbered(count)).map(|joint| joint.map(|[u, _]| u - 1.0))
    }

    #[test]
    fn each_layout_has_its_order() {
        let coco = [11.5, 5.5, 5.0, 7.0, 9.0, 6.0, 8.0, 10.0, 11.0, 13.0, 15.0, 12.0, 14.0, 16.0];
        assert_eq!(joints(17), coco.map(Some));
        assert_eq!(joints(133), coco.map(Some));
        let mut halpe = coco;
        (halpe[HIP_CENTER], halpe[NECK]) = (19.0, 18.0);
        assert_eq!(joints(26), halpe.map(Some));
        let body_25 = [8.0, 1.0, 5.0, 6.0, 7.0, 2.0, 3.0, 4.0, 12.0, 13.0, 14.0, 9.0, 10.0, 11.0];
        assert_eq!(joints(25), body_25.map(Some));
        let openpose_18 = [9.5, 1.0, 5.0, 6.0, 7.0, 2.0, 3.0, 4.0, 11.0, 12.0, 13.0, 8.0, 9.0, 10.0];
        assert_eq!(joints(18), openpose_18.map(Some));
        assert!(person(&[0.0; 24]).unwrap_err().starts_with("8 keypoints; 7 (head and arms), 17 (COCO)"));
        assert!(person(&[0.0; 50]).unwrap_err().contains("x, y and confidence"));
    }

    #[test]
    fn places_that_no_picture_has_are_refused_by_name() {
        let mut values: Vec<f64> = (0..17).flat_map(|i| [f64::from(i) + 1.0, 10.0, 0.9]).collect();
        values[3 * 9] = 1.0e308;
        let message = person(&values).unwrap_err();
        assert_eq!(message, "keypoint `9` (l_wrist) lies at (1e308, 1e1), and 1e9 pixels are the most");
        values[3 * 9] = -1.0e9;
        assert!(person(&values).is_ok());
    }

    #[test]
    fn points_that_were_not_found_are_missing() {
        let mut values: Vec<f64> = (0..17).flat_map(|i| [f64::from(i) + 1.0, 10.0, 0.9]).collect();
        values[15..18].copy_from_slice(&[0.0, 0.0, 0.0]);
        values[21] = f64::NAN;
        values[29] = 0.1;
        let frame = DetectedFrame { frame: 0, people: vec![person(&values).unwrap()] };
        let found = stick_joints(&sure_of(&frame, 0.3).people[0]);
        assert!(found[2].is_none() && found[3].is_none() && found[4].is_none() && found[NECK].is_none());
        assert!(found[5].is_some());
        assert!(sure_of(&frame, 0.95).people.is_empty());
    }
}
