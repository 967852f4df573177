//! `sinew evaluate hands`: both hands on real frames with reference boxes.

use super::{cells_in, until_signal};
use crate::hands::{ReferenceBox, load_frames, read_boxes, size_px};
use crate::hands_report::{HandsOptions, report};
use anyhow::{Result, ensure};
use clap::Args;
use image::RgbImage;
use serde_json::json;
use sinew::cli::console::Console;
use sinew::cli::data_error;
use sinew::config::Config;
use sinew::images::list_images;
use sinew::output::OutputDir;
use sinew::resume::{Begun, Stop, file_crc32, identity, text_crc32};
use sinew::skin::model::DEFAULT_SKIN;
use sinew::skin::{SkinModel, model_file};
use sinew::track::RATES_HZ;
use std::path::PathBuf;

/// Options of `sinew evaluate hands`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  sinew simulate arm --motion builtin --frames 20 --side both --out scene
  printf 'frame,x,y,w,h\\n9,280,300,90,90\\n' > boxes.csv
  sinew evaluate hands scene/frames --boxes boxes.csv --seeds 1 --out hands")]
pub struct EvaluateHandsArgs {
    /// Folder of video frames, all of one size, in natural order of their names.
    #[arg(value_name = "FOLDER")]
    pub folder: PathBuf,
    /// Table of reference boxes: frame (from 0), x, y, w, h in pixels, a row for each visible hand.
    #[arg(long, value_name = "BOXES.csv")]
    pub boxes: PathBuf,
    /// Frames per second of the camera.
    #[arg(long, value_name = "HZ", default_value_t = 15.0, value_parser = rate_hz, allow_negative_numbers = true)]
    pub rate: f64,
    /// Track with the seeds 1 to N.
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u64).range(1..=1000))]
    pub seeds: u64,
    /// Size of the window that moves over the frames, pixels.
    #[arg(long, value_name = "W,H", default_value = "440,360", value_parser = window_px)]
    pub window: (u32, u32),
    /// Skin model: gaussian or histogram (shipped), or a FILE made by `sinew train skin`.
    #[arg(long, value_name = "gaussian|histogram|FILE", default_value = DEFAULT_SKIN)]
    pub skin: String,
    /// Folder for the scores as hands.csv and hands.json.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Go on with the evaluation in --out that a signal ended; the other options have to be the
    /// same.
    #[arg(long, requires = "out")]
    pub resume: bool,
    /// Fail if a median misses the project's floors.
    #[arg(long)]
    pub require: bool,
}

fn rate_hz(text: &str) -> Result<f64, String> {
    let [low, high] = RATES_HZ;
    let rate = text.parse().ok().filter(|rate| (low..=high).contains(rate));
    rate.ok_or_else(|| format!("the rate must lie from {low} to {high} Hz; give the camera's frames per second"))
}

fn window_px(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once(',').and_then(|(w, h)| Some((w.trim().parse().ok()?, h.trim().parse().ok()?)));
    let size: Option<(u32, u32)> = sides.filter(|(w, h)| *w > 0 && *h > 0);
    size.ok_or_else(|| "a width and a height in pixels were expected, as 440,360".to_owned())
}

/// Measures and prints; with `--require` compares with the floors.
///
/// # Errors
/// Bad input, medians below the floors, or [`sinew::resume::Interrupted`].
pub fn run(args: &EvaluateHandsArgs, console: &Console) -> Result<()> {
    match args.out {
        Some(_) => until_signal(console, |stop| run_until(args, console, stop)),
        None => run_until(args, console, &|| false),
    }
}

/// As [`run`], ended by `stop` in the place of a signal.
///
/// # Errors
/// As [`run`].
pub fn run_until(args: &EvaluateHandsArgs, console: &Console, stop: Stop<'_>) -> Result<()> {
    let skin = SkinModel::from_option(&args.skin)?;
    let boxes = read_boxes(&args.boxes)?;
    let frames = load_frames(&args.folder)?;
    check(args, &frames, &boxes)?;
    let output = args.out.as_deref().map(OutputDir::create).transpose()?;
    let options = HandsOptions { rate_hz: args.rate, seeds: args.seeds, window_px: args.window };
    let cells = cells_in(output.as_ref(), &begun(args, &skin)?, args.resume, stop)?;
    let track = || report(&frames, &boxes, options, &Config::default(), &skin, &cells);
    let report = console.busy("tracking", track)?;
    if let Some(output) = output {
        output.write("hands.json", |writer| Ok(serde_json::to_writer_pretty(writer, &report)?))?;
        output.write("hands.csv", |writer| Ok(writer.write_all(report.to_csv().as_bytes())?))?;
    }
    cells.end()?;
    console.answer(&report.table(), &report)?;
    let misses = report.misses();
    if args.require && !misses.is_empty() {
        return Err(data_error(format!("`{}` misses the floors: {}", args.folder.display(), misses.join("; "))));
    }
    Ok(())
}

/// What the cells depend on.
fn begun(args: &EvaluateHandsArgs, skin: &SkinModel) -> Result<Begun> {
    let options = json!({ "rate": args.rate, "seeds": args.seeds, "window": args.window, "skin": args.skin });
    let begun = Begun::new("evaluate hands", &options, &[])?.on(&args.folder)?;
    let files = list_images(&args.folder)?.iter().map(|file| identity(file)).collect();
    let skin = text_crc32(&model_file::to_json(skin)?);
    Ok(begun.with_frames(files).reading("the skin model", skin).reading("the boxes", file_crc32(&args.boxes)?))
}

/// Do window and boxes fit the frames?
fn check(args: &EvaluateHandsArgs, frames: &[Option<RgbImage>], boxes: &[ReferenceBox]) -> Result<()> {
    let (width, height) = size_px(frames);
    let (window_width, window_height) = args.window;
    ensure!(
        window_width <= width && window_height <= height,
        "--window {window_width},{window_height} is larger than the frames, {width} x {height} pixels; give a smaller one"
    );
    for wanted in boxes {
        let (file, frame) = (args.boxes.display(), wanted.frame);
        if frame >= frames.len() {
            return Err(data_error(format!(
                "boxes `{file}`: frame {frame} is not among the {} frames of `{}`; they count from 0",
                frames.len(),
                args.folder.display()
            )));
        }
        if !(wanted.w > 0.0 && wanted.h > 0.0 && wanted.x.is_finite() && wanted.y.is_finite()) {
            return Err(data_error(format!(
                "boxes `{file}`: frame {frame} has a box without a size or place; w and h must be above zero"
            )));
        }
    }
    Ok(())
}
