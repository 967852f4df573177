//! What is wrong with a file of keypoints, and where.

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
        Self::Broken { path: path.to_path_buf(), place: place.into(), rule: rule.into() }
    }

    pub(crate) fn unusable(path: &Path, rule: impl Into<String>) -> Self {
        Self::Unusable { path: path.to_path_buf(), rule: rule.into() }
    }
}

/// Reads a text file; a byte order mark is dropped.
pub(crate) fn read_text(path: &Path) -> Result<String, KeypointError> {
    let bytes = std::fs::read(path).map_err(|reason| KeypointError::Unreadable { path: path.to_path_buf(), reason })?;
    let text = String::from_utf8_lossy(&bytes);
    Ok(text.strip_prefix('\u{feff}').unwrap_or(&text).to_owned())
}

/// Parses JSON.
pub(crate) fn json(text: &str, path: &Path) -> Result<serde_json::Value, KeypointError> {
    serde_json::from_str(text).map_err(|error| {
        KeypointError::broken(path, format!("line {}", error.line()), format!("this is no JSON ({error})"))
    })
}
