//! Model files as text, whatever the kind of model.

use crate::error::{Context as _, Error, Result, ensure};
use crate::file::read_text_within;
use crate::quote::with_short_quotes;
use std::fs;
use std::path::Path;

/// Longest reason that is printed as it is, bytes.
const MAX_REASON_BYTES: usize = 500;

/// What a kind of model is called, how one is made, and how large its file may be.
#[derive(Debug, Clone, Copy)]
pub struct ModelFileKind {
    /// Its name, as in "a skin model".
    pub name: &'static str,
    /// The command that makes one where `--out FILE` is added.
    pub command: &'static str,
    /// Largest file that is taken for one, bytes.
    pub max_file_bytes: u64,
}

/// Reads a model of `kind` that `parse` understands.
///
/// # Errors
/// Names the file, what is wrong with it, and how to make one.
pub fn read<T>(path: &Path, kind: &ModelFileKind, parse: impl FnOnce(&str) -> Result<T>) -> Result<T> {
    let ModelFileKind { name, command, max_file_bytes } = kind;
    let remedy = || {
        let path = path.display();
        format!("`{path}` cannot be used as a {name} model; make one with `{command} --out {path}`")
    };
    let load = || -> Result<T> {
        ensure!(fs::metadata(path)?.is_file(), "it is not a file");
        parse(&read_text_within(path, *max_file_bytes)?).map_err(|error| match error.chain() {
            // It quotes the file.
            long if long.len() > MAX_REASON_BYTES => Error::Invalid(with_short_quotes(&long)),
            _ => error,
        })
    };
    load().with_context(remedy)
}
