//! `sinew track cyclic`: angles, phase and cadence from an angle table.

use super::checkpoint_args::CheckpointArgs;
use super::console::Console;
use super::signals::stop_flag;
use super::viewer_args::ViewerArgs;
use crate::cyclic::model_file::MODEL_VALUE;
use crate::cyclic::pictures::{OverlayFrames, animation};
use crate::cyclic::report::body::Body;
use crate::cyclic::report::joints::figures;
use crate::cyclic::report::{Origin, OverlayOrigin, Report};
use crate::cyclic::tracking::table::{self, MotionCells, NO_MOTION};
use crate::cyclic::tracking::{FilterName, NamedMotion, StartName, TableRun, Tracked, TrackingOptions, Updates};
use crate::cyclic::{AngleTable, CyclicModel};
use crate::file::STANDARD_INPUT;
use crate::output::{OutputDir, OutputLock, Target, check_writable_file};
use crate::resume::{Begun, Checkpoints, Interrupted, Left, ResumeFile, file_crc32, text_crc32};
use anyhow::{Result, bail, ensure};
use clap::Args;
use serde_json::json;
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Options of `sinew track cyclic`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  sinew simulate cyclic --model walking --out walk.csv
  sinew track cyclic walk.csv --model walking --out est.csv --report run")]
pub struct TrackCyclicArgs {
    /// Angle table, made by `sinew angles` from a motion in space or from keypoints; - is standard
    /// input.
    pub table: PathBuf,
    /// Motion: a shipped one, or a file of `sinew train cyclic`. Given several times, the motion of
    /// each frame is named, or none of these, and tracked by its own model.
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
    /// Position in the cycle at the first frame, [0, 1) [default: where the model's pose fits
    /// best].
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
    /// Give each frame the estimate that the whole recording speaks for, later frames included (not
    /// with `particle`).
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
    /// Folder for what a coach reads: summary, repetitions, curves over the cycle, symmetry, plots,
    /// TRC and MOT files.
    #[arg(long, value_name = "DIR")]
    pub report: Option<PathBuf>,
    /// Draw the figure on the images of this folder, frame k of the table on image k in natural
    /// order, counted from 0. The pictures are written into `EST_overlay` beside the estimates.
    /// Needs a table from keypoints.
    #[arg(long, value_name = "FRAMES_DIR")]
    pub overlay: Option<PathBuf>,
    /// Write the stick figure alone as an animation, what was measured thin and grey behind the
    /// estimate.
    #[arg(long, value_name = "FILE.gif")]
    pub animation: Option<PathBuf>,
    /// Height of the person, metres: the scale of the report's joints.trc.
    #[arg(long, value_name = "METRES", default_value_t = 1.75)]
    pub height: f64,
    /// Go on with the run to --out that did not reach its end; what decides the estimates has to be
    /// the same.
    #[arg(long)]
    pub resume: bool,
    /// When the state is saved.
    #[command(flatten)]
    pub checkpoint: CheckpointArgs,
    /// The run for a viewer.
    #[command(flatten)]
    pub viewer: ViewerArgs,
}

/// The subcommand, in what it leaves.
const COMMAND: &str = "track cyclic";

/// Tracks the table, writes the estimates, prints cycles and cadence.
///
/// # Errors
/// A table or model that cannot be used, an option out of range, an output that cannot be written,
/// or [`Interrupted`].
pub fn run(args: &TrackCyclicArgs, console: &Console) -> Result<()> {
    console.resumable(run_until(args, console, stop_flag()?, &mut |_| ()))
}

/// As [`run`], ended by `stop` in the place of a signal; `notify` gets the number of finished rows.
///
/// # Errors
/// As [`run`].
pub fn run_until(
    args: &TrackCyclicArgs,
    console: &Console,
    stop: &AtomicBool,
    notify: &mut dyn FnMut(usize),
) -> Result<()> {
    let options = options(args);
    options.check()?;
    check(args)?;
    let frames = args.overlay.as_deref().map(OverlayFrames::open).transpose()?;
    let file = match Target::of(&args.out)? {
        // What came on standard input does not come again.
        _ if is_stream(args) => None,
        Target::File(path) => Some((ResumeFile::beside(&path, COMMAND), OutputLock::of_table(&path, COMMAND)?)),
        Target::Fifo(_) | Target::Standard => None,
    };
    let file = file.as_ref().map(|(file, _)| file);
    let left: Option<Left<Option<String>>> = match (args.resume, file) {
        (false, _) => None,
        (true, Some(file)) => Some(file.read(&args.out)?),
        (true, None) => bail!("--resume goes on with files; give a table and --out as files"),
    };
    let output = args.report.as_deref().map(OutputDir::create).transpose()?;
    let models = args.model.iter().map(|name| CyclicModel::from_option(name)).collect::<crate::Result<Vec<_>>>()?;
    let angles = AngleTable::read(&args.table)?;
    let begun = begun(args, &models)?;
    let mut run = TableRun::begin(&angles, &models, &options)?;
    if let Some(left) = &left {
        left.begun.check_options(&begun, &args.out)?;
        left.begun.check_inputs(&begun)?;
        run.restore(left.finished, left.state.as_deref())?;
    }
    let overlay = frames.as_ref().map(|frames| with_output(frames, &angles, &args.out)).transpose()?;
    let start = Instant::now();
    let seconds_before = left.map_or(0.0, |left| left.seconds);
    let save = |run: &mut TableRun<'_>| -> crate::Result<()> {
        let Some(file) = file else { return Ok(()) };
        let seconds = seconds_before + start.elapsed().as_secs_f64();
        file.put(&Left::new(begun.clone(), run.finished(), seconds, None, run.saved()?))
    };
    let shown = Shown { args, angles: &angles, options: &options, output, overlay };
    let ended = follow(&mut run, stop, notify, args, console, &save)
        .and_then(|is_complete| shown.write(&run, is_complete, stop, console));
    match (&ended, file) {
        (Ok(()), Some(file)) => file.remove()?,
        // The error says more than one that comes of saving.
        (Err(_), _) => drop(save(&mut run)),
        (Ok(()), None) => (),
    }
    ended
}

/// Whether the table comes on standard input.
fn is_stream(args: &TrackCyclicArgs) -> bool {
    args.table.as_os_str() == STANDARD_INPUT
}

/// How the estimates come about; what is made of them may differ from run to run.
fn begun(args: &TrackCyclicArgs, models: &[CyclicModel]) -> Result<Begun> {
    let options = json!({
        "model": args.model,
        "filter": args.filter,
        "sigma_deg": args.sigma_deg,
        "particles": args.particles,
        "init": args.init,
        "initial_cycle_position": args.initial_cycle_position,
        "initial_cycle_velocity": args.initial_cycle_velocity,
        "update_every": args.update_every,
        "update_at": args.update_at,
        "smooth": args.smooth,
        "rate": args.rate,
        "seed": args.seed,
    });
    let mut begun = Begun::new(COMMAND, &options, &[])?;
    if !is_stream(args) {
        begun = begun.on(&args.table)?.reading(format!("`{}`", args.table.display()), file_crc32(&args.table)?);
    }
    let named = args.model.iter().zip(models);
    Ok(named.fold(begun, |begun, (name, model)| {
        begun.reading(format!("the model `{name}`"), text_crc32(&format!("{:?}", model.numbers())))
    }))
}

/// Tracks with a progress bar on standard error, if that is a terminal, until the last row or a
/// signal; whether it was the last row.
fn follow(
    run: &mut TableRun<'_>,
    stop: &AtomicBool,
    notify: &mut dyn FnMut(usize),
    args: &TrackCyclicArgs,
    console: &Console,
    save: &dyn Fn(&mut TableRun<'_>) -> crate::Result<()>,
) -> Result<bool> {
    let bar = console.bar(run.rows() as u64, "{wide_bar} row {pos} of {len}, {per_sec}")?;
    bar.set_position(run.finished() as u64);
    bar.reset_eta();
    let is_stopped = || stop.load(Ordering::Relaxed);
    let checkpoints = RefCell::new(Checkpoints::every(args.checkpoint.interval()));
    let mut all = || -> crate::Result<bool> {
        loop {
            let pause = || is_stopped() || checkpoints.borrow_mut().is_due();
            let is_complete = run.run(&pause, &mut |finished| {
                bar.set_position(finished as u64);
                notify(finished);
            })?;
            if is_complete || is_stopped() {
                return Ok(is_complete);
            }
            save(run)?;
        }
    };
    let ended = all();
    bar.finish_and_clear();
    Ok(ended?)
}

/// What is made of a run.
struct Shown<'a> {
    args: &'a TrackCyclicArgs,
    angles: &'a AngleTable,
    options: &'a TrackingOptions,
    output: Option<OutputDir>,
    overlay: Option<(&'a OverlayFrames, OutputDir)>,
}

impl Shown<'_> {
    /// Writes the estimates; of a complete run also report and pictures, and prints a summary.
    fn write(&self, run: &TableRun<'_>, is_complete: bool, stop: &AtomicBool, console: &Console) -> Result<()> {
        let Self { args, angles, options, .. } = self;
        let (tracked, motions) = run.answered()?;
        let motions = motions.map(|motions| motion_cells(&args.model, &motions));
        table::write(&tracked, motions.as_ref(), &args.out)?;
        let interrupted =
            || Interrupted { finished: run.finished(), all: Some(run.rows()), unit: "rows", out: args.out.clone() };
        ensure!(is_complete, interrupted());
        let report = Report::new(angles, &tracked, options);
        let mut text = summary(&report);
        if let Some(motions) = &motions {
            text.push_str(&told_motions(&args.model, motions));
        }
        text.push_str(&format!("wrote {}\n", args.out.display()));
        if let Some(output) = &self.output {
            self.write_report(&report, &tracked, motions.as_ref(), output)?;
            text.push_str(&format!("report: {}\n", output.path().display()));
        }
        if self.overlay.is_some() || args.animation.is_some() {
            text.push_str(&self.draw(&tracked, &report, stop, console)?);
            // Those that are drawn are kept; a resumption draws all.
            ensure!(!stop.load(Ordering::Relaxed), interrupted());
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
            "overlay": self.overlay.as_ref().map(|(_, folder)| folder.path()),
            "animation": args.animation,
            "viewer": args.viewer.rerun,
        });
        console.answer_beside(&args.out, &text, &json)
    }

    fn write_report(
        &self,
        report: &Report,
        tracked: &Tracked,
        motions: Option<&MotionCells>,
        output: &OutputDir,
    ) -> Result<()> {
        let args = self.args;
        let drawn = self.overlay.as_ref().map(|(frames, folder)| OverlayOrigin {
            folder: folder.path().display().to_string(),
            images: frames.names(),
        });
        let origin = Origin {
            table: &args.table.display().to_string(),
            model: &args.model.join(", "),
            options: self.options,
            height_m: args.height,
            motions,
            overlay: drawn.as_ref(),
        };
        Ok(report.write(&origin, self.angles, tracked, output)?)
    }

    /// Draws overlays and animation unless `stop` is set; reports on standard error what was
    /// skipped.
    fn draw(&self, tracked: &Tracked, report: &Report, stop: &AtomicBool, console: &Console) -> Result<String> {
        let (args, angles) = (self.args, self.angles);
        let body = Body::of_table(angles, args.height);
        let figures = figures(angles, tracked, &report.measured_shares, &body, args.sigma_deg.to_radians())?;
        let mut text = String::new();
        if let Some((frames, folder)) = &self.overlay {
            let overlaid = frames.draw((angles, tracked), &figures, &body, folder, stop)?;
            for reason in overlaid.skipped.iter().take(TOLD_REASONS) {
                console.note(format!("overlay: {reason}; skipped"));
            }
            if overlaid.skipped.len() > TOLD_REASONS {
                console.note(format!("overlay: {} more of the kind", overlaid.skipped.len() - TOLD_REASONS));
            }
            text.push_str(&format!("overlay: {} pictures in {}\n", overlaid.written, folder.path().display()));
        }
        if let Some(path) = args.animation.as_ref().filter(|_| !stop.load(Ordering::Relaxed)) {
            animation::write(path, angles, &figures, &body, tracked.rate_hz)?;
            let longest = animation::LONGEST_S;
            if tracked.frames.len() as f64 > longest * tracked.rate_hz {
                console.note(format!("animation: only the first {longest} seconds are shown"));
            }
            text.push_str(&format!("animation: {}\n", path.display()));
        }
        Ok(text)
    }
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

/// Most reasons for skipped overlays that are printed.
const TOLD_REASONS: usize = 5;

/// Cycles and cadence, and how alike the sides are, for a terminal.
fn summary(report: &Report) -> String {
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
