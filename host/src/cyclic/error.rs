//! What is wrong with a table, a cut list or a model, and where.

use crate::file::{FileError, read_lines};
use crate::quote::with_short_quotes;
use std::path::{Path, PathBuf};

/// Input of the cyclic tracker that cannot be read or used.
#[derive(Debug, thiserror::Error)]
pub enum CyclicError {
    /// The operating system refused the file.
    #[error("`{}` cannot be read ({reason}); check the path", path.display())]
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
        line: u64,
        /// The rule, with what was found instead.
        rule: String,
    },
    /// The file as a whole cannot be used.
    #[error("`{}`: {rule}", path.display())]
    Unusable {
        /// The file.
        path: PathBuf,
        /// The rule it broke and the remedy.
        rule: String,
    },
    /// A table in which no cycle was found.
    #[error("no cycle in `{file}`: {reason}; cut it by hand, or record more cycles")]
    NoCycle {
        /// The table.
        file: String,
        /// Why, in words.
        reason: String,
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

impl CyclicError {
    pub(crate) fn broken(path: &Path, line: u64, rule: impl Into<String>) -> Self {
        Self::Broken { path: path.to_path_buf(), line, rule: with_short_quotes(&rule.into()) }
    }

    pub(crate) fn unusable(path: &Path, rule: impl Into<String>) -> Self {
        Self::Unusable { path: path.to_path_buf(), rule: rule.into() }
    }

    pub(crate) fn parameter(parameter: &'static str, rule: impl Into<String>) -> Self {
        Self::Parameter { parameter, rule: rule.into() }
    }
}

/// Reads the text of a table or cut list.
pub(crate) fn read_text(path: &Path) -> Result<String, CyclicError> {
    read_lines(path).map_err(|error| match error {
        FileError::Io(reason) => CyclicError::Unreadable { path: path.to_path_buf(), reason },
        other => CyclicError::broken(path, other.line() as u64, other.to_string()),
    })
}
