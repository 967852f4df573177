//! What an image needs of the machine under it: input, output, and what a piece of work cost.

use sinew_record::{Cost, HEADER_BYTES, Payload, RecordError, Source, encode};

/// Power of two of the nanoseconds that the emulator lets pass for an instruction; its timer then
/// counts instructions.
pub const ICOUNT_SHIFT: u32 = 6;
/// Name of the file that an image reads its input from.
pub const INPUT_FILE: &str = "input.rec";
/// Name of the file that it answers to.
pub const RESULTS_FILE: &str = "results.rec";
/// Name of the file for its costs.
pub const COSTS_FILE: &str = "costs.rec";

/// Longest record that an image reads or writes, bytes, header included.
pub const MAX_RECORD_BYTES: usize = 1024;

/// Where records leave.
pub trait Sink {
    /// Writes all of `bytes`.
    fn write(&mut self, bytes: &[u8]);
}

/// The machine under an image.
pub trait Port {
    /// Where input comes from.
    type Input: Source;
    /// Where answers and costs leave.
    type Output: Sink;

    /// Input, answers, costs: each is there once.
    fn split(&mut self) -> (&mut Self::Input, &mut Self::Output, &mut Self::Output);

    /// Instructions so far; only differences mean something, and it wraps.
    fn instructions() -> u32;
}

/// Parts of an image's work whose costs are reported; the number is [`Cost::part`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u16)]
pub enum Part {
    /// A step of the cyclic tracker, instructions.
    CyclicStep = 1,
    /// A step of the arm tracker, instructions.
    ArmStep = 2,
    /// All lines of a frame through the front end, instructions.
    FrontEnd = 3,
    /// All of a frame's work, instructions.
    Frame = 4,
    /// A step of the cyclic particle filter, instructions.
    ParticleStep = 5,
    /// A step of the body tracker with the sorting of its points, instructions.
    BodyStep = 6,
    /// Most stack in use, bytes.
    Stack = 16,
}

impl Part {
    /// All parts.
    pub const ALL: [Self; 7] =
        [Self::CyclicStep, Self::ArmStep, Self::FrontEnd, Self::Frame, Self::ParticleStep, Self::BodyStep, Self::Stack];

    /// Its name in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::CyclicStep => "cyclic step",
            Self::ArmStep => "arm step",
            Self::FrontEnd => "front end",
            Self::Frame => "frame",
            Self::ParticleStep => "particle step",
            Self::BodyStep => "body step",
            Self::Stack => "stack",
        }
    }

    /// What was counted as the cost of this part.
    #[must_use]
    pub const fn cost(self, counted: &Cost) -> Cost {
        Cost { part: self as u16, ..*counted }
    }
}

/// Does `work` and counts its instructions as one more frame's.
pub fn counted<P: Port, T>(cost: &mut Cost, work: impl FnOnce() -> T) -> T {
    let before = P::instructions();
    let answer = work();
    cost.add(P::instructions().wrapping_sub(before));
    answer
}

/// Writes one record.
///
/// # Errors
/// [`RecordError::Capacity`] for a record beyond [`MAX_RECORD_BYTES`].
pub fn put<P: Payload>(sink: &mut impl Sink, payload: &P) -> Result<(), RecordError> {
    const {
        assert!(HEADER_BYTES + P::MAX_BYTES <= MAX_RECORD_BYTES, "the record has to fit the images' buffer");
    }
    let mut bytes = [0; 256];
    let length = encode(payload, &mut bytes)?;
    sink.write(bytes.get(..length).unwrap_or_default());
    Ok(())
}
