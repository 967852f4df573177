//! A run from its first frame to its last, and the files that it writes.

use super::report::RunReport;
use super::resume;
use super::run::{Event, TrackRun};
use super::sample::HandSample;
use super::source::FrameSource;
use crate::error::{Error, Result};
use crate::output::finish_table;
use crate::resume::Interrupted;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// What a run returns beside its files.
#[derive(Debug, Clone)]
pub struct RunOutcome {
    /// The content of `run.json`.
    pub report: RunReport,
    /// Every side's answer to every finished frame, in the order of frames; places are given for a
    /// lost arm, too.
    pub samples: Vec<HandSample>,
}

impl TrackRun {
    /// Tracks all frames, or those before `stop` is set, and writes the run directory.
    ///
    /// # Errors
    /// [`Interrupted`] if `stop` was set, or an output that cannot be written; the table of the
    /// finished frames is written all the same.
    pub fn run(mut self, stop: &AtomicBool, notify: &mut dyn FnMut(Event<'_>)) -> Result<RunOutcome> {
        let start = Instant::now();
        let out = self.out.path().to_path_buf();
        let tracked = self.track_all(stop, notify);
        let finished = self.report.frames_finished;
        if matches!(self.frames, FrameSource::Video(_)) {
            // Only now it is known how many there are.
            self.report.inputs.files = (0..finished).map(|frame| self.frames.name(frame)).collect();
            self.report.frames = if matches!(tracked, Ok(true)) { finished } else { self.report.frames.max(finished) };
        }
        let frames = self.report.frames;
        self.seconds += start.elapsed().as_secs_f64();
        self.report.frames_per_second = finished as f64 / self.seconds.max(1.0e-9);
        self.report.complete = matches!(tracked, Ok(true));
        let interrupted = matches!(tracked, Ok(false));
        let written = self.write_results(interrupted);
        if let Err(error) = tracked {
            let kept = match &written {
                Ok(_) => format!("the results of the {finished} finished frames are in `{}`", out.display()),
                Err(other) => format!("and then {}", other.chain()),
            };
            return Err(Error::Unfinished { error: Box::new(error), kept });
        }
        let outcome = written?;
        if interrupted {
            return Err(Interrupted { finished, all: Some(frames), unit: "frames", out }.into());
        }
        Ok(outcome)
    }

    /// Gives the tables their names and writes plot, sheet and report. Each file is tried, also
    /// where another one failed. An interrupted run leaves what [`TrackRun::resume`] needs.
    fn write_results(mut self, interrupted: bool) -> Result<RunOutcome> {
        let left = if interrupted { Some(resume::left(&mut self)?) } else { None };
        let Self { out, track, particles, pictures, report, samples, .. } = self;
        let mut results = vec![finish_table(track)];
        results.extend(particles.map(finish_table));
        let json = serde_json::to_string_pretty(&report)? + "\n";
        results.push(out.write("run.json", |writer| Ok(writer.write_all(json.as_bytes())?)));
        #[cfg(feature = "plots")]
        results.push(
            crate::draw::plot::hand_plot(&samples, report.image_size_px)
                .and_then(|plot| out.write_png("hand.png", &plot)),
        );
        results.extend(pictures.map(|pictures| out.write_png("contact_sheet.png", &pictures.contact_sheet())));
        results.into_iter().collect::<Result<()>>()?;
        resume::put(left, &report.options, &out)?;
        Ok(RunOutcome { report, samples })
    }
}
