//! A folder with one cloud for each frame.

use super::error::CloudError;
use super::frame_number::frame_numbers;
use crate::registry::{Kind, endings, find};
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// One frame's file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CloudFrame {
    /// Number of the frame, from the file's name; see [`frame_numbers`].
    pub frame: u64,
    /// The file.
    pub path: PathBuf,
}

/// The frames of a folder: at least one, in natural order (`frame_2` before `frame_10`), their
/// numbers strictly growing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CloudFolder {
    /// The frames.
    pub frames: Vec<CloudFrame>,
}

impl CloudFolder {
    /// Lists the clouds directly in `folder`. Hidden files, folders and files with other endings
    /// are passed over.
    ///
    /// # Errors
    /// The folder is missing, is a file, is empty, or holds no cloud or clouds of several kinds.
    /// The names do not number the frames.
    pub fn open(folder: &Path) -> Result<Self, CloudError> {
        Self::open_kind(folder, Kind::Cloud)
    }

    /// As [`Self::open`], of clouds or depth images.
    pub(super) fn open_kind(folder: &Path, kind: Kind) -> Result<Self, CloudError> {
        let unreadable = |reason| CloudError::Unreadable { path: folder.to_path_buf(), reason };
        if folder.is_file() {
            return Err(CloudError::NotAFolder(folder.to_path_buf()));
        }
        let mut files = Vec::new();
        let mut kinds: BTreeMap<String, usize> = BTreeMap::new();
        for entry in std::fs::read_dir(folder).map_err(unreadable)? {
            let path = entry.map_err(unreadable)?.path();
            if path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.')) {
                continue;
            }
            *kinds.entry(kind_in_words(&path)).or_default() += 1;
            if path.is_file() && find(&path, &[kind]).is_some() {
                files.push(path);
            }
        }
        check_kinds(folder, &kinds, kind)?;
        files.sort_by(|a, b| natord::compare(&text(a.file_name()), &text(b.file_name())).then_with(|| a.cmp(b)));
        let stems: Vec<String> = files.iter().map(|file| text(file.file_stem())).collect();
        let stems: Vec<&str> = stems.iter().map(String::as_str).collect();
        let numbers = frame_numbers(&stems).ok_or_else(|| no_frame_number(folder, &stems))?;
        let frames =
            numbers.into_iter().zip(files).map(|(found, path)| CloudFrame { frame: found.number, path }).collect();
        Ok(Self { frames })
    }

    /// How many numbers between the first and the last frame have no file.
    #[must_use]
    pub fn missing(&self) -> u64 {
        self.frames.windows(2).map(|pair| pair[1].frame - pair[0].frame - 1).sum()
    }
}

fn text(name: Option<&OsStr>) -> String {
    name.unwrap_or_default().to_string_lossy().into_owned()
}

fn kind_in_words(path: &Path) -> String {
    if path.is_dir() {
        return "folder(s)".to_owned();
    }
    path.extension().map_or_else(
        || "file(s) without ending".to_owned(),
        |ending| format!("*.{} file(s)", ending.to_string_lossy().to_ascii_lowercase()),
    )
}

fn check_kinds(folder: &Path, kinds: &BTreeMap<String, usize>, wanted: Kind) -> Result<(), CloudError> {
    let in_words = |(kind, count): (&String, &usize)| format!("{count} {kind}");
    let is_cloud =
        |(kind, _): &(&String, &usize)| endings(&[wanted]).any(|known| **kind == format!("*.{known} file(s)"));
    let clouds: Vec<String> = kinds.iter().filter(is_cloud).map(in_words).collect();
    let folder = folder.to_path_buf();
    match clouds.len() {
        1 => Ok(()),
        0 if kinds.is_empty() => Err(CloudError::Empty { folder, kind: wanted }),
        0 => {
            let found = kinds.iter().map(in_words).collect::<Vec<_>>().join(", ");
            Err(CloudError::NoCloud { folder, found, kind: wanted })
        }
        _ => Err(CloudError::MixedKinds { folder, found: clouds.join(" and ") }),
    }
}

fn no_frame_number(folder: &Path, stems: &[&str]) -> CloudError {
    let unnumbered = stems.iter().find(|stem| !stem.contains(|c: char| c.is_ascii_digit()));
    let rule = if unnumbered.is_some() {
        "holds no digit"
    } else {
        "and those after it hold no number that grows from file to file"
    };
    let name = (*unnumbered.or(stems.first()).unwrap_or(&"")).to_owned();
    CloudError::NoFrameNumber { folder: folder.to_path_buf(), name, rule }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder_of(names: &[&str]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for name in names {
            std::fs::write(folder.path().join(name), b"").unwrap();
        }
        folder
    }

    #[test]
    fn frames_come_in_natural_order_and_gaps_are_seen() {
        let folder = folder_of(&["f_10.ply", "f_2.PLY", "f_3.ply", ".hidden.csv", "notes.txt"]);
        std::fs::create_dir(folder.path().join("more.pcd")).unwrap();
        let clouds = CloudFolder::open(folder.path()).unwrap();
        assert_eq!(clouds.frames.iter().map(|frame| frame.frame).collect::<Vec<_>>(), [2, 3, 10]);
        assert!(clouds.frames[0].path.ends_with("f_2.PLY"));
        assert_eq!(clouds.missing(), 6);
    }

    #[test]
    fn each_bad_folder_says_what_is_wrong() {
        let message = |path: &Path| CloudFolder::open(path).unwrap_err().to_string();
        let empty = folder_of(&[]);
        assert!(message(empty.path()).contains("is empty; put one file of points"));
        assert!(message(&empty.path().join("nowhere")).contains("check the path"));
        for (names, wanted) in [
            (&["1.ply", "2.pcd", "3.pcd"][..], "2 *.pcd file(s) and 1 *.ply file(s); keep the frames"),
            (&["notes.txt"], "it holds 1 *.txt file(s)"),
            (&["1.ply", "truth.ply"], "`truth` holds no digit; name the files like"),
            (&["f1.ply", "f01.ply"], "hold no number that grows"),
        ] {
            let folder = folder_of(names);
            let found = message(folder.path());
            assert!(found.contains(wanted) && found.contains(&*folder.path().to_string_lossy()), "{found}");
        }
        let folder = folder_of(&["1.ply"]);
        assert!(message(&folder.path().join("1.ply")).contains("is not a folder"));
    }
}
