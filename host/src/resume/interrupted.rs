//! The error with which a run ends that a signal stopped.

use std::path::PathBuf;

/// SIGINT (Ctrl-C), SIGTERM or SIGHUP ended the run; what was finished is written.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("interrupted after {finished}{} {unit}; their results are in `{}`", of(.all), .out.display())]
pub struct Interrupted {
    /// How many were finished.
    pub finished: usize,
    /// Of how many, where that is counted.
    pub all: Option<usize>,
    /// What is counted: frames, rows, cells.
    pub unit: &'static str,
    /// Where they are.
    pub out: PathBuf,
}

fn of(all: &Option<usize>) -> String {
    all.map_or_else(String::new, |all| format!(" of {all}"))
}
