//! Bytes as a file, for readers that take a path.

use std::cell::OnceCell;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A folder in memory, where there is one.
const IN_MEMORY: &str = "/dev/shm";

thread_local! {
    static FOLDER: OnceCell<TempDir> = const { OnceCell::new() };
}

/// A folder of this thread.
///
/// # Panics
/// If it cannot be made.
#[must_use]
pub fn folder() -> PathBuf {
    let new = || {
        let parent = Path::new(IN_MEMORY);
        let parent = if parent.is_dir() { parent.to_path_buf() } else { std::env::temp_dir() };
        tempfile::Builder::new().prefix("sinew-fuzz-").tempdir_in(parent).expect("a folder for temporary files")
    };
    FOLDER.with(|folder| folder.get_or_init(new).path().to_path_buf())
}

/// A file called `name` with these bytes, until the next one of that name.
///
/// # Panics
/// If it cannot be written.
#[must_use]
pub fn file(name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder().join(name);
    fs::write(&path, bytes).expect("a temporary file");
    path
}
