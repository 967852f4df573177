//! `sinew demo`: a rendered scene with known truth, tracked, and compared with the truth.

use super::console::Console;
use super::data_error;
use super::track_arm::run_with_progress;
use crate::config::Config;
use crate::motion::{ArmSide, reach};
use crate::output::OutputDir;
use crate::scene::{Scene, SceneOptions, Sides};
use crate::signal::median::median;
use crate::track::{RunOutcome, TrackOptions, TrackRun};
use anyhow::{Result, bail};
use clap::Args;
use serde::Serialize;
use serde_json::json;
use sinew_core::tracker::arm::Status;
use std::path::{Path, PathBuf};

/// Frames of the scene: eight seconds.
const FRAMES: usize = 120;
/// Frames per second of the scene.
const RATE_HZ: f32 = 15.0;
/// First frame whose error counts: the tracker needs a second to find the arm.
const FIRST_SCORED_FRAME: usize = 16;
/// Further than this from the true hand a place is wrong, pixels of a picture 640 wide: two palms.
const WRONG_PX: f64 = 60.0;
/// Marks a scene that the demo made and may replace.
const MARK: &str = "demo.json";

/// Options of `sinew demo`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  sinew demo --out run")]
pub struct DemoArgs {
    /// Run directory, as that of `sinew track arm --overlay`, with the scene in DIR/scene.
    #[arg(long, value_name = "DIR", default_value = "out/demo")]
    pub out: PathBuf,
    /// Seed of the scene and of the tracker.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
}

/// The content of `error.json`: distance of the tracked hand from the true one, over frames
/// `first_frame` to `last_frame`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DemoError {
    /// First frame that counts.
    pub first_frame: usize,
    /// Last frame that counts.
    pub last_frame: usize,
    /// Mean 3D error, metres.
    pub mean_error_m: f64,
    /// Median 3D error, metres.
    pub median_error_m: f64,
    /// Mean 2D error, pixels.
    pub mean_error_px: f64,
    /// Median 2D error, pixels.
    pub median_error_px: f64,
    /// Frames of the whole run that say `tracking` while the hand is in view.
    pub tracking_frames: usize,
    /// Of these, those whose hand is more than 60 pixels off.
    pub wrong_frames: usize,
}

/// Renders, tracks, compares, and says where to look.
///
/// # Errors
/// An output that cannot be written, or [`crate::resume::Interrupted`].
pub fn run(args: &DemoArgs, console: &Console) -> Result<()> {
    let out = OutputDir::create(&args.out)?;
    let scene = render(&out, args.seed)?;
    let outcome = run_with_progress(TrackRun::prepare(track_options(&out, args.seed)?, out.path())?, console)?;
    let error = compare(&scene, &outcome)?;
    let json = serde_json::to_string_pretty(&error)? + "\n";
    out.write("error.json", |writer| Ok(writer.write_all(json.as_bytes())?))?;
    let json = json!({ "error": error, "run": outcome.report, "out": out.path() });
    console.answer(&report(&outcome, &error, out.path()), &json)
}

/// A person who reaches about with the right arm; the face shows half of the time, the hand is
/// hidden a tenth of it.
fn render(out: &OutputDir, seed: u64) -> Result<Scene> {
    let motion = reach::random_reaches(seed, RATE_HZ, FRAMES)?;
    let sides = Sides::One(ArmSide::Right);
    let options = SceneOptions { frames: FRAMES, frames_per_second: RATE_HZ, seed, sides, ..SceneOptions::default() };
    let scene = Scene::new(&motion, &options)?;
    let folder = scene_folder(out)?;
    scene.write_folder(&folder)?;
    Ok(scene)
}

/// DIR/scene, which has to be new or made by an earlier demo.
fn scene_folder(out: &OutputDir) -> Result<OutputDir> {
    let path = out.join("scene");
    if path.join("frames").exists() && !path.join(MARK).exists() {
        bail!("`{}` holds frames that the demo did not make; choose another --out", path.display());
    }
    let folder = out.subfolder("scene")?;
    let mark = serde_json::json!({ "made_by": "sinew demo", "frames": FRAMES });
    folder.write(MARK, |writer| Ok(serde_json::to_writer_pretty(writer, &mark)?))?;
    Ok(folder)
}

fn track_options(out: &OutputDir, seed: u64) -> Result<TrackOptions> {
    let scene = out.join("scene");
    Ok(TrackOptions {
        folder: scene.join("frames"),
        rate_hz: f64::from(RATE_HZ),
        seed,
        overlay: true,
        strict: true,
        config: Config::load(&scene.join("camera.toml"))?,
        ..TrackOptions::default()
    })
}

/// Distances of the tracked hand from the true one. A hand that is projected nowhere is as wrong as
/// the image is wide.
fn compare(scene: &Scene, outcome: &RunOutcome) -> Result<DemoError> {
    if outcome.samples.len() != scene.len() {
        return Err(data_error(format!(
            "{} frames were tracked in place of {}; `{}` holds other images, too: take them out",
            outcome.samples.len(),
            scene.len(),
            outcome.report.inputs.folder.display()
        )));
    }
    let camera = scene.camera();
    let width_px = f64::from(scene.options().width_px);
    let scored = outcome.samples.iter().enumerate().skip(FIRST_SCORED_FRAME);
    let errors = scored.filter_map(|(frame, sample)| {
        let truth = scene.truth(frame).sides.into_iter().next()?;
        let error_m = f64::from((sample.hand_m? - truth.joints.hand_m).norm());
        let true_px = truth.hand_px(&camera)?;
        Some((error_m, sample.hand_px.map_or(width_px, |pixel| f64::from(pixel.distance_px(true_px)))))
    });
    let (mut errors_m, mut errors_px): (Vec<f64>, Vec<f64>) = errors.unzip();
    let sure = outcome.samples.iter().enumerate().filter_map(|(frame, sample)| {
        let truth = scene.truth(frame).sides.into_iter().next()?;
        let true_px = truth.hand_px(&camera).filter(|_| truth.hand_visible && sample.status == Status::Tracking)?;
        Some(sample.hand_px.map_or(width_px, |pixel| f64::from(pixel.distance_px(true_px))))
    });
    let sure_px: Vec<f64> = sure.collect();
    let nothing = || data_error("no frame can be compared with the truth");
    Ok(DemoError {
        first_frame: FIRST_SCORED_FRAME,
        last_frame: scene.len() - 1,
        mean_error_m: mean(&errors_m).ok_or_else(nothing)?,
        median_error_m: median(&mut errors_m).ok_or_else(nothing)?,
        mean_error_px: mean(&errors_px).ok_or_else(nothing)?,
        median_error_px: median(&mut errors_px).ok_or_else(nothing)?,
        tracking_frames: sure_px.len(),
        wrong_frames: sure_px.iter().filter(|error_px| **error_px > WRONG_PX).count(),
    })
}

/// Mean by Welford's update, `None` of nothing.
fn mean(values: &[f64]) -> Option<f64> {
    let step = |mean: f64, (count, value): (usize, &f64)| mean + (value - mean) / count as f64;
    (!values.is_empty()).then(|| (1..).zip(values).fold(0.0, step))
}

/// What a newcomer reads at the end.
fn report(outcome: &RunOutcome, error: &DemoError, out: &Path) -> String {
    let folder = out.display();
    format!(
        "\
A person was rendered whose arm and camera are known, and the right arm was tracked from the pictures alone.

{}
Distance of the tracked hand from the true one, frames {} to {}:
  in space:     mean {:.3} m,  median {:.3} m
  in the image: mean {:.1} px, median {:.1} px  (images are {} px wide)
Of {} frames that say `tracking` while the hand is in view, {} are more than 60 px off.

Look at
  {folder}/contact_sheet.png   the run at a glance
  {folder}/overlay/            every frame with the arm, the particles and the blobs
  {folder}/hand.png            the hand's path, and how sure the tracker was over time
  {folder}/track.csv           the numbers; {folder}/scene/truth.csv holds the true ones

Try next, with a folder of your own webcam frames (PNG or JPEG):
  sinew track arm FOLDER --out out/mine --overlay
  sinew track arm --help
",
        outcome.report.summary(),
        error.first_frame,
        error.last_frame,
        error.mean_error_m,
        error.median_error_m,
        error.mean_error_px,
        error.median_error_px,
        outcome.report.image_size_px.0,
        error.tracking_frames,
        error.wrong_frames,
    )
}
