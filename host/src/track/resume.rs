//! Going on with a run that did not reach its end: the trackers' state and what the plots show.

use super::input::SkippedImage;
use super::options::TrackOptions;
use super::run::TrackRun;
use super::sample::HandSample;
use super::seen::SeenCounts;
use crate::error::Result;
use crate::resume::{Begun, Left, List, ResumeFile, file_crc32, from_text, optional, real, reals, text_crc32, to_text};
use crate::skin::model_file;
use serde::{Deserialize, Serialize};
use sinew_core::camera::Pixel;
use sinew_core::math::Vec3;
use sinew_core::saved_state::{SavedState, StateKind, StateVisitor};
use sinew_core::skeleton::Side;
use sinew_core::tracker::arm::Status;
use std::path::Path;

pub(super) const COMMAND: &str = "track arm";

/// What the tables of a run do not hold.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct ArmState {
    skipped: Vec<SkippedImage>,
    /// The trackers.
    trackers: String,
    /// What reads the pictures, if it remembers anything.
    vision: Option<String>,
    /// What the plots show.
    samples: String,
    seen: SeenCounts,
}

/// What `run` leaves if it ends now.
pub(super) fn left(run: &mut TrackRun) -> Result<Left<ArmState>> {
    let mut samples = List::new(std::mem::take(&mut run.samples), NO_SAMPLE);
    let (trackers, vision) = run.stream.saved_parts()?;
    let state = ArmState {
        skipped: run.report.skipped.clone(),
        trackers,
        vision,
        samples: to_text(StateKind::Arm, &mut samples)?,
        seen: run.report.seen,
    };
    run.samples = samples.entries;
    let begun = run.begun()?;
    let seconds = run.seconds + run.started.elapsed().as_secs_f64();
    Left::new(begun, run.report.frames_finished, seconds, run.last_image_crc32, state)
        .with_tables(&mut run.track, run.particles.as_mut())
}

/// Where a run in `out` keeps what it leaves.
pub(super) fn file_in(out: &Path) -> ResumeFile {
    ResumeFile::in_folder(out, COMMAND)
}

/// How a run with these options is begun, before anything is read.
fn begun(options: &TrackOptions) -> Result<Begun> {
    Begun::new(COMMAND, options, &["folder"])?.on(&options.folder)
}

/// The same with what `run` reads.
fn read_by(begun: Begun, run: &TrackRun) -> Result<Begun> {
    let skin = text_crc32(&model_file::to_json(run.stream.skin())?);
    let mut begun = begun.with_frames(run.frames.identity()).reading("the skin model", skin);
    let options = &run.report.options;
    for table in [&options.hands, &options.head].into_iter().flatten() {
        begun = begun.reading(format!("`{}`", table.display()), file_crc32(table)?);
    }
    Ok(begun)
}

impl TrackRun {
    /// How this run was begun: with the inputs as they were then.
    fn begun(&mut self) -> Result<Begun> {
        if let Some(begun) = &self.begun {
            return Ok(begun.clone());
        }
        let begun = read_by(begun(&self.report.options)?, self)?;
        Ok(self.begun.insert(begun).clone())
    }

    /// Checks everything as [`TrackRun::prepare`] does, and resumes the run in `out` that did not
    /// reach its end. Its output is bit for bit that of a run without a break, except for
    /// `frames_per_second` in `run.json`.
    ///
    /// # Errors
    /// As [`TrackRun::prepare`]; there is no such run in `out`, or it was begun with other options,
    /// images or another version.
    pub fn resume(options: TrackOptions, out: &Path) -> Result<Self> {
        let left: Left<ArmState> = file_in(out).read(out)?;
        let now = begun(&options)?;
        left.begun.check_options(&now, out)?;
        let mut run = Self::set_up(options, out, &|name, out, _| {
            Ok(csv::Writer::from_writer(left.reopened(name, &out.join(name))?))
        })?;
        left.begun.check_inputs(&read_by(now, &run)?)?;
        run.begun = Some(left.begun.clone());
        run.report.frames_finished = left.finished;
        run.look_again(&left)?;
        let mut samples = List::new(Vec::new(), NO_SAMPLE);
        from_text(StateKind::Arm, &left.state.samples, &mut samples)?;
        run.samples = samples.entries;
        for sample in &run.samples {
            run.report.count(sample.side, sample.status);
        }
        run.report.seen = left.state.seen;
        run.seconds = left.seconds;
        if let Some(pictures) = &mut run.pictures {
            let is_drawn = |frame: &usize| !left.state.skipped.iter().any(|skipped| skipped.frame == *frame);
            let drawn = (0..left.finished).filter(is_drawn);
            pictures.take_up(drawn.map(|frame| (frame, run.frames.name(frame))))?;
        }
        run.report.skipped = left.state.skipped;
        Ok(run)
    }

    /// Goes on from the states of trackers and front end. That one sees the last finished frame
    /// first, so that the next one has the edges that it would have had.
    fn look_again(&mut self, left: &Left<ArmState>) -> Result<()> {
        let mut image = None;
        if let Some(last) = left.finished.checked_sub(1) {
            image = self.frames.load(last, 1)?.pop().and_then(Result::ok);
            self.last_image_crc32 = image.as_ref().map(|image| crc32fast::hash(image.as_raw()));
            left.check_last(&self.frames.name(last), self.last_image_crc32)?;
        }
        let seen = image.map(|image| self.stream.seen(image));
        self.stream.restore(&left.state.trackers, seen, left.state.vision.as_deref())
    }
}

/// What a sample is before it is read.
const NO_SAMPLE: HandSample = HandSample {
    time_s: 0.0,
    side: Side::Left,
    status: Status::Lost,
    hand_px: None,
    hand_m: None,
    likelihood: 0.0,
    hand_std_m: 0.0,
    effective_sample_size: 0.0,
};

impl SavedState for HandSample {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        let sides = [Side::Left, Side::Right];
        let statuses = [Status::Tracking, Status::Uncertain, Status::Predicted, Status::Lost];
        let mut side = usize::from(self.side == Side::Right);
        visitor.index(&mut side, 1);
        self.side = sides[side];
        let mut status = statuses.iter().position(|status| *status == self.status).unwrap_or(3);
        visitor.index(&mut status, 3);
        self.status = statuses[status];
        optional(&mut self.hand_px, Pixel::new(0.0, 0.0), visitor, |pixel, visitor| {
            real(&mut pixel.u_px, visitor);
            real(&mut pixel.v_px, visitor);
        });
        optional(&mut self.hand_m, Vec3::zeros(), visitor, |place, visitor| reals(place.as_mut_slice(), visitor));
        for value in [&mut self.time_s, &mut self.likelihood, &mut self.hand_std_m, &mut self.effective_sample_size] {
            real(value, visitor);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_come_back_bit_for_bit() {
        let all = [
            HandSample {
                time_s: 0.1,
                hand_m: Some(Vec3::new(0.1, -0.2, 1.0 / 3.0)),
                likelihood: 0.7,
                hand_std_m: f32::MIN_POSITIVE,
                effective_sample_size: 49.9,
                ..NO_SAMPLE
            },
            HandSample {
                time_s: 7.0,
                side: Side::Right,
                status: Status::Predicted,
                hand_px: Some(Pixel::new(1.5, -0.0)),
                effective_sample_size: 1.0,
                ..NO_SAMPLE
            },
        ];
        let text = to_text(StateKind::Arm, &mut List::new(all.to_vec(), NO_SAMPLE)).unwrap();
        let mut back = List::new(Vec::new(), NO_SAMPLE);
        from_text(StateKind::Arm, &text, &mut back).unwrap();
        assert_eq!(back.entries, all);
    }
}
