//! What is wrong with a motion file, and where.

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
    #[error("motion `{}` has no joints that look like {wanted}; it has {}", path.display(), joints.join(", "))]
    NoJoint {
        /// The file.
        path: PathBuf,
        /// What was looked for.
        wanted: String,
        /// What is there.
        joints: Vec<String>,
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
        Self::Broken { path: path.to_path_buf(), line, rule: rule.into() }
    }
}

/// Reads a text file; bytes that are not UTF-8 (old comments) are replaced.
pub(crate) fn read_text(path: &Path) -> Result<String, MotionError> {
    let bytes = std::fs::read(path).map_err(|reason| MotionError::Unreadable { path: path.to_path_buf(), reason })?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Parses a finite number.
pub(crate) fn number(path: &Path, line: usize, word: &str) -> Result<f32, MotionError> {
    match word.parse::<f32>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(MotionError::broken(path, line, format!("`{word}` is not finite; every value has to be"))),
        Err(_) => Err(MotionError::broken(path, line, format!("a number was expected, found `{word}`"))),
    }
}
