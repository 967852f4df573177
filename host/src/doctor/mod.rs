//! What is wrong with an input, before a run: folders, configurations, models, tables, run
//! directories.

mod diagnosis;
mod files;
mod folders;
mod frames;
mod recordings;

pub use diagnosis::{Diagnosis, Finding, Severity};

use std::path::Path;

/// Examines a folder or file.
#[must_use]
pub fn examine(path: &Path) -> Diagnosis {
    if !path.exists() {
        let mut diagnosis = Diagnosis::new(path, "nothing");
        diagnosis.add(
            Severity::Problem,
            "there is no such file or folder; look at its spelling, and at the folder you are in",
        );
        return diagnosis;
    }
    if path.is_dir() { folders::examine(path) } else { files::examine(path) }
}

#[cfg(test)]
mod tests;
