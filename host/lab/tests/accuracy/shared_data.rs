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

/// As [`in_release`], for tests that take long: `None`, said aloud, also where `SINEW_SHORT_TESTS`
/// is set, as `.ci/run` does in its short form.
pub fn in_long_form(part: &str) -> Option<PathBuf> {
    if std::env::var_os("SINEW_SHORT_TESTS").is_some() {
        eprintln!("left out: takes long, and SINEW_SHORT_TESTS is set");
        return None;
    }
    in_release(part)
}
