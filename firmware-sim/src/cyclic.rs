//! The image `cyclic`: angles in, pose, phase and cadence out, by the phase-coupled filter and the
//! walking model.

use crate::log::debug;
use crate::player::{Answers, Application, Refusal, play};
use crate::port::{Part, Port, counted};
use sinew_core::cyclic::CoupledModel;
use sinew_core::cyclic::model::walking::WALKING_COUPLED;
use sinew_core::skeleton::stick_figure::HUMAN_ANGLES;
use sinew_core::slot::Slot;
use sinew_core::tracker::cyclic::{CoupledTracker, FirstPhase};
use sinew_record::{Cost, CyclicInput, CyclicResult, CyclicSetup, Kind, Record, RecordError, model_checksum};
use static_cell::ConstStaticCell;

/// The tracker with what it needs between records.
#[derive(Debug)]
pub struct CyclicApp {
    model: Slot<CoupledModel<'static>>,
    /// A setup that came, until its first frame begins the tracker.
    first: Slot<FirstPhase>,
    tracker: CoupledTracker<HUMAN_ANGLES>,
    /// Whether the tracker has begun.
    begun: bool,
    last_frame: Option<u32>,
    step: Cost,
    last_step: u32,
}

impl CyclicApp {
    /// Before the first record.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            model: Slot::Empty,
            first: Slot::Empty,
            tracker: CoupledTracker::empty(),
            begun: false,
            last_frame: None,
            step: Cost::zero(),
            last_step: 0,
        }
    }

    /// Begins a recording: its first frame begins the tracker.
    // Not inlined: what begins a tracker and what steps it need their stack one after the other,
    // not at once.
    #[inline(never)]
    fn begin(&mut self, setup: &CyclicSetup) -> Result<(), Refusal> {
        let model = WALKING_COUPLED.model()?;
        if setup.model_checksum != model_checksum(&model) {
            return Err(Refusal::OtherModel);
        }
        (self.model, self.first, self.last_frame) = (Slot::Full(model), Slot::Full(setup.first), None);
        Ok(())
    }

    #[inline(never)]
    fn frame<P: Port>(&mut self, input: &CyclicInput) -> Result<Option<CyclicResult>, Refusal> {
        let model = self.model.get().ok_or(RecordError::OutOfOrder)?;
        if self.last_frame.is_some_and(|last| last >= input.frame) {
            return Err(RecordError::OutOfOrder.into());
        }
        if let Slot::Full(first) = self.first {
            self.tracker.begin(model, &input.angles, first)?;
            self.begun = true;
            (self.first, self.last_frame) = (Slot::Empty, Some(input.frame));
            return Ok(None);
        }
        if !self.begun {
            return Err(RecordError::OutOfOrder.into());
        }
        let before = self.step.total;
        let answered = counted::<P, _>(&mut self.step, || self.tracker.step(model, &input.angles));
        self.last_step = u32::try_from(self.step.total - before).unwrap_or(u32::MAX);
        self.last_frame = Some(input.frame);
        Ok(Some(CyclicResult::new(input.frame, &answered)))
    }

    /// Instructions of the last frame, if it was a step.
    #[must_use]
    pub const fn last_step(&self) -> u32 {
        self.last_step
    }

    /// Instructions of the greatest step so far, and of all steps.
    #[must_use]
    pub const fn step_cost(&self) -> &Cost {
        &self.step
    }
}

impl Default for CyclicApp {
    fn default() -> Self {
        Self::new()
    }
}

impl Application for CyclicApp {
    fn take<P: Port>(&mut self, record: &Record<'_>, answers: &mut Answers<'_, P::Output>) -> Result<(), Refusal> {
        match record.kind {
            Kind::CyclicSetup => self.begin(&record.read()?),
            Kind::CyclicInput => {
                if let Some(result) = self.frame::<P>(&record.read()?)? {
                    debug!("frame {} at {} of the cycle", result.frame, result.estimate.cycle_position);
                    answers.put(&result)?;
                }
                Ok(())
            }
            _ => Err(RecordError::OutOfOrder.into()),
        }
    }

    fn last_frame(&self) -> u32 {
        self.last_frame.unwrap_or(0)
    }

    fn costs(&self, report: &mut dyn FnMut(&Cost)) {
        report(&Part::CyclicStep.cost(&self.step));
    }
}

/// All memory that tracking takes lies here, not on the stack.
static APP: ConstStaticCell<CyclicApp> = ConstStaticCell::new(CyclicApp::new());

/// Tracks the recording once.
///
/// # Errors
/// Those of [`play`].
pub fn run<P: Port>(port: &mut P) -> Result<(), RecordError> {
    play(port, APP.take())
}
