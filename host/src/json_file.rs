//! JSON files.

use crate::error::Result;
use crate::file::read_text;
use serde::de::DeserializeOwned;
use std::path::Path;

/// Reads the value of a JSON file.
///
/// # Errors
/// The file cannot be read, or holds no JSON of this kind. The caller names it.
pub(crate) fn read_json<T: DeserializeOwned>(path: &Path) -> Result<T> {
    Ok(serde_json::from_str(&read_text(path)?)?)
}
