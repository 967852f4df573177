//! OpenPose JSON: one file a frame, each with everybody in it. Pose2Sim and RTMLib write the same
//! form.

use super::error::{KeypointError, json, read_text};
use super::file_numbers;
use super::orders::{self, PointFrame, Points};
use super::point_values::numbers;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Reads JSON files, one a frame; `true` with them if no number in their names rises, so that they
/// are counted from 0.
///
/// # Errors
/// A file breaks a rule.
pub fn read_folder(files: &[PathBuf]) -> Result<(Vec<PointFrame>, bool), KeypointError> {
    let names: Vec<String> = files.iter().map(|path| path.to_string_lossy().into_owned()).collect();
    let numbered = file_numbers::frames(&names);
    let read = |&(frame, index): &(u64, usize)| {
        let path = &files[index];
        Ok(PointFrame { frame, people: people(&json(&read_text(path)?, path)?, path)? })
    };
    Ok((numbered.frames.iter().map(read).collect::<Result<_, _>>()?, numbered.is_counted))
}

/// Everybody in the value of one file.
///
/// # Errors
/// Names the person and the rule that it broke.
pub fn people(value: &Value, path: &Path) -> Result<Vec<Points>, KeypointError> {
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
            orders::points(&values).map_err(|rule| KeypointError::broken(path, place, rule))
        }
    };
    list.iter().enumerate().map(person).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn broken_files_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a_0.json");
        let refusal = |text: &str| {
            std::fs::write(&path, text).unwrap();
            let message = read_folder(std::slice::from_ref(&path)).unwrap_err().to_string();
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
            refusal(r#"{"people":[{"pose_keypoints_2d":[1,2,3]}]}"#).contains("1 keypoints; 7 (head and arms), 14")
        );
    }
}
