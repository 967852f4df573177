//! A folder with one file a frame.

use super::error::KeypointError;
use super::orders::PointFrame;
use super::{openpose, yolo};
use std::path::{Path, PathBuf};

/// Frames of a folder.
#[derive(Debug, Clone, PartialEq)]
pub struct FolderFrames {
    /// The frames, points not named yet.
    pub frames: Vec<PointFrame>,
    /// What a user should know.
    pub notes: Vec<String>,
}

/// Reads all `.json` files of `folder` as OpenPose writes them; where it has none, all `.txt` files
/// as ultralytics writes them.
///
/// # Errors
/// The folder has neither, or a file breaks a rule.
pub fn read(folder: &Path) -> Result<FolderFrames, KeypointError> {
    let unreadable = |reason| KeypointError::Unreadable { path: folder.to_path_buf(), reason };
    let mut jsons: Vec<PathBuf> = Vec::new();
    let mut texts: Vec<PathBuf> = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        match path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase()).as_deref() {
            Some("json") => jsons.push(path),
            Some("txt") => texts.push(path),
            _ => {}
        }
    }
    let (frames, is_counted) = if !jsons.is_empty() {
        openpose::read_folder(&jsons)?
    } else if !texts.is_empty() {
        yolo::read_folder(&texts)?
    } else {
        let rule =
            "has no .json file (OpenPose) and no .txt file (YOLO pose); give the folder that the pose detector wrote";
        return Err(KeypointError::unusable(folder, rule));
    };
    let mut notes = Vec::new();
    if is_counted && frames.len() > 1 {
        notes.push("no number in the files' names differs from file to file: frames are counted from 0".to_owned());
    }
    Ok(FolderFrames { frames, notes })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(people: usize) -> String {
        let values: Vec<f64> = (0..25).flat_map(|i| [f64::from(i) + 1.0, 5.0, 0.8]).collect();
        let person = serde_json::json!({ "pose_keypoints_2d": values, "face_keypoints_2d": [] });
        serde_json::json!({ "version": 1.3, "people": vec![person; people] }).to_string()
    }

    #[test]
    fn frames_come_in_natural_order_with_their_numbers() {
        let folder = tempfile::tempdir().unwrap();
        for (number, people) in [(9, 1), (10, 2), (12, 0)] {
            std::fs::write(folder.path().join(format!("clip_{number}_keypoints.json")), file(people)).unwrap();
        }
        std::fs::write(folder.path().join("notes.txt"), "no").unwrap();
        let found = read(folder.path()).unwrap();
        let counts: Vec<(u64, usize)> = found.frames.iter().map(|frame| (frame.frame, frame.people.len())).collect();
        assert_eq!(counts, [(9, 1), (10, 2), (12, 0)]);
        assert!(found.notes.is_empty());
        std::fs::write(folder.path().join("x.json"), file(1)).unwrap();
        let found = read(folder.path()).unwrap();
        assert_eq!((found.frames[3].frame, found.notes.len()), (3, 1));
    }

    #[test]
    fn a_folder_without_keypoints_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        assert!(read(folder.path()).unwrap_err().to_string().contains("no .json file"));
        std::fs::write(folder.path().join("a_1.txt"), "hello\n").unwrap();
        assert!(read(folder.path()).unwrap_err().to_string().contains("a_1.txt: line 1"));
    }
}
