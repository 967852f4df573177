//! Model files as text, whatever the kind of model.

use crate::error::{Context, Result, ensure};
use std::fs;
use std::path::Path;

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
        let metadata = fs::metadata(path)?;
        ensure!(metadata.is_file(), "it is not a file");
        ensure!(metadata.len() <= *max_file_bytes, "it is larger than {max_file_bytes} bytes");
        let bytes = fs::read(path)?;
        parse(std::str::from_utf8(&bytes).ok().context("it is not a text file")?)
    };
    load().with_context(remedy)
}
