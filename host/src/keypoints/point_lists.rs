//! One JSON file with one flat list of numbers a frame: x, y and confidence of each point of one
//! person. Nothing in it names the points.

use super::error::KeypointError;
use super::layout::{self, DetectedFrame};
use super::openpose::numbers;
use serde_json::Value;
use std::path::Path;

/// Reads the frame `index`, counted from 0. An empty list or null is a frame without a person.
///
/// # Errors
/// Names the frame and the rule that it broke.
pub fn frame(value: &Value, index: usize, path: &Path) -> Result<DetectedFrame, KeypointError> {
    let broken = |rule: String| KeypointError::broken(path, format!("frame {index}"), rule);
    let values = if value.is_null() { Some(Vec::new()) } else { numbers(value) };
    let values = values.ok_or_else(|| broken("has to be a list of numbers x, y, confidence".into()))?;
    let people = if values.is_empty() { Vec::new() } else { vec![layout::person(&values).map_err(broken)?] };
    Ok(DetectedFrame { frame: index as u64, people })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keypoints::layout::Part;
    use serde_json::json;

    fn read(value: &Value) -> Result<Vec<DetectedFrame>, String> {
        let frames = value.as_array().unwrap().iter().enumerate();
        let frames = frames.map(|(index, value)| frame(value, index, Path::new("k.json")));
        frames.collect::<Result<_, _>>().map_err(|error| error.to_string())
    }

    #[test]
    fn arms_of_seven_points_are_head_then_right_then_left() {
        let flat: Vec<f64> = (0..7).flat_map(|i| [f64::from(i) + 1.0, 5.0, 0.5]).collect();
        let frames = read(&json!([flat, null, [], flat])).unwrap();
        let counts: Vec<(u64, usize)> = frames.iter().map(|frame| (frame.frame, frame.people.len())).collect();
        assert_eq!(counts, [(0, 1), (1, 0), (2, 0), (3, 1)]);
        let parts: Vec<Part> = frames[0].people[0].iter().map(|point| point.part).collect();
        let joints = [5, 6, 7, 2, 3, 4].map(Part::Joint);
        assert_eq!(parts[1..], joints, "shoulder, elbow, wrist of the right, then of the left");
        assert_eq!(parts[0], Part::Other);
    }

    #[test]
    fn broken_frames_are_named() {
        assert!(
            read(&json!([[1.0, 2.0, 0.5]])).unwrap_err().contains("k.json: frame 0: 1 keypoints; 7 (head and arms)")
        );
        assert!(read(&json!([[], [1.0, 2.0]])).unwrap_err().contains("frame 1: 2 numbers; each keypoint needs"));
        assert!(read(&json!([[], ["x"]])).unwrap_err().contains("frame 1: has to be a list of numbers"));
        assert!(read(&json!([[], 3])).unwrap_err().contains("frame 1: has to be a list of numbers"));
    }
}
