//! A run from its first cloud to its last, and the files that it writes.

use super::answer::Answer;
use super::report::BodyRunReport;
use super::resume;
use super::track::{BodyEvent, BodyTrackRun, Notify};
use crate::body::export::{body_layout, bvh_frame, upwards};
use crate::error::Result;
use crate::motion::export::{BvhFrame, TrcFrame, TrcHeading, TrcUnit, to_trc, write_bvh};
use crate::output::{PendingFile, finish_all, finished_table};
use crate::resume::{Ended, Interrupted};
use sinew_core::math::Vec3;
use sinew_core::skeleton::full_body::BODY_JOINT_NAMES;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// Frames without a file that an animation repeats the pose before for, all in all; longer gaps are
/// cut out of it.
const MAX_REPEATED_FRAMES: u64 = 100_000;

impl BodyTrackRun {
    /// Tracks all clouds, or those before `stop` is set, and writes the run directory.
    ///
    /// # Errors
    /// [`Interrupted`] if `stop` was set, a broken cloud if the run is strict, or an output that
    /// cannot be written. In each case the run leaves what [`BodyTrackRun::resume`] needs.
    pub fn run(mut self, stop: &AtomicBool, notify: Notify<'_>) -> Result<BodyRunReport> {
        self.started = Instant::now();
        let (frames, out) = (self.frame_count(), self.out.path().to_path_buf());
        for note in &self.report.notes {
            notify(BodyEvent::Note(note));
        }
        for warning in &self.report.warnings {
            notify(BodyEvent::Warning(warning));
        }
        let tracked = self.track_all(stop, notify);
        let finished = self.report.frames_finished;
        let seconds = self.seconds + self.started.elapsed().as_secs_f64();
        self.report.frames_per_second = finished as f64 / seconds.max(1.0e-9);
        self.report.complete = matches!(tracked, Ok(true));
        let interrupted = Interrupted { finished, all: Some(frames), unit: "frames", out };
        match Ended::of(tracked, &mut || self.save().is_ok()) {
            Ended::Unwritable(error) => Err(error),
            ended => ended.conclude(self.write_results(), interrupted),
        }
    }

    /// Gives the tables their names with the other files, once all are written. A run that is
    /// killed meanwhile can be resumed after its last frame.
    fn write_results(mut self) -> Result<BodyRunReport> {
        self.save()?;
        self.report.seconds_per_step = self.step_s / self.report.frames_finished.max(1) as f64;
        self.report.effective_share = self.effective_share.mean().unwrap_or(0.0);
        (self.report.error_m, self.report.joint_error_m) = (self.score.marker_m.mean(), self.score.joint_m.mean());
        self.report.lost_joint_share = self.score.lost.mean();
        self.report.warn();
        self.report.state_crc32 = self.stream.state_crc32()?;
        let mut files = self.motion_files()?;
        files.push(finished_table(self.table)?);
        files.extend(self.particles.map(finished_table).transpose()?);
        if let Some(pictures) = self.pictures {
            files.extend(pictures.files(&self.out)?);
        }
        let json = serde_json::to_string_pretty(&self.report)? + "\n";
        files.push(self.out.pending("run.json", |writer| Ok(writer.write_all(json.as_bytes())?))?);
        finish_all(files)?;
        if self.report.complete {
            resume::file_in(self.out.path()).remove()?;
        }
        Ok(self.report)
    }

    /// `track.bvh` and `track.trc`; no frame at all is no file.
    fn motion_files(&self) -> Result<Vec<PendingFile>> {
        if self.answers.is_empty() {
            return Ok(Vec::new());
        }
        let (part, rate_hz) = (self.inputs.part, f64::from(self.inputs.rate_hz));
        let is_short = self.inputs.clouds.missing() <= MAX_REPEATED_FRAMES;
        let mut frames: Vec<BvhFrame> = Vec::with_capacity(self.answers.len());
        let mut markers = Vec::with_capacity(self.answers.len());
        let mut before: Option<(u64, BvhFrame)> = None;
        for Answer { frame, estimate } in &self.answers {
            if let (Some((number, last)), true) = (before, is_short) {
                // An animation has a frame for every number: what has no file keeps the pose
                // before.
                frames.extend((number + 1..*frame).map(|_| last.clone()));
            }
            let pose = bvh_frame(part, &self.stream.filter().scene().skeleton, &estimate.angles_rad);
            frames.push(pose.clone());
            let place = |end: &Vec3| Some(<[f32; 3]>::from(upwards(end)).map(f64::from));
            markers.push(TrcFrame {
                frame: *frame,
                positions_m: estimate.ends_m[..part.bones()].iter().map(place).collect(),
            });
            before = Some((*frame, pose));
        }
        let layout = body_layout(part, &self.stream.filter().scene().skeleton)?;
        let bvh = self.out.pending("track.bvh", |writer| Ok(write_bvh(&layout, &frames, rate_hz, writer)?))?;
        let heading =
            TrcHeading { name: "track.trc", markers: &BODY_JOINT_NAMES[..part.bones()], rate_hz, unit: TrcUnit::Metre };
        let text = to_trc(&heading, &markers);
        Ok(vec![bvh, self.out.pending("track.trc", |writer| Ok(writer.write_all(text.as_bytes())?))?])
    }
}
