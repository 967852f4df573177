//! Plays a recording to an application: record after record in, answers out.

use crate::log::info;
use crate::port::{MAX_RECORD_BYTES, Port, Sink, put};
use sinew_core::cyclic::ModelError;
use sinew_core::error::ParameterError;
use sinew_record::{Cost, End, Failure, Payload, Record, RecordError, RecordStream};

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

impl From<ModelError> for Refusal {
    fn from(error: ModelError) -> Self {
        Self::Parameter(error.error)
    }
}

/// Where answers go; counts them.
#[derive(Debug)]
pub struct Answers<'a, S> {
    sink: &'a mut S,
    records: u32,
}

impl<S: Sink> Answers<'_, S> {
    /// One more answer.
    ///
    /// # Errors
    /// None for the payloads of this crate.
    pub fn put(&mut self, payload: &impl Payload) -> Result<(), RecordError> {
        self.records = self.records.saturating_add(1);
        put(self.sink, payload)
    }
}

/// What is done with records. A refused record leaves the state as it was.
pub trait Application {
    /// Takes in one record and answers it, if there is anything to say.
    ///
    /// # Errors
    /// Why it cannot be used.
    fn take<P: Port>(&mut self, record: &Record<'_>, answers: &mut Answers<'_, P::Output>) -> Result<(), Refusal>;

    /// Number of the last frame that was answered, 0 before the first.
    fn last_frame(&self) -> u32;

    /// Hands out what its parts cost.
    fn costs(&self, report: &mut dyn FnMut(&Cost));
}

/// Plays the whole input of `port` to `application`.
///
/// # Errors
/// None in practice: all answers have room.
pub fn play<P: Port>(port: &mut P, application: &mut impl Application) -> Result<(), RecordError> {
    let (input, results, costs) = port.split();
    let mut stream = RecordStream::<_, MAX_RECORD_BYTES>::new(input);
    let mut answers = Answers { sink: results, records: 0 };
    while let Some(record) = stream.next_record() {
        let taken = record.map_err(Refusal::from).and_then(|record| application.take::<P>(&record, &mut answers));
        if let Err(refusal) = taken {
            let (frame, code) = (application.last_frame(), refusal.code());
            info!("after frame {}: failure {}", frame, code);
            answers.put(&Failure { frame, code })?;
        }
    }
    let records = answers.records;
    info!("{} answers", records);
    answers.put(&End { records })?;
    let mut written = Ok(());
    application.costs(&mut |cost| written = written.and_then(|()| put(costs, cost)));
    written
}
