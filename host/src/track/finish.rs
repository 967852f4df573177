//! A run from its first frame to its last, and the files that it writes.

use super::report::RunReport;
use super::resume;
use super::run::{Event, TrackRun};
use super::sample::HandSample;
use super::source::FrameSource;
use crate::error::Result;
use crate::output::{finish_all, finished_table};
use crate::resume::{Ended, Interrupted};
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
    /// Tracks all frames, or those before `stop` is set, and writes the run directory. A run that
    /// does not reach its end leaves what [`TrackRun::resume`] needs.
    ///
    /// # Errors
    /// [`Interrupted`] if `stop` was set, an input that cannot be read any more, or an output that
    /// cannot be written.
    pub fn run(mut self, stop: &AtomicBool, notify: &mut dyn FnMut(Event<'_>)) -> Result<RunOutcome> {
        self.started = Instant::now();
        let out = self.out.path().to_path_buf();
        let tracked = self.track_all(stop, notify);
        let finished = self.report.frames_finished;
        if matches!(self.frames, FrameSource::Video(_)) {
            // Only now it is known how many there are.
            self.report.inputs.files = (0..finished).map(|frame| self.frames.name(frame)).collect();
            self.report.frames = if matches!(tracked, Ok(true)) { finished } else { self.report.frames.max(finished) };
        }
        let frames = self.report.frames;
        let seconds = self.seconds + self.started.elapsed().as_secs_f64();
        self.report.frames_per_second = finished as f64 / seconds.max(1.0e-9);
        self.report.complete = matches!(tracked, Ok(true));
        self.report.state_crc32 = self.stream.state_crc32()?;
        self.report.warn();
        let interrupted = Interrupted { finished, all: Some(frames), unit: "frames", out };
        // Overlays of the last frames may not be there, and a resumed run has to find them.
        match Ended::of(tracked, &mut || self.pictures.is_none() && self.save().is_ok()) {
            Ended::Unwritable(error) => Err(error),
            ended => ended.conclude(self.write_results(), interrupted),
        }
    }

    /// Gives the tables their names with plot, sheet and report, once all are written. A run that
    /// is killed meanwhile can be resumed after its last frame.
    fn write_results(mut self) -> Result<RunOutcome> {
        self.save()?;
        let Self { out, track, particles, pictures, report, samples, .. } = self;
        let mut files = vec![finished_table(track)?];
        files.extend(particles.map(finished_table).transpose()?);
        let json = serde_json::to_string_pretty(&report)? + "\n";
        files.push(out.pending("run.json", |writer| Ok(writer.write_all(json.as_bytes())?))?);
        #[cfg(feature = "plots")]
        files.push(out.pending_png("hand.png", &crate::draw::plot::hand_plot(&samples, report.image_size_px)?)?);
        if let Some(pictures) = pictures {
            files.push(out.pending_png("contact_sheet.png", &pictures.contact_sheet())?);
        }
        finish_all(files)?;
        if report.complete {
            resume::file_in(out.path()).remove()?;
        }
        Ok(RunOutcome { report, samples })
    }
}
