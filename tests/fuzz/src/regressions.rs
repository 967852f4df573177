//! Inputs that failed once: files in `regressions`, in a folder for each target.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The inputs of `target`, in the order of their names.
///
/// # Errors
/// A file cannot be read.
pub fn of(target: &str) -> io::Result<Vec<(PathBuf, Vec<u8>)>> {
    let folder = root().join(target);
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let mut paths = fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<io::Result<Vec<_>>>()?;
    paths.sort();
    paths.into_iter().map(|path| fs::read(&path).map(|bytes| (path, bytes))).collect()
}

/// The names of the folders.
///
/// # Errors
/// The folder of all cannot be read.
pub fn folders() -> io::Result<Vec<String>> {
    fs::read_dir(root())?.map(|entry| Ok(entry?.file_name().to_string_lossy().into_owned())).collect()
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("regressions")
}
