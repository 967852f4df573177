//! What was being done when something failed.

use super::{Error, Result};
use std::fmt::{Formatter, Result as FmtResult};

/// Adds what was being done to an error, or to a missing value.
pub(crate) trait Context<T> {
    /// Adds a text.
    fn context(self, text: impl Into<String>) -> Result<T>;

    /// Adds a text that is made only if it is needed.
    fn with_context<S: Into<String>>(self, text: impl FnOnce() -> S) -> Result<T>;
}

/// Adds what cannot be written.
pub(crate) trait WriteContext<T> {
    /// Adds a text that names the file or folder.
    fn writing<S: Into<String>>(self, text: impl FnOnce() -> S) -> Result<T>;
}

impl<T, E: Into<Error>> WriteContext<T> for Result<T, E> {
    fn writing<S: Into<String>>(self, text: impl FnOnce() -> S) -> Result<T> {
        self.map_err(|error| Error::Write { context: text().into(), source: Box::new(error.into()) })
    }
}

impl<T, E: Into<Error>> Context<T> for Result<T, E> {
    fn context(self, text: impl Into<String>) -> Result<T> {
        self.with_context(|| text)
    }

    fn with_context<S: Into<String>>(self, text: impl FnOnce() -> S) -> Result<T> {
        self.map_err(|error| Error::Context { context: text().into(), source: Box::new(error.into()) })
    }
}

impl<T> Context<T> for Option<T> {
    fn context(self, text: impl Into<String>) -> Result<T> {
        self.with_context(|| text)
    }

    fn with_context<S: Into<String>>(self, text: impl FnOnce() -> S) -> Result<T> {
        self.ok_or_else(|| Error::Invalid(text().into()))
    }
}

/// The context, and with `{:#}` each cause after a colon.
pub(super) fn with_causes(context: &str, source: &Error, formatter: &mut Formatter<'_>) -> FmtResult {
    formatter.write_str(context)?;
    if formatter.alternate() { write!(formatter, ": {}", source.chain()) } else { Ok(()) }
}
