//! The findings about one path.

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
    pub(super) fn new(path: &Path, what: &str) -> Self {
        Self { path: path.display().to_string(), what: what.to_owned(), findings: Vec::new() }
    }

    pub(super) fn add(&mut self, severity: Severity, text: impl Into<String>) {
        self.findings.push(Finding { severity, text: text.into() });
    }

    /// A good finding, or the problem that stands in its place.
    pub(super) fn add_result(&mut self, result: crate::error::Result<String>) {
        match result {
            Ok(text) => self.add(Severity::Good, text),
            Err(error) => self.add(Severity::Problem, format!("{error:#}")),
        }
    }

    /// The weightiest finding; good where there is none.
    #[must_use]
    pub fn worst(&self) -> Severity {
        self.findings.iter().map(|finding| finding.severity).max().unwrap_or(Severity::Good)
    }
}
