//! `sinew train cyclic`: a motion model from cut cycles.

use super::console::Console;
use crate::cyclic::cuts::CutList;
use crate::cyclic::model_file;
use crate::cyclic::training::{TrainingOptions, read_cycles, train_on, uneven_turns};
use crate::output::{check_writable_file, write_atomically};
use anyhow::Result;
use clap::Args;
use serde_json::json;
use std::path::PathBuf;

/// Options of `sinew train cyclic`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  sinew simulate cyclic --model walking --out walk.csv
  sinew cut walk.csv --out cuts.csv
  sinew train cyclic --cuts cuts.csv --out my_walk.json")]
pub struct TrainCyclicArgs {
    /// Cycles to train on: a CSV file `file,start_frame,end_frame`, end excluded, file relative to
    /// CUTS or absolute. A column `person` after them gives each person the same weight.
    #[arg(long, value_name = "CUTS.csv")]
    pub cuts: PathBuf,
    /// Model file to write.
    #[arg(long, value_name = "MODEL.json")]
    pub out: PathBuf,
    /// Positions of the reference cycle, 10 to 1000.
    #[arg(long, default_value_t = 100)]
    pub length: usize,
    /// Frames per second of tables that do not say.
    #[arg(long, value_name = "HZ")]
    pub rate: Option<f64>,
    /// Also use each cycle with left and right exchanged, half a cycle later, as of walks and runs.
    #[arg(long)]
    pub mirror: bool,
}

/// Trains, writes the model, says what it was made of.
///
/// # Errors
/// Bad input, or an output that cannot be written.
pub fn run(args: &TrainCyclicArgs, console: &Console) -> Result<()> {
    check_writable_file(&args.out)?;
    let list = CutList::read(&args.cuts)?;
    let cycles = read_cycles(&list, args.mirror)?;
    let options = TrainingOptions { length: args.length, rate_hz: args.rate, mirror: args.mirror };
    let model = train_on(&cycles, &list, options)?;
    let json = model_file::to_json(&model)?;
    write_atomically(&args.out, |writer| Ok(writer.write_all(json.as_bytes())?))?;
    let (numbers, on) = (model.numbers(), model.trained_on());
    let report = format!(
        "motion model of {} positions from {} cycles of {} tables\n\
         mean cycle: {:.1} frames at {} frames per second, {:.1} cycles per minute\n\
         wrote {}\n",
        args.length,
        on.cycles,
        on.tables.len(),
        numbers.mean_duration_frames,
        numbers.rate_hz,
        60.0 * numbers.rate_hz / numbers.mean_duration_frames,
        args.out.display()
    );
    for angle in uneven_turns(&cycles) {
        console.note(format!("note: {angle}"));
    }
    let json = json!({
        "positions": args.length,
        "mean_cycle_frames": numbers.mean_duration_frames,
        "rate_hz": numbers.rate_hz,
        "trained_on": on,
        "out": args.out,
    });
    console.answer_beside(&args.out, &report, &json)
}
