//! A filter whose rows a program hands over one by one, for as long as it likes.

use super::filter::Filter;
use super::options::TrackingOptions;
use super::run::{TrackedFrame, cycles, tracked};
use super::steps::Steps;
use crate::cyclic::angle_table::ANGLES;
use crate::cyclic::{CyclicError, CyclicModel};
use crate::error::{Result, ensure};
use crate::resume::{from_text, to_text};
use sinew_core::cyclic::MotionModel;
use sinew_core::cyclic::events::CycleCounter;
use sinew_core::saved_state::{SavedState, StateKind, StateVisitor};

/// One filter over rows as they come. Its answers are those of [`super::StreamRun`], which reads
/// the same rows from a table.
#[derive(Debug)]
pub struct OnlineRun<'m> {
    model: MotionModel<'m>,
    options: TrackingOptions,
    /// Number of the last row's frame, counted from the first row's 0.
    frame: Option<u64>,
    begun: Option<Begun<'m>>,
}

/// The run from the first row with an angle on.
#[derive(Debug)]
struct Begun<'m> {
    filter: Filter<'m, ANGLES>,
    counter: CycleCounter,
}

impl<'m> OnlineRun<'m> {
    /// A run that waits for its first row with an angle.
    ///
    /// # Errors
    /// An option out of range, a rate so low that a step is too long, smoothing, or a model with
    /// two angles a joint.
    pub fn new(model: &'m CyclicModel, options: TrackingOptions) -> Result<Self> {
        ensure!(!options.smooth, "`--smooth` needs a recording that is kept whole");
        ensure!(model.numbers().angle_count == ANGLES, "the model has two angles a joint, rows have one");
        let model = model.view();
        Steps::new(&model, &options)?;
        Ok(Self { model, options, frame: None, begun: None })
    }

    /// Frames per second of the recording, and frames of the model in one of these.
    #[must_use]
    pub fn rates(&self) -> (f64, f64) {
        let model_hz = f64::from(self.model.rate_hz());
        let rate_hz = self.options.rate_hz.unwrap_or(model_hz);
        (rate_hz, model_hz / rate_hz)
    }

    /// Number of the last row's frame; `None` before the first row.
    #[must_use]
    pub const fn frame(&self) -> Option<u64> {
        self.frame
    }

    /// Answers a row, `frames` frames after the last one; `None` before the first row with an
    /// angle.
    ///
    /// # Errors
    /// No frame between two rows, or an angle that is not finite.
    pub fn step(&mut self, angles_rad: &[Option<f32>; ANGLES], frames: u64) -> Result<Option<TrackedFrame>> {
        if frames == 0 {
            return Err(CyclicError::parameter("frames", "have to be at least 1 from row to row").into());
        }
        let before = self.frame;
        let frame = before.map_or(0, |before| before.saturating_add(frames));
        let steps = Steps::new(&self.model, &self.options)?;
        let measurement = match before {
            None => steps.first(angles_rad)?,
            Some(before) => steps.later(0, before, frame, angles_rad)?,
        };
        self.frame = Some(frame);
        let Some(begun) = &mut self.begun else {
            if angles_rad.iter().all(Option::is_none) {
                return Ok(None);
            }
            let begun = self.begun.insert(Begun::new(self.model, &self.options, angles_rad, steps.step_frames())?);
            return Ok(Some(tracked(frame, &begun.filter.first_estimate(), 0.0)));
        };
        let estimate = begun.filter.step(&measurement);
        let velocity = estimate.cycle_velocity_per_frame;
        begun.counter.advance(estimate.cycle_position, velocity, measurement.step_frames());
        Ok(Some(tracked(frame, &estimate, cycles(&begun.counter))))
    }

    /// Covariance of the angles after the last row, rad^2. `None` before the first row with an
    /// angle, while the phase is unknown, and for particles.
    #[must_use]
    pub fn angle_covariance_rad2(&self) -> Option<[[f32; ANGLES]; ANGLES]> {
        self.begun.as_ref()?.filter.angle_covariance_rad2()
    }

    /// The state after the last row as text, which [`OnlineRun::restore`] takes; `None` before the
    /// first row with an angle.
    ///
    /// # Errors
    /// None that a user can bring about.
    pub fn saved(&mut self) -> Result<Option<String>> {
        self.begun.as_mut().map(|begun| to_text(StateKind::Cyclic, begun)).transpose()
    }

    /// Goes on from what [`OnlineRun::saved`] and [`OnlineRun::frame`] of a run with the same model
    /// and options said.
    ///
    /// # Errors
    /// The text is not whole, or of another run.
    pub fn restore(&mut self, frame: Option<u64>, saved: Option<&str>) -> Result<()> {
        self.begun = match saved {
            None => None,
            Some(text) => {
                let step_frames = self.rates().1;
                let mut begun = Begun::new(self.model, &self.options, &[Some(0.0); ANGLES], step_frames)?;
                from_text(StateKind::Cyclic, text, &mut begun)?;
                Some(begun)
            }
        };
        self.frame = frame;
        Ok(())
    }
}

impl<'m> Begun<'m> {
    fn new(
        model: MotionModel<'m>,
        options: &TrackingOptions,
        first_rad: &[Option<f32>; ANGLES],
        step_frames: f64,
    ) -> Result<Self> {
        let filter = Filter::new(model, options, first_rad, step_frames)?;
        let counter = CycleCounter::new(filter.first_estimate().cycle_position);
        Ok(Self { filter, counter })
    }
}

impl SavedState for Begun<'_> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        self.filter.visit(visitor);
        self.counter.visit(visitor);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::SyntheticPerson;
    use crate::cyclic::model_file::shipped;
    use crate::cyclic::tracking::track;

    #[test]
    fn answers_are_those_of_a_table_also_after_a_saved_state() {
        let model = shipped("walking").unwrap();
        let table = SyntheticPerson::draw(model, 30.0, 1).unwrap().measured(3, 0.05, 0.2, 1).unwrap();
        let options = TrackingOptions { rate_hz: Some(30.0), ..TrackingOptions::default() };
        let whole = track(&table, model, &options).unwrap();
        let mut run = OnlineRun::new(model, options.clone()).unwrap();
        for (index, (row, answer)) in table.rows().iter().zip(&whole.frames).enumerate() {
            let found = run.step(&row.angles_rad.map(|angle| angle.map(|angle| angle as f32)), 1).unwrap();
            assert_eq!(found.as_ref(), Some(answer), "row {index}");
            if index % 7 == 0 {
                let (frame, saved) = (run.frame(), run.saved().unwrap());
                run = OnlineRun::new(model, options.clone()).unwrap();
                run.restore(frame, saved.as_deref()).unwrap();
            }
        }
        assert!(run.step(&[None; ANGLES], 0).unwrap_err().to_string().contains("`frames`"));
    }
}
