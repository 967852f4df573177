//! The walker: angles in, pose and cadence out.

use crate::layout::ANGLES;
use crate::recording::angles_rad;
use sinew_core::cyclic::model::walking::WALKING_COUPLED;
use sinew_core::cyclic::{AngleMeasurement, CoupledModel, ModelError};
use sinew_core::error::ParameterError;
use sinew_core::slot::Slot;
use sinew_core::tracker::cyclic::{CoupledTracker, CyclicFrame, FirstPhase};

/// Standard deviation of a recorded angle, radians; the build script adds so much noise.
const STD_RAD: f32 = 0.1;

/// A tracker and its model; all zeros before it begins, so that it takes no flash.
#[derive(Debug)]
pub struct Walker {
    model: Slot<CoupledModel<'static>>,
    tracker: Slot<CoupledTracker<ANGLES>>,
    frame: usize,
}

impl Walker {
    /// Before the first frame.
    #[must_use]
    pub const fn empty() -> Self {
        Self { model: Slot::Empty, tracker: Slot::Empty, frame: 0 }
    }

    /// Frames a second of the model.
    ///
    /// # Errors
    /// A model that was changed in flash.
    pub fn rate_hz() -> Result<f32, ModelError> {
        Ok(WALKING_COUPLED.model()?.rate_hz())
    }

    /// Begins with the first recorded frame.
    ///
    /// # Errors
    /// A frame that shows no angle.
    #[inline(never)]
    pub fn begin(&mut self) -> Result<(), ParameterError> {
        let Ok(model) = WALKING_COUPLED.model() else { return Ok(()) };
        let first = measured(0)?;
        self.tracker.get_or_insert(CoupledTracker::empty).begin(&model, &first, FirstPhase::default())?;
        (self.model, self.frame) = (Slot::Full(model), 0);
        Ok(())
    }

    /// The next recorded frame; `None` before [`Self::begin`].
    #[inline(never)]
    pub fn step(&mut self) -> Option<CyclicFrame<ANGLES>> {
        self.frame += 1;
        let (model, tracker) = (self.model.get()?, self.tracker.get_mut()?);
        Some(tracker.step(model, &measured(self.frame).ok()?))
    }
}

fn measured(frame: usize) -> Result<AngleMeasurement<ANGLES>, ParameterError> {
    AngleMeasurement::new(&angles_rad(frame).map(Some), STD_RAD)
}
