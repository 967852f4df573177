//! `sinew track arm`: shoulder, elbow and hand for every frame of a folder.

use super::checkpoint_args::CheckpointArgs;
use super::console::Console;
use super::signals::stop_flag;
use super::skin_args::SkinArgs;
use super::variant_arg::variant_parser;
use super::viewer_args::ViewerArgs;
use crate::config::{Config, DEFAULT_FILE, MAX_PARTICLES};
use crate::images::{VideoFacts, is_video};
use crate::registry::{Kind, extensions};
use crate::track::{
    DEFAULT_RATE_HZ, DEFAULT_SEED, Event, FrontEnd, RATES_HZ, RunOutcome, SideChoice, TrackOptions, TrackRun,
};
use anyhow::{Context, Result};
use clap::Args;
use serde_json::json;
use sinew_core::tracker::arm::Variant;
use std::path::PathBuf;

/// Options of `sinew track arm`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  sinew simulate arm --motion builtin --frames 30 --out scene
  sinew track arm scene/frames --config scene/camera.toml --out run --overlay")]
pub struct TrackArmArgs {
    /// Folder of video frames, or a video.
    #[arg(value_name = "FOLDER|VIDEO", required_unless_present = "print_config", help = format!(
        "Folder of video frames ({}), all of one size, tracked in natural order of their names; or a video ({}), which \
         the installed ffmpeg reads",
        extensions(&[Kind::Image]),
        extensions(&[Kind::Video])
    ))]
    pub folder: Option<PathBuf>,
    /// Folder for track.csv, run.json, hand.png and what else is asked for; files of these names
    /// are replaced, each as a whole, when the run ends.
    #[arg(long, value_name = "DIR", required_unless_present = "print_config")]
    pub out: Option<PathBuf>,
    /// Camera, person and thresholds; options of the command line come before it.
    #[arg(long, value_name = "FILE.toml")]
    pub config: Option<PathBuf>,
    /// Write the defaults as a commented configuration to standard output, and do nothing else.
    #[arg(long)]
    pub print_config: bool,
    /// Which arms; left is the person's left.
    #[arg(long, value_enum, default_value_t = SideChoice::default())]
    pub side: SideChoice,
    /// Which tracker [default: pik].
    #[arg(long, value_parser = variant_parser())]
    pub variant: Option<Variant>,
    /// Number of particles of each arm [default: 50].
    #[arg(long, value_name = "N", value_parser = particle_count, allow_negative_numbers = true)]
    pub particles: Option<usize>,
    /// Seed of all that is random; the same seed gives the same result.
    #[arg(long, value_name = "N", default_value_t = DEFAULT_SEED)]
    pub seed: u64,
    /// Skin model and calibration.
    #[command(flatten)]
    pub skin: SkinArgs,
    /// Frames per second of the camera; of a video, how many are taken [default: 15, of a video its
    /// own].
    #[arg(long, value_name = "HZ", value_parser = rate_hz, allow_negative_numbers = true)]
    pub rate: Option<f64>,
    /// Draw what was found on every frame, into DIR/overlay, and some of these pictures on
    /// DIR/contact_sheet.png.
    #[arg(long)]
    pub overlay: bool,
    /// Write every particle of every frame into DIR/particles.csv.
    #[arg(long)]
    pub particles_csv: bool,
    /// Refuse the folder if one of its images cannot be read; without it such a frame counts as
    /// missing.
    #[arg(long)]
    pub strict: bool,
    /// Go on with the run in --out that did not reach its end; the other options have to be the
    /// same.
    #[arg(long)]
    pub resume: bool,
    /// What reads the pictures: `pictures` as they are, or `lines` of at most 320 x 240 pixels,
    /// exactly as firmware reads those of its camera.
    #[arg(long, value_enum, default_value_t = FrontEnd::default())]
    pub front_end: FrontEnd,
    /// Table of hands that any detector found, in place of skin: frame (from 0), u_px, v_px,
    /// size_px (diameter), probability, and side (left or right) where it is known.
    #[arg(long, value_name = "FILE.csv")]
    pub hands: Option<PathBuf>,
    /// Table of faces that any detector found, in place of those that are looked for: frame (from
    /// 0), u_px, v_px, size_px (width of the box).
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = ["no_face", "calibrate"])]
    pub head: Option<PathBuf>,
    /// Look for no face: use the skin model as it is, and shoulders and distance of the
    /// configuration; so, too, with --calibrate.
    #[arg(long)]
    pub no_face: bool,
    /// When the state is saved.
    #[command(flatten)]
    pub checkpoint: CheckpointArgs,
    /// The run for a viewer.
    #[command(flatten)]
    pub viewer: ViewerArgs,
}

fn particle_count(text: &str) -> Result<usize, String> {
    let count = text.parse().ok().filter(|count| (1..=MAX_PARTICLES).contains(count));
    count.ok_or_else(|| format!("particles must be a whole number from 1 to {MAX_PARTICLES}; 50 is a good choice"))
}

fn rate_hz(text: &str) -> Result<f64, String> {
    let rate = text.parse().ok().filter(|rate| (RATES_HZ[0]..=RATES_HZ[1]).contains(rate));
    let [low, high] = RATES_HZ;
    rate.ok_or_else(|| format!("the rate must lie from {low} to {high} Hz; give the camera's frames per second"))
}

/// Tracks the folder, or prints the default configuration.
///
/// # Errors
/// Bad input, an output that cannot be written, or [`crate::resume::Interrupted`].
pub fn run(args: &TrackArmArgs, console: &Console) -> Result<()> {
    if args.print_config {
        return console.answer(DEFAULT_FILE, &Config::default());
    }
    args.viewer.check()?;
    let folder = args.folder.clone().context("no FOLDER was given")?;
    let out = args.out.as_deref().context("no --out was given")?;
    let rate_hz = match args.rate {
        Some(rate_hz) => rate_hz,
        None if is_video(&folder) => VideoFacts::read(&folder)?.rate_hz,
        None => DEFAULT_RATE_HZ,
    };
    let options = TrackOptions {
        folder,
        side: args.side,
        rate_hz,
        seed: args.seed,
        skin: args.skin.skin.clone(),
        calibrate: args.skin.calibrate,
        front_end: args.front_end,
        hands: args.hands.clone(),
        head: args.head.clone(),
        face: !args.no_face && args.skin.calibrate.is_none(),
        overlay: args.overlay,
        // The viewer shows them.
        particles_csv: args.particles_csv || args.viewer.is_wanted(),
        strict: args.strict,
        config: effective_config(args)?,
    };
    let run = if args.resume { TrackRun::resume(options, out)? } else { TrackRun::prepare(options, out)? };
    let run = run.checkpoint_every(args.checkpoint.interval());
    let report = console.resumable(run_with_progress(run, console))?;
    let report = report.report;
    let viewer = args.viewer.write(out, console)?;
    let names = contents(args);
    let text = format!("{}results in `{}`: {}\n{viewer}", report.summary(), out.display(), names.join(", "));
    console.answer(&text, &json!({ "out": out, "contents": names, "viewer": args.viewer.rerun, "run": report }))
}

/// The configuration file, or the defaults, with what the command line sets.
fn effective_config(args: &TrackArmArgs) -> Result<Config> {
    let mut config = args.config.as_deref().map_or_else(|| Ok(Config::default()), Config::load)?;
    config.tracker.variant = args.variant.unwrap_or(config.tracker.variant);
    config.tracker.particles = args.particles.unwrap_or(config.tracker.particles);
    Ok(config)
}

/// Tracks with a progress bar on standard error, if that is a terminal; a signal stops it after the
/// current frame.
///
/// # Errors
/// As [`TrackRun::run`].
pub(super) fn run_with_progress(run: TrackRun, console: &Console) -> Result<RunOutcome> {
    let bar = console.bar(run.frame_count() as u64, "{wide_bar} frame {pos} of {len}, {per_sec}")?;
    bar.set_position(run.frames_finished() as u64);
    bar.reset_eta();
    let outcome = run.run(stop_flag()?, &mut |event| match event {
        Event::Skipped(image) => {
            let text = format!("skipped frame {}: `{}`: {}", image.frame, image.file, image.reason);
            bar.suspend(|| console.note(text));
        }
        Event::Finished(frames) => bar.set_position(frames as u64),
    });
    bar.finish_and_clear();
    Ok(outcome?)
}

/// What the run directory holds.
fn contents(args: &TrackArmArgs) -> Vec<&'static str> {
    let mut names = vec!["track.csv", "run.json", "hand.png"];
    names.extend((args.particles_csv || args.viewer.is_wanted()).then_some("particles.csv"));
    names.extend(args.overlay.then_some(["contact_sheet.png", "overlay/"]).into_iter().flatten());
    names
}
