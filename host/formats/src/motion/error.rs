//! What is wrong with a motion file, and where.

use super::missing_joint::{MissingJoint, lines};
use crate::file::{FileError, read_lines};
use crate::limits::MAX_NUMBER;
use crate::quote::{listed, with_short_quotes};
use std::path::{Path, PathBuf};

/// A motion that cannot be read or used.
#[derive(Debug, thiserror::Error)]
pub enum MotionError {
    /// The operating system refused the file.
    #[error("motion `{}` cannot be read ({reason}); check the path", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The operating system's reason.
        reason: std::io::Error,
    },
    /// A line breaks a rule of the format.
    #[error("{}:{line}: {rule}", path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// The rule, with what was found instead.
        rule: String,
    },
    /// The file ending is none of those that are read.
    #[error("motion `{}` is of no known kind; give {known}", path.display())]
    UnknownKind {
        /// The file.
        path: PathBuf,
        /// What to give instead, in words.
        known: String,
    },
    /// An AMC file holds no skeleton and none was found beside it.
    #[error("motion `{}` needs a skeleton: {found} in its folder; name one with --skeleton FILE.asf", path.display())]
    NoSkeleton {
        /// The AMC file.
        path: PathBuf,
        /// What was found, in words.
        found: String,
    },
    /// A joint that the arm needs is not in the file under any usual name.
    #[error("motion `{}` has no joints that look like {wanted}; it has {}", path.display(), listed(joints))]
    NoJoint {
        /// The file.
        path: PathBuf,
        /// What was looked for.
        wanted: String,
        /// What is there.
        joints: Vec<String>,
    },
    /// Limb joints go by no name that is known.
    #[error("motion `{}` lacks {} of 12 limb joints:{}", path.display(), missing.len(), lines(missing, *partial, names))]
    NoLimbJoints {
        /// The file.
        path: PathBuf,
        /// The joints.
        missing: Vec<MissingJoint>,
        /// Whether some may be missing.
        partial: bool,
        /// The names of the file.
        names: Vec<String>,
    },
    /// A value that was handed in cannot be used.
    #[error("`{parameter}` {rule}")]
    Parameter {
        /// Its name.
        parameter: &'static str,
        /// The rule it broke.
        rule: String,
    },
}

impl MotionError {
    pub(crate) fn broken(path: &Path, line: usize, rule: impl Into<String>) -> Self {
        Self::Broken { path: path.to_path_buf(), line, rule: with_short_quotes(&rule.into()) }
    }

    pub(crate) fn of_file(path: &Path, error: FileError) -> Self {
        match error {
            FileError::Io(reason) => Self::Unreadable { path: path.to_path_buf(), reason },
            other => Self::broken(path, other.line(), other.to_string()),
        }
    }

    /// Whether the operating system refused the file, whatever its content.
    #[must_use]
    pub fn is_io(&self) -> bool {
        matches!(self, Self::Unreadable { .. })
    }
}

/// Reads the text of a format of lines.
pub(crate) fn read_text(path: &Path) -> Result<String, MotionError> {
    read_lines(path).map_err(|error| MotionError::of_file(path, error))
}

/// Parses a number that is finite and not beyond [`MAX_NUMBER`].
pub(crate) fn number(path: &Path, line: usize, word: &str) -> Result<f32, MotionError> {
    parsed_number(word).map_err(|rule| MotionError::broken(path, line, rule))
}

/// As [`number`]; the error is the broken rule alone.
pub(crate) fn parsed_number(word: &str) -> Result<f32, String> {
    match word.parse::<f32>() {
        Ok(value) if value.abs() <= MAX_NUMBER => Ok(value),
        Ok(_) if names_no_finite_number(word) => Err(format!("`{word}` is not finite; every value has to be")),
        Ok(_) => Err(format!("`{word}` is beyond {MAX_NUMBER:e}; every value has to be within")),
        Err(_) => Err(format!("a number was expected, found `{word}`")),
    }
}

/// Whether `word` is `inf` or `nan` rather than digits.
fn names_no_finite_number(word: &str) -> bool {
    !word.contains(|letter: char| letter.is_ascii_digit())
}
