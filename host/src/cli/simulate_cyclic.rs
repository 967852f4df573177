//! `sinew simulate cyclic`: measured angles of a person who moves as a motion model says.

use super::console::Console;
use crate::cyclic::model_file::MODEL_VALUE;
use crate::cyclic::{CyclicModel, SyntheticPerson};
use crate::output::check_writable_file;
use anyhow::{Result, ensure};
use clap::Args;
use serde_json::json;
use std::path::PathBuf;

/// Arguments of `sinew simulate cyclic`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  sinew simulate cyclic --model running --out run.csv")]
pub struct SimulateCyclicArgs {
    /// Motion of the person, who has a pace and a style of their own: a shipped model, or a file of
    /// `sinew train cyclic`.
    #[arg(long, value_name = MODEL_VALUE)]
    pub model: String,
    /// Number of cycles.
    #[arg(long, value_name = "N", default_value_t = 12, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub cycles: u32,
    /// Standard deviation of a measured angle, degrees.
    #[arg(long, value_name = "DEGREES", default_value_t = 3.0, allow_negative_numbers = true)]
    pub sigma_deg: f64,
    /// Share of the angles that are missing.
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, allow_negative_numbers = true)]
    pub missing: f64,
    /// Frames per second.
    #[arg(long, value_name = "HZ", default_value_t = 60.0, allow_negative_numbers = true)]
    pub rate: f64,
    /// Seed of all that is random: the person and the errors of measurement.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Angle table to write.
    #[arg(long, value_name = "TABLE.csv")]
    pub out: PathBuf,
}

/// Draws a person, measures them, writes the table.
///
/// # Errors
/// A model that cannot be read, a number out of range, an output that cannot be written.
pub fn run(args: &SimulateCyclicArgs, console: &Console) -> Result<()> {
    let SimulateCyclicArgs { sigma_deg, missing, rate, seed, .. } = *args;
    ensure!((0.0..=90.0).contains(&sigma_deg), "--sigma-deg has to lie from 0 to 90 degrees, not {sigma_deg}");
    ensure!((0.0..1.0).contains(&missing), "--missing has to be a share of at least 0 and less than 1, not {missing}");
    ensure!((1.0..=1000.0).contains(&rate), "--rate has to lie from 1 to 1000 Hz, not {rate}");
    let model = CyclicModel::from_option(&args.model)?;
    check_writable_file(&args.out)?;
    let person = SyntheticPerson::draw(&model, rate, seed)?;
    let table = person.measured(args.cycles, sigma_deg.to_radians(), missing, seed)?;
    table.write(&args.out)?;
    let text = format!(
        "{} frames at {rate} frames per second: {} cycles of {} frames\nwrote {}\n",
        table.rows().len(),
        args.cycles,
        person.cycle_frames(),
        args.out.display()
    );
    let json = json!({
        "frames": table.rows().len(),
        "rate_hz": rate,
        "cycles": args.cycles,
        "cycle_frames": person.cycle_frames(),
        "out": args.out,
    });
    console.answer_beside(&args.out, &text, &json)
}
