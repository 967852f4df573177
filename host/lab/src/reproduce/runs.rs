//! The runs that measured what a page shows: their commits and their time together.

use anyhow::Result;
use serde::{Deserialize, Serialize};
use sinew::output::OutputDir;
use std::fs;
use std::process::Command;

/// The record beside the cells of a page.
const FILE: &str = "runs.json";

/// One run, whole or broken off.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Run {
    commit: String,
    seconds: f64,
}

/// All runs of a page, the first one first.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Runs(Vec<Run>);

impl Runs {
    /// The runs of which `folder` keeps the cells.
    #[must_use]
    pub fn read(folder: &OutputDir) -> Self {
        let text = fs::read_to_string(folder.join(FILE)).unwrap_or_default();
        serde_json::from_str(&text).unwrap_or_default()
    }

    /// Adds a run and keeps the record in `folder`.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn add(&mut self, folder: &OutputDir, commit: &str, seconds: f64) -> Result<()> {
        self.0.push(Run { commit: commit.to_owned(), seconds });
        Ok(folder.write(FILE, |writer| Ok(serde_json::to_writer_pretty(writer, &self)?))?)
    }

    /// Each commit once, in the order of the runs.
    #[must_use]
    pub fn commits(&self) -> String {
        let mut commits: Vec<&str> = self.0.iter().map(|run| &*run.commit).collect();
        // Equal ones need not stand beside each other.
        let mut seen = std::collections::BTreeSet::new();
        commits.retain(|commit| seen.insert(*commit));
        commits.join(", ")
    }

    /// Time of all runs, seconds.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.0.iter().map(|run| run.seconds).sum()
    }
}

/// The commit that is checked out, with `-dirty` where files differ from it; the version where
/// there is no repository.
#[must_use]
pub fn commit() -> String {
    let git = Command::new("git").args(["describe", "--always", "--dirty"]).output().ok();
    let text = git.filter(|git| git.status.success()).map(|git| String::from_utf8_lossy(&git.stdout).trim().to_owned());
    text.unwrap_or_else(|| format!("sinew {}", env!("CARGO_PKG_VERSION")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_add_up_and_name_each_commit_once() {
        let folder = tempfile::tempdir().unwrap();
        let output = OutputDir::create(folder.path()).unwrap();
        assert_eq!(Runs::read(&output), Runs::default());
        let mut runs = Runs::default();
        for (commit, seconds) in [("a1", 10.0), ("b2", 5.0), ("a1", 2.5)] {
            runs.add(&output, commit, seconds).unwrap();
        }
        let read = Runs::read(&output);
        assert_eq!(read, runs);
        assert_eq!((read.commits().as_str(), read.seconds()), ("a1, b2", 17.5));
    }
}
