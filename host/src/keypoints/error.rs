//! What is wrong with a file of keypoints, and where.

use crate::file::{self, FileError};
use crate::quote::with_short_quotes;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// Keypoints that cannot be read or used.
#[derive(Debug, thiserror::Error)]
pub enum KeypointError {
    /// The operating system refused the file.
    #[error("keypoints `{}` cannot be read ({reason}); check the path", path.display())]
    Unreadable {
        /// The file or folder.
        path: PathBuf,
        /// The operating system's reason.
        reason: std::io::Error,
    },
    /// A place in the file breaks a rule of the format.
    #[error("{}: {place}: {rule}", path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// Line, frame or person, in words.
        place: String,
        /// The rule, with what was found instead.
        rule: String,
    },
    /// The file as a whole cannot be used.
    #[error("`{}` {rule}", path.display())]
    Unusable {
        /// The file.
        path: PathBuf,
        /// The rule it broke and the remedy.
        rule: String,
    },
}

impl KeypointError {
    pub(crate) fn broken(path: &Path, place: impl Into<String>, rule: impl Into<String>) -> Self {
        Self::Broken { path: path.to_path_buf(), place: place.into(), rule: with_short_quotes(&rule.into()) }
    }

    pub(crate) fn unusable(path: &Path, rule: impl Into<String>) -> Self {
        Self::Unusable { path: path.to_path_buf(), rule: with_short_quotes(&rule.into()) }
    }

    fn of_file(path: &Path, error: FileError) -> Self {
        match error {
            FileError::Io(reason) => Self::Unreadable { path: path.to_path_buf(), reason },
            FileError::LongLine { line, .. } => Self::broken(path, format!("line {line}"), error.to_string()),
            FileError::TooLarge { .. } => Self::unusable(path, format!("cannot be read: {error}")),
        }
    }

    /// Whether the operating system refused the file or folder, whatever its content.
    #[must_use]
    pub fn is_io(&self) -> bool {
        matches!(self, Self::Unreadable { .. })
    }
}

/// Reads a text file, whose lines may be of any length.
pub(crate) fn read_text(path: &Path) -> Result<String, KeypointError> {
    file::read_text(path).map_err(|error| KeypointError::of_file(path, error))
}

/// Reads the text of a table.
pub(crate) fn read_lines(path: &Path) -> Result<String, KeypointError> {
    file::read_lines(path).map_err(|error| KeypointError::of_file(path, error))
}

/// Parses JSON.
pub(crate) fn json<'a, T: Deserialize<'a>>(text: &'a str, path: &Path) -> Result<T, KeypointError> {
    serde_json::from_str(text).map_err(|error| {
        KeypointError::broken(path, format!("line {}", error.line()), format!("this is no JSON ({error})"))
    })
}
