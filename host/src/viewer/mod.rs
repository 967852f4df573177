//! A run for the Rerun viewer (rerun.io): its directory becomes one .rrd file. Feature `rerun`.
//!
//! Of Rerun only the crates that write the file are used, not its SDK with its server and its
//! threads.

mod arm;
mod body;
mod cyclic;
mod marks;
pub mod numbers;
pub mod recording;

pub use marks::Shown;

use crate::error::{Context, Result, bail};
use crate::file::read_bytes;
use crate::json_file::read_json;
use crate::limits::MAX_FILE_BYTES;
use crate::output::write_atomically;
use crate::report::folder::RunFolder;
use crate::report::kind::Kind;
use recording::Recording;
use serde_json::Value;
use sinew_core::checksum::crc32;
use std::path::Path;

/// Writes the run in the directory `run` as the Rerun recording `file`.
///
/// # Errors
/// A directory without a finished run of `sinew track` or `sinew demo`, or a file that cannot be
/// written.
pub fn write(run: &Path, file: &Path) -> Result<Shown> {
    let folder = RunFolder::new(run);
    let kind = Kind::of(&folder);
    let (record, table) = match kind {
        Some(Kind::Arm | Kind::Body) => ("run.json", "track.csv"),
        Some(Kind::Cyclic) => ("summary.json", "estimates.csv"),
        _ => bail!("`{}` holds no run of `sinew track` or `sinew demo`", run.display()),
    };
    let record = run.join(record);
    let report: Value = read_json(&record).with_context(|| format!("`{}` cannot be read", record.display()))?;
    let mut shown = Shown::default();
    write_atomically(file, |writer| {
        // Two recordings of one name would be shown as one.
        let name = run.file_name().map_or_else(|| "run".to_owned(), |name| name.to_string_lossy().into_owned());
        let content = read_bytes(&run.join(table), MAX_FILE_BYTES).map_or(0, |bytes| crc32(&bytes));
        let mut recording = Recording::begin(&format!("{name}-{content:08x}"), writer)?;
        shown = match kind {
            Some(Kind::Arm) => arm::write(run, &report, &mut recording)?,
            Some(Kind::Body) => body::write(run, &report, &mut recording)?,
            _ => cyclic::write(run, &report, &mut recording)?,
        };
        recording.finish()
    })?;
    Ok(shown)
}
