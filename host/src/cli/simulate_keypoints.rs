//! `sinew simulate keypoints`: what a pose detector would write of a made-up person.

use super::console::Console;
use crate::cyclic::facing::Facing;
use crate::cyclic::model_file::MODEL_VALUE;
use crate::cyclic::synthetic_keypoints::{FilmedPerson, Filming};
use crate::cyclic::{CyclicModel, SyntheticPerson};
use crate::output::{check_writable_file, write_atomically};
use anyhow::Result;
use clap::Args;
use serde_json::json;
use std::path::PathBuf;

/// Arguments of `sinew simulate keypoints`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  sinew simulate keypoints --out keypoints.csv
  sinew simulate keypoints --model running --facing left --out run.csv")]
pub struct SimulateKeypointsArgs {
    /// Motion of the person, who has a pace and a style of their own: a shipped model, or a file of
    /// `sinew train cyclic`.
    #[arg(long, value_name = MODEL_VALUE, default_value = "walking")]
    pub model: String,
    /// Length of the recording, seconds.
    #[arg(long, value_name = "SECONDS", default_value_t = 6.0, allow_negative_numbers = true)]
    pub seconds: f64,
    /// Frames per second.
    #[arg(long, value_name = "HZ", default_value_t = 30.0, allow_negative_numbers = true)]
    pub rate: f64,
    /// Which way the person goes.
    #[arg(long, value_enum, default_value_t = Facing::Right)]
    pub facing: Facing,
    /// Height of the person in the picture, pixels.
    #[arg(long, value_name = "PIXELS", default_value_t = 400.0, allow_negative_numbers = true)]
    pub height_px: f64,
    /// Standard deviation of each coordinate, pixels.
    #[arg(long, value_name = "PIXELS", default_value_t = 1.5, allow_negative_numbers = true)]
    pub sigma_px: f64,
    /// Share of the keypoints that are missing.
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, allow_negative_numbers = true)]
    pub missing: f64,
    /// Seed of all that is random: the person and the errors of the detector.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Table of keypoints to write.
    #[arg(long, value_name = "KEYPOINTS.csv")]
    pub out: PathBuf,
}

/// Draws a person, films them, writes the keypoints.
///
/// # Errors
/// A model that cannot be read, a number out of range, an output that cannot be written.
pub fn run(args: &SimulateKeypointsArgs, console: &Console) -> Result<()> {
    let SimulateKeypointsArgs { seconds, rate, height_px, sigma_px, missing, seed, .. } = *args;
    let filming = Filming {
        frames: 0,
        rate_hz: rate,
        height_px,
        facing: args.facing,
        noise_px: sigma_px,
        missing_share: missing,
        seed,
    };
    let filming = Filming::lasting(seconds, filming)?;
    let model = CyclicModel::from_option(&args.model)?;
    check_writable_file(&args.out)?;
    let person = SyntheticPerson::draw(&model, rate, seed)?;
    let filmed = FilmedPerson::film(&person, &filming);
    write_atomically(&args.out, |file| Ok(file.write_all(filmed.to_csv(&filming).as_bytes())?))?;
    let cadence_per_min = 60.0 * rate / person.cycle_frames();
    let [width, height] = filmed.size_px;
    let text = format!(
        "{} frames at {rate} frames per second, a picture of {width} x {height}: {cadence_per_min:.1} cycles a minute\nwrote {}\n",
        filming.frames,
        args.out.display()
    );
    let json = json!({
        "frames": filming.frames,
        "rate_hz": rate,
        "image_size_px": filmed.size_px,
        "cadence_per_min": cadence_per_min,
        "out": args.out,
    });
    console.answer_beside(&args.out, &text, &json)
}
