//! OpenPose JSON: one file a frame, each with everybody in it. Pose2Sim and RTMLib write the same
//! form.

use super::error::{KeypointError, json, read_text};
use super::layout::{self, DetectedFrame};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Reads all JSON files of `folder` in natural order. A number at the end of each name (before
/// `_keypoints`) is the number of its frame, if these rise from file to file. If not, the files are
/// counted from 0.
///
/// # Errors
/// The folder has no JSON file, or one breaks a rule.
pub fn read_folder(folder: &Path) -> Result<Vec<DetectedFrame>, KeypointError> {
    let unreadable = |reason| KeypointError::Unreadable { path: folder.to_path_buf(), reason };
    let mut files: Vec<PathBuf> = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json")) {
            files.push(path);
        }
    }
    if files.is_empty() {
        return Err(KeypointError::unusable(folder, "has no .json file; give the folder that the pose detector wrote"));
    }
    files.sort_by(|a, b| natord::compare(&a.to_string_lossy(), &b.to_string_lossy()));
    let numbers = frame_numbers(&files);
    numbers
        .into_iter()
        .zip(&files)
        .map(|(frame, path)| Ok(DetectedFrame { frame, people: read_people(path)? }))
        .collect()
}

/// Number of each file's frame.
fn frame_numbers(files: &[PathBuf]) -> Vec<u64> {
    let number = |path: &PathBuf| -> Option<u64> {
        let stem = path.file_stem()?.to_string_lossy().into_owned();
        let stem = stem.strip_suffix("_keypoints").unwrap_or(&stem);
        let digits = stem.len() - stem.trim_end_matches(|letter: char| letter.is_ascii_digit()).len();
        stem.get(stem.len() - digits..)?.parse().ok()
    };
    let named: Option<Vec<u64>> = files.iter().map(number).collect();
    match named {
        Some(numbers) if numbers.windows(2).all(|pair| pair[0] < pair[1]) => numbers,
        _ => (0..files.len() as u64).collect(),
    }
}

fn read_people(path: &Path) -> Result<Vec<Vec<layout::Keypoint>>, KeypointError> {
    people(&json(&read_text(path)?, path)?, path)
}

/// Everybody in the value of one file.
///
/// # Errors
/// Names the person and the rule that it broke.
pub fn people(value: &Value, path: &Path) -> Result<Vec<Vec<layout::Keypoint>>, KeypointError> {
    let list = value.get("people").and_then(Value::as_array);
    let list = list.ok_or_else(|| KeypointError::unusable(path, "has no list `people`, so it is no OpenPose file"))?;
    let person = |(index, person): (usize, &Value)| {
        let place = format!("people[{index}].pose_keypoints_2d");
        let values = person.get("pose_keypoints_2d").and_then(numbers);
        let values =
            values.ok_or_else(|| KeypointError::broken(path, place.as_str(), "has to be a list of numbers"))?;
        if values.is_empty() {
            Ok(Vec::new())
        } else {
            layout::person(&values).map_err(|rule| KeypointError::broken(path, place, rule))
        }
    };
    list.iter().enumerate().map(person).collect()
}

/// A list of numbers, flat or one list a point; null is NaN.
pub(super) fn numbers(value: &Value) -> Option<Vec<f64>> {
    let number = |number: &Value| if number.is_null() { Some(f64::NAN) } else { number.as_f64() };
    let mut flat = Vec::new();
    for entry in value.as_array()? {
        match entry.as_array() {
            Some(point) => flat.extend(point.iter().map(number).collect::<Option<Vec<f64>>>()?),
            None => flat.push(number(entry)?),
        }
    }
    Some(flat)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(people: usize, shift: f64) -> String {
        let values: Vec<f64> = (0..25).flat_map(|i| [f64::from(i) + shift, 5.0, 0.8]).collect();
        let person = serde_json::json!({ "pose_keypoints_2d": values, "face_keypoints_2d": [] });
        serde_json::json!({ "version": 1.3, "people": vec![person; people] }).to_string()
    }

    #[test]
    fn frames_come_in_natural_order_with_their_numbers() {
        let folder = tempfile::tempdir().unwrap();
        for (number, people) in [(9, 1), (10, 2), (12, 0)] {
            std::fs::write(folder.path().join(format!("clip_{number}_keypoints.json")), file(people, 1.0)).unwrap();
        }
        std::fs::write(folder.path().join("notes.txt"), "no").unwrap();
        let frames = read_folder(folder.path()).unwrap();
        assert_eq!(
            frames.iter().map(|frame| (frame.frame, frame.people.len())).collect::<Vec<_>>(),
            [(9, 1), (10, 2), (12, 0)]
        );
        std::fs::write(folder.path().join("x.json"), file(1, 1.0)).unwrap();
        assert_eq!(read_folder(folder.path()).unwrap()[3].frame, 3);
    }

    #[test]
    fn broken_files_are_named() {
        let folder = tempfile::tempdir().unwrap();
        assert!(read_folder(folder.path()).unwrap_err().to_string().contains("no .json file"));
        let refusal = |text: &str| {
            std::fs::write(folder.path().join("a_0.json"), text).unwrap();
            let message = read_folder(folder.path()).unwrap_err().to_string();
            assert!(message.contains("a_0.json"), "{message}");
            message
        };
        assert!(refusal("{").contains("line 1: this is no JSON"));
        assert!(refusal("{}").contains("no list `people`"));
        assert!(
            refusal(r#"{"people":[{"pose_keypoints_2d":"x"}]}"#)
                .contains("people[0].pose_keypoints_2d: has to be a list")
        );
        assert!(
            refusal(r#"{"people":[{"pose_keypoints_2d":[1,2,3]}]}"#)
                .contains("1 keypoints; 7 (head and arms), 17 (COCO)")
        );
    }
}
