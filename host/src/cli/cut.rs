//! `sinew cut`: the cycles of angle tables as a cut list.

use super::console::Console;
use super::data_error;
use crate::cyclic::AngleTable;
use crate::cyclic::cuts::{self, Cut};
use crate::cyclic::cutting::{CuttingOptions, cycles};
use crate::cyclic::rate;
use crate::output::check_writable_file;
use anyhow::{Context, Result};
use clap::Args;
use serde_json::json;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Options of `sinew cut`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  sinew simulate cyclic --model walking --out walk.csv
  sinew cut walk.csv --out cuts.csv")]
pub struct CutArgs {
    /// Angle tables, as `sinew angles` writes them.
    #[arg(required = true, value_name = "TABLE.csv")]
    pub tables: Vec<PathBuf>,
    /// Cut list to write: file,start_frame,end_frame, end excluded.
    #[arg(long, value_name = "CUTS.csv")]
    pub out: PathBuf,
    /// Frames per second of tables that do not say.
    #[arg(long, value_name = "HZ")]
    pub rate: Option<f64>,
    /// Shortest cycle, seconds.
    #[arg(long, value_name = "S", default_value_t = 0.4)]
    pub shortest: f64,
    /// Longest cycle, seconds.
    #[arg(long, value_name = "S", default_value_t = 6.0)]
    pub longest: f64,
}

/// Finds the cycles of each table and writes them all; a table without cycles is named and left
/// out.
///
/// # Errors
/// Bad input, no cycle in any table, or an output that cannot be written.
pub fn run(args: &CutArgs, console: &Console) -> Result<()> {
    check_writable_file(&args.out)?;
    let mut all: Vec<Cut> = Vec::new();
    let (mut report, mut tables, mut left_out) = (String::new(), Vec::new(), Vec::new());
    for path in &args.tables {
        let table = AngleTable::read(path)?;
        let rate_hz = rate::of_recording(path, table.rate_hz(), args.rate)?;
        let options = CuttingOptions { rate_hz, shortest_s: args.shortest, longest_s: args.longest };
        match cycles(&table, &path.display().to_string(), options) {
            Ok(mut found) => {
                let frames: u64 = found.iter().map(Cut::duration_frames).sum();
                let mean = frames as f64 / found.len() as f64;
                let per_minute = 60.0 * rate_hz / mean;
                writeln!(
                    report,
                    "{}: {} cycles of {mean:.1} frames on the mean, {per_minute:.1} a minute",
                    path.display(),
                    found.len(),
                )?;
                let cycles = found.len();
                tables.push(json!({ "table": path, "cycles": cycles, "mean_frames": mean, "per_minute": per_minute }));
                let name = name_from(&args.out, path)?;
                found.iter_mut().for_each(|cut| cut.file.clone_from(&name));
                all.extend(found);
            }
            Err(error) if args.tables.len() > 1 => {
                console.note(format!("left out: {error}"));
                left_out.push(error.to_string());
            }
            Err(error) => return Err(error.into()),
        }
    }
    if all.is_empty() {
        return Err(data_error(format!("no table has a cycle: {}", left_out.join("; "))));
    }
    cuts::write(&args.out, &all)?;
    writeln!(report, "wrote {}", args.out.display())?;
    console.answer_beside(&args.out, &report, &json!({ "tables": tables, "left_out": left_out, "out": args.out }))
}

/// How a list at `list` names `table`: relative where the table lies in the list's folder or below
/// it, else absolute.
fn name_from(list: &Path, table: &Path) -> Result<String> {
    let absolute = |path: &Path| path.canonicalize().with_context(|| format!("`{}` cannot be found", path.display()));
    let folder = list.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let (folder, table) = (absolute(folder)?, absolute(table)?);
    Ok(table.strip_prefix(&folder).unwrap_or(&table).to_string_lossy().into_owned())
}
