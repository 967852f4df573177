//! What is wrong with an input, before a run: folders, configurations, models, tables, run directories.

mod files;
mod folders;
mod frames;

use serde::Serialize;
use std::path::Path;

/// How much a finding matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// It is as it should be.
    Good,
    /// It works, perhaps not as was meant.
    Warning,
    /// It does not work.
    Problem,
}

/// One thing that was found.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// How much it matters.
    pub severity: Severity,
    /// What it is, and the remedy.
    pub text: String,
}

/// Everything that was found about one path.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Diagnosis {
    /// The path as it was given.
    pub path: String,
    /// What the path is taken for.
    pub what: String,
    /// The findings.
    pub findings: Vec<Finding>,
}

impl Diagnosis {
    fn new(path: &Path, what: &str) -> Self {
        Self { path: path.display().to_string(), what: what.to_owned(), findings: Vec::new() }
    }

    fn add(&mut self, severity: Severity, text: impl Into<String>) {
        self.findings.push(Finding { severity, text: text.into() });
    }

    /// A good finding, or the problem that stands in its place.
    fn add_result(&mut self, result: crate::error::Result<String>) {
        match result {
            Ok(text) => self.add(Severity::Good, text),
            Err(error) => self.add(Severity::Problem, error.chain().to_string()),
        }
    }

    /// The weightiest finding; good where there is none.
    #[must_use]
    pub fn worst(&self) -> Severity {
        self.findings.iter().map(|finding| finding.severity).max().unwrap_or(Severity::Good)
    }
}

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
