//! `sinew track cyclic`: angles, phase and cadence from an angle table.

use super::console::Console;
use super::viewer_args::ViewerArgs;
use crate::cyclic::model::MODEL_VALUE;
use crate::cyclic::pictures::{OverlayFrames, animation};
use crate::cyclic::report::body::Body;
use crate::cyclic::report::joints::figures;
use crate::cyclic::report::{Origin, OverlayOrigin, Report};
use crate::cyclic::tracking::table::{self, MotionCells, NO_MOTION};
use crate::cyclic::tracking::{
    FilterName, NamedMotion, StartName, Tracked, TrackingOptions, Updates, track, track_bank,
};
use crate::cyclic::{AngleTable, CyclicModel};
use crate::output::{OutputDir, check_writable_file};
use anyhow::{Result, ensure};
use clap::Args;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Options of `sinew track cyclic`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  sinew simulate cyclic --model walking --out walk.csv
  sinew track cyclic walk.csv --model walking --out est.csv --report run")]
pub struct TrackCyclicArgs {
    /// Angle table, made by `sinew angles` from a motion in space or from keypoints.
    pub table: PathBuf,
    /// Motion: a shipped one, or a file of `sinew train cyclic`. Given several times, the motion of each frame is named, or none
    /// of these, and tracked by its own model.
    #[arg(long, value_name = MODEL_VALUE, required = true)]
    pub model: Vec<String>,
    /// Filter.
    #[arg(long, value_enum, default_value_t = FilterName::Coupled)]
    pub filter: FilterName,
    /// Standard deviation of a measured angle, degrees.
    #[arg(long, value_name = "DEGREES", default_value_t = 6.0)]
    pub sigma_deg: f64,
    /// Number of particles.
    #[arg(long, value_name = "N", default_value_t = 10_000)]
    pub particles: usize,
    /// What is known of the first state.
    #[arg(long, value_enum, default_value_t = StartName::Standard)]
    pub init: StartName,
    /// Position in the cycle at the first frame, [0, 1) [default: where the model's pose fits best].
    #[arg(long, value_name = "X")]
    pub initial_cycle_position: Option<f64>,
    /// Cycles per frame at the first frame [default: the model's mean].
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub initial_cycle_velocity: Option<f64>,
    /// Use only every K-th measurement after the first.
    #[arg(long, value_name = "K", conflicts_with = "update_at")]
    pub update_every: Option<u64>,
    /// Use only the measurements of these frames.
    #[arg(long, value_name = "F1,F2,...", value_delimiter = ',')]
    pub update_at: Option<Vec<u64>>,
    /// Give each frame the estimate that the whole recording speaks for, later frames included (not with `particle`).
    #[arg(long)]
    pub smooth: bool,
    /// Frames per second of the recording [default: those of the model].
    #[arg(long, value_name = "HZ")]
    pub rate: Option<f64>,
    /// Seed of everything that is drawn.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Table of estimates to write.
    #[arg(long, value_name = "EST.csv")]
    pub out: PathBuf,
    /// Folder for what a coach reads: summary, repetitions, curves over the cycle, symmetry, plots, TRC and MOT files.
    #[arg(long, value_name = "DIR")]
    pub report: Option<PathBuf>,
    /// Draw the figure on the images of this folder, frame k of the table on image k in natural order, counted from 0; they are written
    /// into `EST_overlay` beside the estimates. Needs a table from keypoints.
    #[arg(long, value_name = "FRAMES_DIR")]
    pub overlay: Option<PathBuf>,
    /// Write the stick figure alone as an animation, what was measured thin and grey behind the estimate.
    #[arg(long, value_name = "FILE.gif")]
    pub animation: Option<PathBuf>,
    /// Height of the person, metres: the scale of the report's joints.trc.
    #[arg(long, value_name = "METRES", default_value_t = 1.75)]
    pub height: f64,
    /// The run for a viewer.
    #[command(flatten)]
    pub viewer: ViewerArgs,
}

/// Tracks the table, writes the estimates, prints cycles and cadence.
///
/// # Errors
/// A table or model that cannot be used, an option out of range, an output that cannot be written.
pub fn run(args: &TrackCyclicArgs, console: &Console) -> Result<()> {
    let options = options(args);
    options.check()?;
    check(args)?;
    let frames = args.overlay.as_deref().map(OverlayFrames::open).transpose()?;
    let output = args.report.as_deref().map(OutputDir::create).transpose()?;
    let models = args.model.iter().map(|name| CyclicModel::from_option(name)).collect::<Result<Vec<_>>>()?;
    let angles = AngleTable::read(&args.table)?;
    let overlay = frames.as_ref().map(|frames| with_output(frames, &angles, &args.out)).transpose()?;
    let drawn_into = overlay.as_ref().map(|(_, folder)| folder.path().to_path_buf());
    let (tracked, motions) = match models.as_slice() {
        [model] => (track(&angles, model, &options)?, None),
        several => {
            let bank = track_bank(&angles, several, &options)?;
            let cells = motion_cells(&args.model, &bank.motions);
            (bank.tracked, Some(cells))
        }
    };
    table::write(&tracked, motions.as_ref(), &args.out)?;
    let report = Report::new(&angles, &tracked, &options);
    let mut text = told(&report);
    if let Some(motions) = &motions {
        text.push_str(&told_motions(&args.model, motions));
    }
    text.push_str(&format!("wrote {}\n", args.out.display()));
    if let Some(output) = output {
        let drawn = overlay.as_ref().map(|(frames, folder)| OverlayOrigin {
            folder: folder.path().display().to_string(),
            images: frames.names(),
        });
        let origin = Origin {
            table: &args.table.display().to_string(),
            model: &args.model.join(", "),
            options: &options,
            height_m: args.height,
            motions: motions.as_ref(),
            overlay: drawn.as_ref(),
        };
        report.write(&origin, &angles, &tracked, &output)?;
        text.push_str(&format!("report: {}\n", output.path().display()));
    }
    if overlay.is_some() || args.animation.is_some() {
        text.push_str(&show(args, &angles, &tracked, &report, overlay, console)?);
    }
    if let Some(run) = &args.report {
        text.push_str(&args.viewer.write(run, console)?);
    }
    let json = json!({
        "summary": report.summary,
        "symmetries": report.symmetries,
        "motion_frames": motions.as_ref().map(|motions| motion_counts(&args.model, motions)),
        "out": args.out,
        "report": args.report,
        "overlay": drawn_into,
        "animation": args.animation,
        "viewer": args.viewer.rerun,
    });
    console.answer(&text, &json)
}

/// What can be checked before anything is read.
fn check(args: &TrackCyclicArgs) -> Result<()> {
    ensure!((0.3..=3.0).contains(&args.height), "`height` has to lie from 0.3 to 3 metres, not {}", args.height);
    ensure!(
        !args.viewer.is_wanted() || args.report.is_some(),
        "`--rerun` shows a run directory; give one with `--report DIR`"
    );
    args.viewer.check()?;
    check_writable_file(&args.out)?;
    if let Some(path) = &args.animation {
        let is_gif = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gif"));
        ensure!(is_gif, "`animation` has to end in .gif, not `{}`", path.display());
        check_writable_file(path)?;
    }
    Ok(())
}

fn motion_cells(names: &[String], motions: &[NamedMotion]) -> MotionCells {
    let name = |motion: &NamedMotion| motion.motion.map_or_else(|| NO_MOTION.to_owned(), |index| names[index].clone());
    motions.iter().map(|motion| (name(motion), motion.probability)).collect()
}

/// In how many frames each motion was named, in the order of the options, none of them last.
fn motion_counts<'a>(names: &'a [String], motions: &MotionCells) -> Vec<(&'a str, usize)> {
    let count = |name: &str| motions.iter().filter(|(other, _)| other == name).count();
    names.iter().map(String::as_str).chain([NO_MOTION]).map(|name| (name, count(name))).collect()
}

fn told_motions(names: &[String], motions: &MotionCells) -> String {
    let counts = motion_counts(names, motions);
    let counts: Vec<String> = counts.iter().map(|(name, count)| format!("{name} in {count}")).collect();
    format!("motion: {} frames\n", counts.join(", "))
}

/// The frames with the folder of their overlays.
fn with_output<'f>(
    frames: &'f OverlayFrames,
    angles: &AngleTable,
    out: &Path,
) -> Result<(&'f OverlayFrames, OutputDir)> {
    OverlayFrames::check(angles)?;
    Ok((frames, OutputDir::create(&overlay_folder(out))?))
}

/// `estimate_overlay` beside `estimate.csv`.
fn overlay_folder(out: &Path) -> PathBuf {
    let stem = out.file_stem().unwrap_or_default().to_string_lossy();
    out.with_file_name(format!("{stem}_overlay"))
}

/// Most reasons for skipped overlays that are told.
const TOLD_REASONS: usize = 5;

/// Draws overlays and animation; tells on standard error what was skipped.
fn show(
    args: &TrackCyclicArgs,
    angles: &AngleTable,
    tracked: &Tracked,
    report: &Report,
    overlay: Option<(&OverlayFrames, OutputDir)>,
    console: &Console,
) -> Result<String> {
    let body = Body::of_table(angles, args.height);
    let figures = figures(angles, tracked, &report.measured_shares, &body, args.sigma_deg.to_radians())?;
    let mut text = String::new();
    if let Some((frames, folder)) = overlay {
        let overlaid = frames.draw(angles, tracked, &figures, &body, &folder)?;
        for reason in overlaid.skipped.iter().take(TOLD_REASONS) {
            console.note(format!("overlay: {reason}; skipped"));
        }
        if overlaid.skipped.len() > TOLD_REASONS {
            console.note(format!("overlay: {} more of the kind", overlaid.skipped.len() - TOLD_REASONS));
        }
        text.push_str(&format!("overlay: {} pictures in {}\n", overlaid.written, folder.path().display()));
    }
    if let Some(path) = &args.animation {
        animation::write(path, angles, &figures, &body, tracked.rate_hz)?;
        let longest = animation::LONGEST_S;
        if tracked.frames.len() as f64 > longest * tracked.rate_hz {
            console.note(format!("animation: only the first {longest} seconds are shown"));
        }
        text.push_str(&format!("animation: {}\n", path.display()));
    }
    Ok(text)
}

/// Cycles and cadence, and how alike the sides are, for a terminal.
fn told(report: &Report) -> String {
    let summary = &report.summary;
    let mut text = format!(
        "{} frames, {:.2} s: {:.2} cycles, {:.2} a minute, {} outliers\n",
        summary.frames, summary.duration_s, summary.cycles, summary.cadence_per_min, summary.outliers
    );
    for joint in &report.symmetries {
        if let (Some(left), Some(right)) = (joint.left_range_deg, joint.right_range_deg) {
            let index = joint.symmetry_index_percent.map_or_else(String::new, |index| format!(", index {index:+.0} %"));
            let name = joint.angle.replace('_', " ");
            text.push_str(&format!("{name}: range left {left:.1}, right {right:.1} degrees{index}\n"));
        }
    }
    text
}

fn options(args: &TrackCyclicArgs) -> TrackingOptions {
    let updates = match (&args.update_every, &args.update_at) {
        (Some(every), _) => Updates::Every(*every),
        (None, Some(frames)) => Updates::At(frames.clone()),
        (None, None) => Updates::All,
    };
    TrackingOptions {
        filter: args.filter,
        sigma_rad: args.sigma_deg.to_radians(),
        start: args.init,
        initial_cycle_position: args.initial_cycle_position,
        initial_cycle_velocity: args.initial_cycle_velocity,
        updates,
        rate_hz: args.rate,
        particles: args.particles,
        seed: args.seed,
        smooth: args.smooth,
    }
}
