//! `sinew doctor`: what is wrong with an input.

use super::console::Console;
use crate::doctor::{Diagnosis, Severity, examine};
use anyhow::Result;
use clap::Args;
use std::fmt::Write;
use std::path::PathBuf;

/// Options of `sinew doctor`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  sinew simulate arm --motion builtin --frames 5 --out scene
  sinew doctor scene/frames scene/camera.toml")]
pub struct DoctorArgs {
    /// Folders of images, of clouds or of runs; configurations (.toml), models and persons (.json),
    /// angle tables (.csv).
    #[arg(value_name = "PATH", required = true)]
    pub paths: Vec<PathBuf>,
}

/// Examines every path and prints the findings.
///
/// # Errors
/// One of them has a problem, or the text cannot be written.
pub fn run(args: &DoctorArgs, console: &Console) -> Result<()> {
    let all: Vec<Diagnosis> = args.paths.iter().map(|path| examine(path)).collect();
    console.answer(&summary(&all), &all)?;
    let ill = all.iter().filter(|diagnosis| diagnosis.worst() == Severity::Problem).count();
    match ill {
        0 => Ok(()),
        _ => {
            let text = format!("{ill} of {} have a problem; the lines above tell the remedy", all.len());
            Err(crate::Error::Invalid(text).into())
        }
    }
}

fn summary(all: &[Diagnosis]) -> String {
    let mut text = String::new();
    for diagnosis in all {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{} ({})", diagnosis.path, diagnosis.what);
        for finding in &diagnosis.findings {
            let sign = match finding.severity {
                Severity::Good => "ok",
                Severity::Warning => "warning",
                Severity::Problem => "problem",
            };
            let _ = writeln!(text, "  {sign:<8} {}", finding.text);
        }
    }
    text
}
