//! What went wrong, as far as a caller acts on it.

use super::Error;
use crate::cyclic::CyclicError;
use crate::keypoints::error::KeypointError;
use sinew_formats::cloud::CloudError;
use sinew_formats::images::{ImageFileError, InputError, VideoError};
use sinew_formats::motion::MotionError;
use std::error::Error as StdError;
use std::io;

/// What went wrong. The command ends with the number of `sysexits.h` that stands for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ErrorKind {
    /// An option has a value that it cannot have, or does not go with another.
    Usage,
    /// What was read breaks a rule.
    Data,
    /// What was to be read is not there.
    NoInput,
    /// A file or folder of results cannot be created.
    CannotCreate,
    /// The operating system failed to read or write.
    Io,
    /// Another process is at it; the same command may work later.
    TryAgain,
    /// A signal ended the run.
    Interrupted,
}

impl ErrorKind {
    /// The kind of an error of any type, by what stands at its bottom.
    #[must_use]
    pub fn of(error: &(dyn StdError + 'static)) -> Option<Self> {
        let mut cause = Some(error);
        while let Some(error) = cause {
            if let Some(kind) = Self::of_reader(error) {
                return Some(kind);
            }
            if let Some(known) = error.downcast_ref::<Error>() {
                return Some(known.kind());
            }
            cause = error.source();
        }
        None
    }

    /// The kind of an error of a reader, none of others.
    fn of_reader(error: &(dyn StdError + 'static)) -> Option<Self> {
        if let Some(io) = error.downcast_ref::<io::Error>() {
            return Some(Self::of_reading(io.kind()));
        }
        let by_reason = |reason: Option<io::ErrorKind>| Some(reason.map_or(Self::Data, Self::of_reading));
        if let Some(error) = error.downcast_ref::<csv::Error>() {
            return match error.kind() {
                csv::ErrorKind::Io(reason) => by_reason(Some(reason.kind())),
                _ => by_reason(None),
            };
        }
        if let Some(error) = error.downcast_ref::<CyclicError>() {
            return match error {
                CyclicError::Unreadable { reason, .. } => by_reason(Some(reason.kind())),
                CyclicError::Parameter { .. } => Some(Self::Usage),
                _ => by_reason(None),
            };
        }
        if let Some(error) = error.downcast_ref::<KeypointError>() {
            let KeypointError::Unreadable { reason, .. } = error else { return by_reason(None) };
            return by_reason(Some(reason.kind()));
        }
        if let Some(error) = error.downcast_ref::<MotionError>() {
            let MotionError::Unreadable { reason, .. } = error else { return by_reason(None) };
            return by_reason(Some(reason.kind()));
        }
        if let Some(error) = error.downcast_ref::<CloudError>() {
            let CloudError::Unreadable { reason, .. } = error else { return by_reason(None) };
            return by_reason(Some(reason.kind()));
        }
        if let Some(error) = error.downcast_ref::<ImageFileError>() {
            return by_reason(error.io);
        }
        if let Some(error) = error.downcast_ref::<VideoError>() {
            return match error {
                VideoError::Io { frames: 0, kind, .. } => by_reason(Some(*kind)),
                // It was there.
                VideoError::Io { .. } => Some(Self::Io),
                VideoError::NoProgram { .. } => Some(Self::NoInput),
                _ => by_reason(None),
            };
        }
        match error.downcast_ref::<InputError>()? {
            InputError::Missing(_) => Some(Self::NoInput),
            _ => by_reason(None),
        }
    }

    fn of_reading(error: io::ErrorKind) -> Self {
        match error {
            io::ErrorKind::NotFound | io::ErrorKind::NotADirectory | io::ErrorKind::IsADirectory => Self::NoInput,
            // What was read is too short, or no UTF-8.
            io::ErrorKind::InvalidData | io::ErrorKind::UnexpectedEof | io::ErrorKind::InvalidInput => Self::Data,
            io::ErrorKind::PermissionDenied => Self::NoInput,
            _ => Self::Io,
        }
    }

    fn of_writing(error: io::ErrorKind) -> Self {
        match error {
            io::ErrorKind::NotFound
            | io::ErrorKind::NotADirectory
            | io::ErrorKind::IsADirectory
            | io::ErrorKind::AlreadyExists
            | io::ErrorKind::PermissionDenied
            | io::ErrorKind::ReadOnlyFilesystem => Self::CannotCreate,
            _ => Self::Io,
        }
    }

    /// The exit status that `sysexits.h` has for this; of a run that a signal ended that of SIGINT.
    #[must_use]
    pub fn exit_status(self) -> u8 {
        match self {
            Self::Usage => 64,
            Self::Data => 65,
            Self::NoInput => 66,
            Self::CannotCreate => 73,
            Self::Io => 74,
            Self::TryAgain => 75,
            Self::Interrupted => 130,
        }
    }

    /// One word for scripts.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Usage => "usage",
            Self::Data => "data",
            Self::NoInput => "no-input",
            Self::CannotCreate => "cannot-create",
            Self::Io => "io",
            Self::TryAgain => "try-again",
            Self::Interrupted => "interrupted",
        }
    }
}

impl Error {
    /// What went wrong. A rule that is broken in a way that no variant tells counts as
    /// [`ErrorKind::Data`].
    #[must_use]
    pub fn kind(&self) -> ErrorKind {
        match self {
            Self::Interrupted(_) => ErrorKind::Interrupted,
            Self::Option(_) => ErrorKind::Usage,
            Self::InUse { .. } => ErrorKind::TryAgain,
            Self::Unreadable(_) => ErrorKind::Io,
            Self::ImageFile(error) => ErrorKind::of_reader(error).unwrap_or(ErrorKind::Data),
            // What fills a file may fail by itself.
            Self::Write { .. } => match self.innermost() {
                Self::Io(error) => ErrorKind::of_writing(error.kind()),
                Self::Csv(error) => match error.kind() {
                    csv::ErrorKind::Io(error) => ErrorKind::of_writing(error.kind()),
                    _ => ErrorKind::Io,
                },
                Self::Json(error) => error.io_error_kind().map_or(ErrorKind::Data, ErrorKind::of_writing),
                other => other.kind(),
            },
            Self::Output(_) => ErrorKind::CannotCreate,
            Self::Video(error) => ErrorKind::of_reader(error).unwrap_or(ErrorKind::Data),
            Self::Motion(error) => ErrorKind::of_reader(error).unwrap_or(ErrorKind::Data),
            Self::Cloud(error) => ErrorKind::of_reader(error).unwrap_or(ErrorKind::Data),
            Self::Input(error) => ErrorKind::of_reader(error).unwrap_or(ErrorKind::Data),
            Self::Keypoints(error) => ErrorKind::of_reader(error).unwrap_or(ErrorKind::Data),
            Self::Cyclic(error) => ErrorKind::of_reader(error).unwrap_or(ErrorKind::Data),
            Self::Context { source, .. } | Self::Unfinished { error: source, .. } => source.kind(),
            other => match StdError::source(other) {
                Some(source) => ErrorKind::of(source).unwrap_or(ErrorKind::Data),
                None => match other {
                    Self::Io(error) => ErrorKind::of_reading(error.kind()),
                    _ => ErrorKind::Data,
                },
            },
        }
    }

    /// Whether results cannot be written.
    #[must_use]
    pub fn is_output(&self) -> bool {
        match self {
            Self::Write { .. } | Self::Output(_) => true,
            Self::Context { source, .. } | Self::Unfinished { error: source, .. } => source.is_output(),
            _ => false,
        }
    }

    /// Whether whoever read the output has gone away, as after `| head`.
    #[must_use]
    pub fn is_closed_pipe(&self) -> bool {
        let kind = match self.innermost() {
            Self::Io(error) => error.kind(),
            Self::Csv(error) => match error.kind() {
                csv::ErrorKind::Io(error) => error.kind(),
                _ => return false,
            },
            _ => return false,
        };
        kind == io::ErrorKind::BrokenPipe
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

    /// Who was interrupted, if a signal ended the run.
    #[must_use]
    pub fn interrupted(&self) -> Option<&crate::resume::Interrupted> {
        match self.innermost() {
            Self::Interrupted(interrupted) => Some(interrupted),
            _ => None,
        }
    }
}
