//! The image `particles`: angles in, pose, phase and cadence out, by the cyclic paper's particle
//! filter and the walking model.

use crate::log::debug;
use crate::player::{Answers, Application, Refusal, play};
use crate::port::{Part, Port, counted};
use sinew_core::cyclic::MotionModel;
use sinew_core::cyclic::model::walking::WALKING;
use sinew_core::cyclic::particle::propose::{ParticleOptions, Spread};
use sinew_core::skeleton::stick_figure::HUMAN_ANGLES;
use sinew_core::slot::Slot;
use sinew_core::tracker::cyclic::{FirstPhase, ParticleCycleTracker};
use sinew_record::{Cost, CyclicInput, CyclicResult, CyclicSetup, Kind, Record, RecordError, model_checksum};
use static_cell::ConstStaticCell;

/// Particles. Chosen: what a Cortex-M4F of 168 MHz steps in less than the time of a frame.
const PARTICLES: usize = 100;
/// Seed of the particles.
const SEED: u64 = 1;

/// The filter with what it needs between records.
#[derive(Debug)]
pub struct ParticlesApp {
    model: Slot<MotionModel<'static>>,
    /// A setup that came, until its first frame begins the filter.
    first: Slot<FirstPhase>,
    tracker: ParticleCycleTracker<HUMAN_ANGLES, PARTICLES>,
    begun: bool,
    last_frame: Option<u32>,
    step: Cost,
}

impl ParticlesApp {
    /// Before the first record.
    #[must_use]
    pub const fn new() -> Self {
        let tracker = ParticleCycleTracker::empty();
        Self { model: Slot::Empty, first: Slot::Empty, tracker, begun: false, last_frame: None, step: Cost::zero() }
    }

    /// Begins a recording: its first frame begins the filter.
    // Not inlined: what begins a filter and what steps it need their stack one after the other.
    #[inline(never)]
    fn begin(&mut self, setup: &CyclicSetup) -> Result<(), Refusal> {
        let model = WALKING.model()?;
        if setup.model_checksum != model_checksum(&model) {
            return Err(Refusal::OtherModel);
        }
        let spread = if setup.first.position.is_some() { Spread::Standard } else { Spread::UniformPosition };
        self.tracker.configure(ParticleOptions { spread, ..ParticleOptions::default() }, PARTICLES)?;
        (self.model, self.first, self.last_frame) = (Slot::Full(model), Slot::Full(setup.first), None);
        self.begun = false;
        Ok(())
    }

    #[inline(never)]
    fn frame<P: Port>(&mut self, input: &CyclicInput) -> Result<Option<CyclicResult>, Refusal> {
        let model = self.model.get().ok_or(RecordError::OutOfOrder)?;
        if self.last_frame.is_some_and(|last| last >= input.frame) {
            return Err(RecordError::OutOfOrder.into());
        }
        if let Slot::Full(first) = self.first {
            self.tracker.begin(model, &input.angles, first, SEED)?;
            (self.first, self.begun, self.last_frame) = (Slot::Empty, true, Some(input.frame));
            return Ok(None);
        }
        if !self.begun {
            return Err(RecordError::OutOfOrder.into());
        }
        let tracker = &mut self.tracker;
        let answered = counted::<P, _>(&mut self.step, || tracker.step(model, &input.angles));
        self.last_frame = Some(input.frame);
        Ok(Some(CyclicResult::new(input.frame, &answered)))
    }
}

impl Default for ParticlesApp {
    fn default() -> Self {
        Self::new()
    }
}

impl Application for ParticlesApp {
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
        report(&Part::ParticleStep.cost(&self.step));
    }
}

/// All memory that tracking takes lies here, not on the stack.
static APP: ConstStaticCell<ParticlesApp> = ConstStaticCell::new(ParticlesApp::new());

/// Tracks the recording once.
///
/// # Errors
/// Those of [`play`].
pub fn run<P: Port>(port: &mut P) -> Result<(), RecordError> {
    play(port, APP.take())
}
