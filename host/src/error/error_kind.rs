//! Whose fault an error is, as far as its variant says.

use super::Error;
use crate::cyclic::CyclicError;

/// Whose fault an error is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ErrorKind {
    /// What was to be read is missing or broken.
    Input,
    /// Results cannot be written.
    Output,
    /// An option has a value that it cannot have, or does not go with another.
    Options,
    /// Ctrl-C ended the run.
    Interrupted,
}

impl Error {
    /// Whose fault the error is; none where that is not known.
    #[must_use]
    pub fn kind(&self) -> Option<ErrorKind> {
        match self {
            Self::Interrupted(_) => Some(ErrorKind::Interrupted),
            Self::Option(_) => Some(ErrorKind::Options),
            Self::Motion(_)
            | Self::Cloud(_)
            | Self::Video(_)
            | Self::Input(_)
            | Self::ImageFile(_)
            | Self::Keypoints(_) => Some(ErrorKind::Input),
            Self::Cyclic(CyclicError::Parameter { .. }) => None,
            Self::Cyclic(_) => Some(ErrorKind::Input),
            // What fills a file may fail by itself.
            Self::Write { source, .. } => source.kind().or(Some(ErrorKind::Output)),
            Self::Context { source, .. } | Self::Unfinished { error: source, .. } => source.kind(),
            _ => None,
        }
    }

    /// The error below every context.
    #[must_use]
    pub fn innermost(&self) -> &Self {
        match self {
            Self::Write { source, .. } | Self::Context { source, .. } | Self::Unfinished { error: source, .. } => {
                source.innermost()
            }
            other => other,
        }
    }

    /// Who was interrupted, if Ctrl-C ended the run.
    #[must_use]
    pub fn interrupted(&self) -> Option<&crate::resume::Interrupted> {
        match self.innermost() {
            Self::Interrupted(interrupted) => Some(interrupted),
            _ => None,
        }
    }
}
