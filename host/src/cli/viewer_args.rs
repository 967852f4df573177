//! `--rerun`: a run for the Rerun viewer.

use super::console::Console;
use anyhow::{Result, bail};
use clap::Args;
use std::path::{Path, PathBuf};

/// Options of the commands whose runs the viewer shows.
#[derive(Debug, Clone, Default, Args)]
pub struct ViewerArgs {
    /// Write frames, blobs, particles, points, skeleton and curves for the Rerun viewer, too (a
    /// build with `--features rerun`).
    #[arg(long, value_name = "FILE.rrd")]
    pub rerun: Option<PathBuf>,
}

impl ViewerArgs {
    /// Whether a file was asked for.
    #[must_use]
    pub fn is_wanted(&self) -> bool {
        self.rerun.is_some()
    }

    /// Checks before the run that the file can be written.
    ///
    /// # Errors
    /// Another ending, a place that cannot be written, or a build without the feature `rerun`.
    pub fn check(&self) -> Result<()> {
        let Some(file) = &self.rerun else { return Ok(()) };
        if !file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("rrd")) {
            bail!("`--rerun {}` has to end in .rrd, so that the viewer opens it", file.display());
        }
        if cfg!(not(feature = "rerun")) {
            bail!("`--rerun` is not part of this build; `cargo install --locked --path host --features rerun` has it");
        }
        Ok(crate::output::check_writable_file(file)?)
    }

    /// Writes the file of the finished run in `run`, and says so; nothing if none was asked for.
    ///
    /// # Errors
    /// What is wrong with the run or the file.
    #[cfg(feature = "rerun")]
    pub fn write(&self, run: &Path, console: &Console) -> Result<String> {
        let Some(file) = &self.rerun else { return Ok(String::new()) };
        let shown = crate::viewer::write(run, file)?;
        for note in &shown.notes {
            console.note(format!("note: {}: {note}", file.display()));
        }
        Ok(format!("for the Rerun viewer, {} frames: {}\n", shown.frames, file.display()))
    }

    /// Nothing: [`Self::check`] refuses the option in this build.
    ///
    /// # Errors
    /// None.
    #[cfg(not(feature = "rerun"))]
    pub fn write(&self, _run: &Path, _console: &Console) -> Result<String> {
        Ok(String::new())
    }
}
