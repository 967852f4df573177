//! One JSON file with one flat list of numbers a frame: x, y and confidence of each point of one
//! person. Nothing in it names the points.

use super::error::KeypointError;
use super::orders::{self, PointFrame};
use super::point_values::triples;
use serde_json::Value;
use std::path::Path;

/// Reads the frame `index`, counted from 0. An empty list or null is a frame without a person.
///
/// # Errors
/// Names the frame and the rule that it broke.
pub fn frame(value: &Value, index: usize, path: &Path) -> Result<PointFrame, KeypointError> {
    let broken = |rule: String| KeypointError::broken(path, format!("frame {index}"), rule);
    let values = if value.is_null() { Some(Vec::new()) } else { triples(value, None) };
    let values = values.ok_or_else(|| broken("has to be a list of numbers x, y, confidence".into()))?;
    let people = if values.is_empty() { Vec::new() } else { vec![orders::points(&values).map_err(broken)?] };
    Ok(PointFrame { frame: index as u64, people })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn read(value: &Value) -> Result<Vec<PointFrame>, String> {
        let frames = value.as_array().unwrap().iter().enumerate();
        let frames = frames.map(|(index, value)| frame(value, index, Path::new("k.json")));
        frames.collect::<Result<_, _>>().map_err(|error| error.to_string())
    }

    #[test]
    fn a_frame_is_a_list_of_numbers_or_nothing() {
        let flat: Vec<f64> = (0..7).flat_map(|i| [f64::from(i) + 1.0, 5.0, 0.5]).collect();
        let frames = read(&json!([flat, null, [], flat])).unwrap();
        let counts: Vec<(u64, usize)> = frames.iter().map(|frame| (frame.frame, frame.people.len())).collect();
        assert_eq!(counts, [(0, 1), (1, 0), (2, 0), (3, 1)]);
        assert_eq!(frames[0].people[0][6], [7.0, 5.0, 0.5]);
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
