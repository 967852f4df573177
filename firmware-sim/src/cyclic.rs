//! The image `cyclic`: angles in, pose, phase and cadence out, by the phase-coupled filter and the walking model.

use crate::log::{debug, info};
use crate::port::{MAX_RECORD_BYTES, Part, Port, Sink, counted, put};
use sinew_core::cyclic::MotionModel;
use sinew_core::cyclic::models::walking::WALKING;
use sinew_core::error::ParameterError;
use sinew_core::record::{
    Cost, CyclicInput, CyclicResult, CyclicSetup, End, Failure, Kind, Record, RecordError, RecordStream, model_checksum,
};
use sinew_core::skeleton::stick_figure::HUMAN_ANGLES;
use sinew_core::tracker::coupled::CoupledTracker;
use static_cell::ConstStaticCell;

/// Why a record was not answered.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Refusal {
    /// The record cannot be used.
    Record(RecordError),
    /// The tracker refuses a parameter.
    Parameter(ParameterError),
    /// The recording was made for another model.
    OtherModel,
}

impl Refusal {
    /// [`Failure::code`].
    #[must_use]
    pub const fn code(&self) -> u16 {
        match self {
            Self::Record(error) => error.code(),
            Self::Parameter(_) => Failure::REFUSED,
            Self::OtherModel => Failure::OTHER_MODEL,
        }
    }
}

impl From<RecordError> for Refusal {
    fn from(error: RecordError) -> Self {
        Self::Record(error)
    }
}

impl From<ParameterError> for Refusal {
    fn from(error: ParameterError) -> Self {
        Self::Parameter(error)
    }
}

/// The tracker with what it needs between records.
#[derive(Debug)]
pub struct CyclicApp {
    /// Setup that came, until its first frame begins the tracker.
    setup: Option<CyclicSetup>,
    tracker: Option<CoupledTracker<HUMAN_ANGLES>>,
    last_frame: Option<u32>,
    step: Cost,
}

impl CyclicApp {
    /// Before the first record.
    #[must_use]
    pub const fn new() -> Self {
        Self { setup: None, tracker: None, last_frame: None, step: Part::CyclicStep.cost() }
    }

    /// Takes in one record. `None` for a setup and for the first frame, from which the tracker begins.
    ///
    /// # Errors
    /// A frame before its setup or not after the last one, a record that is broken or of another kind: the tracker is as before.
    pub fn take<P: Port>(
        &mut self,
        model: &MotionModel<'_>,
        record: &Record<'_>,
    ) -> Result<Option<CyclicResult>, Refusal> {
        match record.kind {
            Kind::CyclicSetup => {
                let setup = record.read::<CyclicSetup>()?;
                if setup.model_checksum != model_checksum(model) {
                    return Err(Refusal::OtherModel);
                }
                (self.setup, self.last_frame) = (Some(setup), None);
                Ok(None)
            }
            Kind::CyclicInput => self.frame::<P>(model, &record.read()?),
            _ => Err(RecordError::OutOfOrder.into()),
        }
    }

    fn frame<P: Port>(
        &mut self,
        model: &MotionModel<'_>,
        input: &CyclicInput,
    ) -> Result<Option<CyclicResult>, Refusal> {
        if self.last_frame.is_some_and(|last| last >= input.frame) {
            return Err(RecordError::OutOfOrder.into());
        }
        if let Some(setup) = self.setup {
            self.tracker = Some(CoupledTracker::new(model, &input.angles, setup.first)?);
            self.setup = None;
            self.last_frame = Some(input.frame);
            return Ok(None);
        }
        let tracker = self.tracker.as_mut().ok_or(RecordError::OutOfOrder)?;
        let answered = counted::<P, _>(&mut self.step, || tracker.step(model, &input.angles));
        self.last_frame = Some(input.frame);
        Ok(Some(CyclicResult::new(input.frame, &answered)))
    }

    /// Number of the last frame.
    #[must_use]
    pub fn last_frame(&self) -> u32 {
        self.last_frame.unwrap_or(0)
    }

    /// What the steps cost.
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

/// All memory that tracking takes lies here, not on the stack.
static APP: ConstStaticCell<CyclicApp> = ConstStaticCell::new(CyclicApp::new());

/// Tracks the recording once.
///
/// # Errors
/// A model that cannot be used, or a record that is too long to be written.
pub fn run<P: Port>(port: &mut P) -> Result<(), RecordError> {
    play(port, APP.take())
}

/// Tracks the recording with the state `app`.
///
/// # Errors
/// Those of [`run`].
pub fn play<P: Port>(port: &mut P, app: &mut CyclicApp) -> Result<(), RecordError> {
    let model = WALKING.model().map_err(|error| RecordError::Value { field: error.error.parameter })?;
    let (input, results, costs) = port.split();
    let mut stream = RecordStream::<_, MAX_RECORD_BYTES>::new(input);
    let mut records = 0;
    while let Some(record) = stream.next_record() {
        match record.map_err(Refusal::from).and_then(|record| app.take::<P>(&model, &record)) {
            Ok(None) => continue,
            Ok(Some(result)) => {
                debug!("frame {} at {} of the cycle", result.frame, result.estimate.cycle_position);
                put(results, &result)?;
            }
            Err(refusal) => {
                info!("after frame {}: failure {}", app.last_frame(), refusal.code());
                put(results, &Failure { frame: app.last_frame(), code: refusal.code() })?;
            }
        }
        records += 1;
    }
    put(results, &End { records })?;
    info!("{} answers, the worst step took {} instructions", records, app.step.worst);
    costs_of(costs, &[app.step])
}

/// Writes costs and their end.
fn costs_of(sink: &mut impl Sink, costs: &[Cost]) -> Result<(), RecordError> {
    costs.iter().try_for_each(|cost| put(sink, cost))
}
