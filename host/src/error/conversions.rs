//! Errors of readers and writers that wrap one of the operating system.

use super::Error;
use crate::file::FileError;
use std::io;

#[cfg(feature = "plots")]
use plotters::{backend::DrawingBackend, drawing::DrawingAreaErrorKind, prelude::BitMapBackend};

/// What the drawing of a plot refuses.
#[cfg(feature = "plots")]
pub type PlotError = DrawingAreaErrorKind<<BitMapBackend<'static> as DrawingBackend>::ErrorType>;

impl From<FileError> for Error {
    fn from(error: FileError) -> Self {
        match error {
            FileError::Io(reason) => Self::Io(reason),
            beyond_limits => Self::invalid(beyond_limits),
        }
    }
}

impl From<tempfile::PersistError> for Error {
    fn from(error: tempfile::PersistError) -> Self {
        Self::Io(io::Error::new(error.error.kind(), error))
    }
}

impl<W> From<io::IntoInnerError<W>> for Error {
    fn from(error: io::IntoInnerError<W>) -> Self {
        Self::Io(error.into_error())
    }
}

impl<W> From<csv::IntoInnerError<W>> for Error {
    fn from(error: csv::IntoInnerError<W>) -> Self {
        Self::Io(io::Error::new(error.error().kind(), error.error().to_string()))
    }
}
