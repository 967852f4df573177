//! Real data for the tests that take a release build.

use std::path::{Path, PathBuf};

/// The folder `part` of `../shared/data`; `None`, said aloud, in a debug build or where it is not
/// beside the project.
pub fn in_release(part: &str) -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data").join(part);
    if cfg!(debug_assertions) || !folder.is_dir() {
        eprintln!("skipped: only in release and with ../shared/data beside the project");
        return None;
    }
    Some(folder)
}
