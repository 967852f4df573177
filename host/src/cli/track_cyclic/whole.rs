//! A recording that is kept whole, for what needs all rows at once: a report, pictures, several
//! motions, smoothing.

use super::args::TrackCyclicArgs;
use super::motions::Motions;
use super::place::Place;
use super::summary_line::summary_line;
use crate::cli::console::Console;
use crate::cyclic::about::About;
use crate::cyclic::angle_units::in_degrees;
use crate::cyclic::own_cycle::{finish, noise};
use crate::cyclic::pictures::{Drawn, OverlayFrames, animation};
use crate::cyclic::plausibility;
use crate::cyclic::report::body::Body;
use crate::cyclic::report::joints::figures;
use crate::cyclic::report::{Origin, OverlayOrigin, Report};
use crate::cyclic::tracking::table;
use crate::cyclic::tracking::{TableRun, Tracked, TrackingOptions};
use crate::cyclic::{AngleTable, CyclicModel};
use crate::error::Error;
use crate::output::OutputDir;
use crate::resume::{Checkpoints, Interrupted, Left};
use anyhow::{Result, ensure};
use serde_json::json;
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Tracks the table, then writes all that is asked for.
pub(super) fn track(
    args: &TrackCyclicArgs,
    options: TrackingOptions,
    console: &Console,
    stop: &AtomicBool,
    notify: &mut dyn FnMut(usize),
) -> Result<()> {
    let place = Place::of(args)?;
    let left = place.left(args)?;
    let output = args.report.as_deref().map(OutputDir::create).transpose()?;
    let models = args.models()?;
    let angles = AngleTable::read(&args.table)?;
    let options = &of_recording(args, &angles, options)?;
    let begun = args.begun(&models)?;
    let overlay =
        args.overlay.as_deref().map(|pictures| with_output(pictures, &angles, options, &args.out)).transpose()?;
    let mut run = TableRun::begin(&angles, &models, options)?;
    if let Some(left) = &left {
        left.begun.check_options(&begun, &args.out)?;
        left.begun.check_inputs(&begun)?;
        // The state of a run that kept no rows does not hold its answers.
        let state = left.state.as_deref().filter(|_| !left.has_tables());
        run.restore(left.finished, state)?;
    }
    let start = Instant::now();
    let seconds_before = left.map_or(0.0, |left| left.seconds);
    let save = |run: &mut TableRun<'_>| -> crate::Result<()> {
        let Some(file) = place.resume_file() else { return Ok(()) };
        let seconds = seconds_before + start.elapsed().as_secs_f64();
        file.put(&Left::new(begun.clone(), run.finished(), seconds, None, run.saved()?))
    };
    let about = About::read_beside(&args.table)?;
    let shown = Shown { args, angles: &angles, about, models: &models, options, output, overlay };
    let ended = follow(&mut run, stop, notify, args, console, &save)
        .and_then(|is_complete| shown.write(&run, is_complete, stop, console));
    match &ended {
        Ok(()) => place.clear()?,
        // The error says more than one that comes of saving.
        Err(_) => drop(save(&mut run)),
    }
    ended
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
    let checkpoints = RefCell::new(Checkpoints::after_each(args.checkpoint.interval()));
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

/// The options with what the recording says: its rate, and its noise unless that is given.
fn of_recording(args: &TrackCyclicArgs, angles: &AngleTable, options: TrackingOptions) -> Result<TrackingOptions> {
    let options = TrackingOptions { rate_hz: Some(args.rate_hz(angles.rate_hz())?), ..options };
    let is_noise_found = args.sigma_deg.is_none() && !args.online;
    Ok(if is_noise_found { noise::with_noise_of(angles, options) } else { options })
}

/// What is made of a run.
struct Shown<'a> {
    args: &'a TrackCyclicArgs,
    angles: &'a AngleTable,
    about: Option<About>,
    models: &'a [CyclicModel],
    options: &'a TrackingOptions,
    output: Option<OutputDir>,
    overlay: Option<(RefCell<OverlayFrames>, OutputDir)>,
}

impl Shown<'_> {
    /// Writes the estimates; of a complete run also report and pictures, and prints a summary.
    fn write(&self, run: &TableRun<'_>, is_complete: bool, stop: &AtomicBool, console: &Console) -> Result<()> {
        let Self { args, angles, options, .. } = self;
        let (tracked, motions) = run.answered()?;
        let is_finished = is_complete && args.is_finished();
        let given_rad = args.sigma_deg.map(f64::to_radians);
        let counted = tracked.frames.last().map_or(0.0, |frame| frame.cycles);
        let tracked = if is_finished { finish(angles, &self.models[0], tracked, options, given_rad)? } else { tracked };
        let motions = motions.map(|motions| Motions::new(&args.model, self.models, &motions, tracked.rate_hz));
        let motions = motions.as_ref();
        table::write(&tracked, motions.map(|motions| &motions.cells), &args.out)?;
        let interrupted =
            || Interrupted { finished: run.finished(), all: Some(run.rows()), unit: "rows", out: args.out.clone() };
        ensure!(is_complete, interrupted());
        let is_of_none = motions.is_some_and(|motions| motions.leading().is_none());
        let new_report = if is_of_none { Report::without_cycles } else { Report::new };
        let report = new_report(angles, &tracked, options, args.height);
        let mut text = summary(&report);
        text.extend(motions.map(Motions::line));
        let mut doubts = self.doubts(&report, motions);
        doubts.extend(plausibility::counted_backwards(counted).filter(|_| is_finished));
        text.extend(doubts.iter().map(|doubt| format!("doubt: {doubt}\n")));
        let notes = plausibility::notes(self.models, &report.gait);
        notes.iter().filter(|_| self.output.is_some()).for_each(|note| console.note(note));
        text.push_str(&format!("wrote {}\n", args.out.display()));
        if let Some(output) = &self.output {
            self.write_report(&report, &tracked, motions, [&doubts, &notes], output)?;
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
            "motion_frames": motions.map(Motions::counts),
            "doubts": doubts,
            "notes": notes,
            "out": args.out,
            "report": args.report,
            "overlay": self.overlay.as_ref().map(|(_, folder)| folder.path()),
            "animation": args.animation,
            "viewer": args.viewer.rerun,
        });
        console.answer_beside(&args.out, &text, &json)?;
        ensure!(!args.strict || doubts.is_empty(), Error::Invalid(format!("--strict: {}", doubts.join("; "))));
        Ok(())
    }

    /// What speaks against the recording or the result.
    fn doubts(&self, report: &Report, motions: Option<&Motions<'_>>) -> Vec<String> {
        let of_recording = self.about.iter().flat_map(|about| about.doubts.clone());
        // The feet of several motions are those of each of them for a while.
        let gait = report.gait.as_ref().ok().filter(|_| motions.is_none_or(|motions| !motions.are_several()));
        let of_run = match motions.map(|motions| motions.leading().ok_or(motions)) {
            Some(Err(motions)) => vec![plausibility::no_motion(&motions.choice(), motions.named_rows())],
            Some(Ok(leading)) => plausibility::doubts(&report.summary, &report.series, &self.models[leading], gait),
            None => plausibility::doubts(&report.summary, &report.series, &self.models[0], gait),
        };
        let of_units = in_degrees(self.angles, report.series.rate_hz);
        of_units.into_iter().chain(of_recording).chain(of_run).collect()
    }

    fn write_report(
        &self,
        report: &Report,
        tracked: &Tracked,
        motions: Option<&Motions<'_>>,
        [doubts, notes]: [&[String]; 2],
        output: &OutputDir,
    ) -> Result<()> {
        let args = self.args;
        let drawn = self.overlay.as_ref().map(|(frames, folder)| OverlayOrigin {
            folder: folder.path().display().to_string(),
            images: frames.borrow().names(),
        });
        let origin = Origin {
            table: &args.table.display().to_string(),
            model: &args.model.join(", "),
            options: self.options,
            height_m: args.height_m(),
            motions: motions.map(|motions| &motions.cells),
            overlay: drawn.as_ref(),
            is_finished: args.is_finished(),
            about: self.about.as_ref(),
            doubts,
            notes,
        };
        Ok(report.write(&origin, self.angles, tracked, output)?)
    }

    /// Draws overlays and animation unless `stop` is set; reports on standard error what was
    /// skipped.
    fn draw(&self, tracked: &Tracked, report: &Report, stop: &AtomicBool, console: &Console) -> Result<String> {
        let (args, angles) = (self.args, self.angles);
        let body = Body::of_table(angles, args.height_m());
        let figures = figures(angles, tracked, &report.measured_shares, &body, self.options.sigma_rad)?;
        let mut text = String::new();
        if let Some((frames, folder)) = &self.overlay {
            let drawn = Drawn { table: angles, tracked, figures: &figures, body: &body };
            let overlaid = frames.borrow_mut().draw(&drawn, folder, stop)?;
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

/// The frames with the folder of their overlays; of a video as many a second as the table has.
fn with_output(
    pictures: &Path,
    angles: &AngleTable,
    options: &TrackingOptions,
    out: &Path,
) -> Result<(RefCell<OverlayFrames>, OutputDir)> {
    let frames = OverlayFrames::open(pictures, options.rate_hz.unwrap_or_default())?;
    OverlayFrames::check(angles)?;
    Ok((RefCell::new(frames), OutputDir::create(&overlay_folder(out))?))
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
    let mut text = summary_line(&report.summary);
    for joint in &report.symmetries {
        if let (Some(left), Some(right)) = (joint.left_range_deg, joint.right_range_deg) {
            let index = joint.symmetry_index_percent.map_or_else(
                || ", too little against the noise for an index".to_owned(),
                |index| format!(", index {index:+.0} %"),
            );
            let name = joint.angle.replace('_', " ");
            text.push_str(&format!("{name}: range left {left:.1}, right {right:.1} degrees{index}\n"));
        }
    }
    text
}
