//! `sinew track body`: a whole body from point clouds.

use super::checkpoint_args::CheckpointArgs;
use super::console::Console;
use super::scene_args::numbers;
use super::signals::stop_flag;
use super::viewer_args::ViewerArgs;
use crate::body::BodyPart;
use crate::body::run::{
    BodyEvent, BodyRunReport, BodyTrackOptions, BodyTrackRun, DEPTH_POINTS, SizeSource, tuning_file,
};
use crate::body::tracking::{BodyModelKind, BodyStreamOptions, BodyTuning};
use crate::cloud::MAX_POINTS;
use crate::registry::{Kind, MEASURABLE, choice, extensions};
use anyhow::{Context, Result};
use clap::Args;
use serde_json::json;
use std::path::PathBuf;

/// Options of `sinew track body`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  sinew simulate stereo --motion pelvic-lift --points 300 --out points
  sinew track body points --particles 20 --out run --pictures")]
pub struct TrackBodyArgs {
    /// Folder of point clouds.
    #[arg(value_name = "DIR", required_unless_present = "print_config", help = format!(
        "Folder of point clouds ({}), one file a frame; or a folder that holds them in points/, as `simulate stereo` \
         writes it. What it holds of body.json, first_pose.json, stick.csv, truth.csv and run.json (rate, camera, \
         floor) is used",
        choice(&[Kind::Cloud])
    ))]
    pub folder: Option<PathBuf>,
    /// Camera of depth images.
    #[arg(long, value_name = "FILE.json", help = format!(
        "Camera of depth images: DIR or DIR/depth holds those ({}), 16 bits of grey, in place of clouds \
         [default: DIR/camera.json]",
        choice(&[Kind::Depth])
    ))]
    pub camera: Option<PathBuf>,
    /// Points count inside of this box, metres, camera axes: x right, y down, z forward.
    #[arg(long, value_name = "X0,X1,Y0,Y1,Z0,Z1", value_parser = numbers::<6>, allow_hyphen_values = true)]
    pub inside: Option<[f32; 6]>,
    /// Points count where A x + B y + C z + D is positive, in metres: 0,-1,0,0.95 cuts off a floor
    /// that is a metre below a level camera.
    #[arg(long, value_name = "A,B,C,D", value_parser = numbers::<4>, allow_hyphen_values = true)]
    pub above_plane: Option<[f32; 4]>,
    /// Maximum number of points of a frame that are weighed, drawn at random.
    #[arg(long, value_name = "N", allow_negative_numbers = true, help = format!(
        "Maximum number of points of a frame that are weighed, drawn at random [default: {MAX_POINTS} of clouds, \
         {DEPTH_POINTS} of depth images]"
    ))]
    pub points: Option<usize>,
    /// Folder for track.csv, track.bvh, track.trc, run.json and what else is asked for; files of
    /// these names are replaced.
    #[arg(long, value_name = "DIR", required_unless_present = "print_config")]
    pub out: Option<PathBuf>,
    /// How much of the body is tracked: a camera that sees no legs asks for the upper part
    /// [default: that of DIR/run.json, or whole].
    #[arg(long, value_enum)]
    pub body: Option<BodyPart>,
    /// How particles move.
    #[arg(long, value_enum, default_value_t)]
    pub model: BodyModelKind,
    /// Number of particles [default: 30 of guided, 500 of the others].
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub particles: Option<usize>,
    /// The person: measures, or a motion or skeleton to measure.
    #[arg(long, value_name = "FILE", conflicts_with = "height", help = format!(
        "The person: a body.json, or a motion or skeleton to measure ({}) [default: DIR/body.json]",
        extensions(MEASURABLE)
    ))]
    pub skeleton: Option<PathBuf>,
    /// Take a motion to measure that has fewer frames than its header promises.
    #[arg(long)]
    pub partial: bool,
    /// Height of a person who is not measured, metres.
    #[arg(long, value_name = "METRES", allow_negative_numbers = true)]
    pub height: Option<f32>,
    /// Where lengths and radii come from [default: given with --skeleton or DIR/body.json,
    /// otherwise estimated].
    #[arg(long, value_enum)]
    pub size: Option<SizeSource>,
    /// Pose of the first frame [default: DIR/first_pose.json; without one, someone who
    /// stands or walks is looked for].
    #[arg(long, value_name = "FILE.json")]
    pub init: Option<PathBuf>,
    /// Ends of the stick, for --model stick [default: DIR/stick.csv].
    #[arg(long, value_name = "FILE.csv")]
    pub stick: Option<PathBuf>,
    /// Numbers of the motion models.
    #[arg(long, value_name = "FILE.toml")]
    pub config: Option<PathBuf>,
    /// Write the defaults as a configuration to standard output, and do nothing else.
    #[arg(long)]
    pub print_config: bool,
    /// Seed of all that is random; the same seed gives the same result on any number of threads.
    #[arg(long, value_name = "N", default_value_t = BodyStreamOptions::default().seed)]
    pub seed: u64,
    /// Number of threads [default: all].
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub threads: Option<usize>,
    /// Frames per second of the camera [default: that of DIR/run.json, or 15].
    #[arg(long, value_name = "HZ", allow_negative_numbers = true)]
    pub rate: Option<f32>,
    /// Write every particle of every frame into particles.csv.
    #[arg(long)]
    pub particles_csv: bool,
    /// Draw some frames from the front and the side on contact_sheet.png, and curves over time.
    #[arg(long)]
    pub pictures: bool,
    /// End the run at a cloud that cannot be read; without it such a frame counts as one without
    /// points.
    #[arg(long)]
    pub strict: bool,
    /// Go on with the run in --out that did not reach its end; the other options have to be the
    /// same, but for --threads.
    #[arg(long)]
    pub resume: bool,
    /// When the state is saved.
    #[command(flatten)]
    pub checkpoint: CheckpointArgs,
    /// The run for a viewer.
    #[command(flatten)]
    pub viewer: ViewerArgs,
}

/// Tracks the folder, or prints the default numbers.
///
/// # Errors
/// Bad input, an output that cannot be written, or [`crate::resume::Interrupted`].
pub fn run(args: &TrackBodyArgs, console: &Console) -> Result<()> {
    if args.print_config {
        return console.answer(&tuning_file::printed()?, &BodyTuning::default());
    }
    args.viewer.check()?;
    let out = args.out.as_deref().context("no --out was given")?;
    let options = BodyTrackOptions {
        folder: args.folder.clone().context("no DIR was given")?,
        camera: args.camera.clone(),
        inside_m: args.inside,
        above_plane: args.above_plane,
        max_points: args.points,
        part: args.body,
        model: args.model,
        particles: args.particles.unwrap_or(args.model.default_particles()),
        skeleton: args.skeleton.clone(),
        partial: args.partial,
        height_m: args.height,
        size: args.size,
        init: args.init.clone(),
        stick: args.stick.clone(),
        seed: args.seed,
        threads: args.threads,
        rate_hz: args.rate,
        strict: args.strict,
        // The viewer shows them.
        particles_csv: args.particles_csv || args.viewer.is_wanted(),
        pictures: args.pictures,
        tuning: args.config.as_deref().map_or_else(|| Ok(BodyTuning::default()), tuning_file::load)?,
    };
    // A signal while the first pose and the size are looked for leaves a run that can be resumed.
    stop_flag()?;
    let run = if args.resume { BodyTrackRun::resume(options, out)? } else { BodyTrackRun::prepare(options, out)? };
    let run = run.checkpoint_every(args.checkpoint.interval());
    let report = console.resumable(run_with_progress(run, console))?;
    let viewer = args.viewer.write(out, console)?;
    let names = contents(&report);
    let text = format!("{}results in `{}`: {}\n{viewer}", report.summary(), out.display(), names.join(", "));
    console.answer(&text, &json!({ "out": out, "contents": names, "viewer": args.viewer.rerun, "run": report }))
}

/// Tracks with a progress bar on standard error, if that is a terminal; a signal stops it after the
/// current frame.
fn run_with_progress(run: BodyTrackRun, console: &Console) -> Result<BodyRunReport> {
    let bar = console.bar(run.frame_count() as u64, "{wide_bar} frame {pos} of {len}, {per_sec}")?;
    bar.set_position(run.frames_finished() as u64);
    bar.reset_eta();
    let print = |text: String| bar.suspend(|| console.note(text));
    let outcome = run.run(stop_flag()?, &mut |event| match event {
        BodyEvent::Note(note) => print(format!("note: {note}")),
        BodyEvent::Warning(warning) => print(format!("warning: {warning}")),
        BodyEvent::Skipped(cloud) => print(format!("skipped frame {}: {}", cloud.frame, cloud.reason)),
        BodyEvent::OverCap { points, weighed } => print(format!(
            "note: a cloud has {points} points; {weighed} of them, drawn at random, are weighed, here and in all like it"
        )),
        BodyEvent::Finished(frames) => bar.set_position(frames as u64),
    });
    bar.finish_and_clear();
    Ok(outcome?)
}

/// What the run directory holds.
fn contents(report: &BodyRunReport) -> Vec<&'static str> {
    let mut names = vec!["track.csv", "track.bvh", "track.trc", "run.json"];
    names.extend(report.options.particles_csv.then_some("particles.csv"));
    if report.options.pictures {
        names.extend(["contact_sheet.png", "effective_samples.png"]);
        names.extend(report.joint_error_m.map(|_| "joint_error.png"));
    }
    names
}
