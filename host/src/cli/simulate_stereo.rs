//! `sinew simulate stereo`: a whole body before a stereo camera.

use super::console::Console;
use super::scene_args::{clear_frames, pair};
use super::scene_error_args::SceneErrorArgs;
use crate::body::recording::DEFAULT_RATE_HZ;
use crate::body::{BodyPart, Placement};
use crate::motion::{DEFAULT_FRAMES_PER_SECOND, endings_without_rate};
use crate::output::OutputDir;
use crate::registry::{MOTION, choice};
use crate::stereo::{Hidden, StereoMotion, StereoOptions, StereoScene, StereoSource};
use anyhow::{Context, Result};
use clap::Args;
use serde_json::json;
use std::path::PathBuf;

/// Arguments of `sinew simulate stereo`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  sinew simulate stereo --motion pelvic-lift --points 300 --out points")]
pub struct SimulateStereoArgs {
    /// Motion: a file, or one that is built in.
    #[arg(long, value_name = "FILE|stick-wave|pelvic-lift", help = format!(
        "Motion: a {} file, or one that is built in",
        choice(MOTION)
    ))]
    pub motion: PathBuf,
    /// Skeleton of a .amc motion [default: the only .asf beside it].
    #[arg(long, value_name = "FILE.asf")]
    pub skeleton: Option<PathBuf>,
    /// Frames per second of a motion file that does not say.
    #[arg(long, value_name = "HZ", help = format!(
        "Frames per second of a motion file that does not say ({}) [default: {}]",
        endings_without_rate(),
        DEFAULT_FRAMES_PER_SECOND
    ))]
    pub motion_rate: Option<f32>,
    /// Part of the motion that is used, in seconds from its beginning.
    #[arg(long, value_name = "START,END", value_parser = pair::<f32>)]
    pub between: Option<(f32, f32)>,
    /// Take a motion with fewer frames than its header promises.
    #[arg(long)]
    pub partial: bool,
    /// Mean distance of the pelvis from the camera, metres; larger if the person would come too
    /// near or leave the picture.
    #[arg(long, value_name = "METRES", default_value_t = Placement::default().mean_distance_m)]
    pub distance: f32,
    /// Turn of the person to their left, degrees; 0 faces the camera on the mean.
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, allow_negative_numbers = true)]
    pub heading: f32,
    /// Frames per second of the camera.
    #[arg(long, value_name = "HZ", default_value_t = DEFAULT_RATE_HZ)]
    pub rate: f32,
    /// How much of the body the camera sees; the points are on it alone.
    #[arg(long, value_enum, default_value_t = BodyPart::Whole)]
    pub body: BodyPart,
    /// Points in a frame, outliers included.
    #[arg(long, value_name = "N", default_value_t = 2000)]
    pub points: usize,
    /// Share of the points that are outliers.
    #[arg(long, value_name = "SHARE", default_value_t = 0.1)]
    pub outliers: f32,
    /// Patches of the picture in which no point is found; they move slowly over the body.
    #[arg(long, value_name = "N", default_value_t = 4)]
    pub patches: u32,
    /// Leave out the points on a limb (l_arm, r_arm, l_leg, r_leg) from one frame to another, both
    /// included; may be repeated.
    #[arg(long, value_name = "LIMB:FIRST-LAST")]
    pub hide: Vec<Hidden>,
    /// What else is wrong with the scene.
    #[command(flatten)]
    pub errors: SceneErrorArgs,
    /// Seed of all that is random.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Folder for points/, truth.csv, body.json, first_pose.json, stick.csv and run.json.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Replace the scene that DIR already holds.
    #[arg(long)]
    pub force: bool,
}

/// Runs `sinew simulate stereo`.
///
/// # Errors
/// A motion that cannot be read, an option out of range, a folder that cannot be written or holds
/// points already.
pub fn run(args: &SimulateStereoArgs, console: &Console) -> Result<()> {
    let source = StereoSource {
        motion: args.motion.clone(),
        skeleton: args.skeleton.clone(),
        motion_rate_hz: args.motion_rate,
        between_s: args.between,
        partial: args.partial,
        distance_m: args.distance,
        heading_deg: args.heading,
        rate_hz: args.rate,
        seed: args.seed,
    };
    let motion = source.read()?;
    motion.check_hidden(&args.hide)?;
    let StereoMotion { recording, stick_m, floor_y_m, notes } = motion;
    notes.iter().for_each(|note| console.note(note));
    let options = StereoOptions {
        part: args.body,
        points: args.points,
        outliers: args.outliers,
        patches: args.patches,
        hidden: args.hide.clone(),
        errors: args.errors.errors(),
        seed: args.seed,
        ..StereoOptions::default()
    };
    let scene = StereoScene::new(recording, options).context("this scene cannot be made")?;
    let output = OutputDir::create(&args.out)?;
    clear_frames(&output.join("points"), "", ".ply", args.force)?;
    let name = args.motion.display().to_string();
    scene.write_folder(&name, floor_y_m, stick_m.as_deref(), &notes, &output)?;
    let text = format!("{} frames of points with their truth in `{}`\n", scene.len(), args.out.display());
    console.answer(&text, &json!({ "frames": scene.len(), "notes": notes, "out": args.out }))
}
