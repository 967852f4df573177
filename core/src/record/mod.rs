//! Fixed records: what is recorded on the host is played to firmware bit for bit, and what firmware answers is compared.
//!
//! A record is a header of 16 bytes and a payload. All numbers are little-endian.
//!
//! | bytes | what |
//! |---|---|
//! | 0 to 3 | `SNWR` |
//! | 4, 5 | [`VERSION`] of the format |
//! | 6, 7 | [`Kind`] |
//! | 8 to 11 | length of the payload, bytes |
//! | 12 to 15 | CRC-32 (ISO-HDLC) of the first twelve bytes and the payload |
//!
//! A stream is records one after the other; the last one is [`End`], which counts them. [`RecordStream`] reads from any [`Source`] with
//! a buffer of fixed size, and goes on at the next sound record after a broken one.
//!
//! ```
//! use sinew_core::record::{Cost, Kind, RecordStream, decode, encode};
//!
//! let cost = Cost { part: 1, frames: 120, total: 4_000_000, worst: 70_000 };
//! let mut bytes = [0; 64];
//! let length = encode(&cost, &mut bytes).expect("64 bytes suffice");
//!
//! let (record, used) = decode(&bytes[..length]).expect("it was written a line ago");
//! assert_eq!((record.kind, used), (Kind::Cost, length));
//! assert_eq!(record.read::<Cost>(), Ok(cost));
//!
//! // One wrong bit is found by the checksum.
//! bytes[length - 1] ^= 1;
//! assert!(decode(&bytes[..length]).is_err());
//! let mut stream = RecordStream::<_, 256>::new(&bytes[..length]);
//! assert!(matches!(stream.next_record(), Some(Err(_))));
//! ```

mod arm;
mod camera;
mod cyclic;
mod error;
mod fields;
mod header;
mod results;
mod stream;
#[cfg(test)]
mod tests;

pub use arm::{ArmInput, ArmSetup, CANDIDATES_A_RECORD, CandidateChunk, EDGES_A_RECORD, EdgeChunk};
pub use camera::{CameraLine, CameraSetup, LINE_PIXELS, VisionResult};
pub use cyclic::{CyclicInput, CyclicSetup, model_checksum};
pub use error::RecordError;
pub use fields::{FieldReader, FieldWriter};
pub use header::{HEADER_BYTES, Kind, Record, VERSION, decode, encode};
pub use results::{ArmResult, Cost, CyclicResult, Failure};
pub use stream::{RecordStream, Source};

/// Something that a record holds.
///
/// ```
/// use sinew_core::record::{Cost, HEADER_BYTES, Payload, VisionResult, encode};
///
/// // Room for a record of any kind, known when the program is built.
/// const fn room<P: Payload>() -> usize {
///     HEADER_BYTES + P::MAX_BYTES
/// }
/// let mut bytes = [0; room::<VisionResult>()];
/// assert_eq!(encode(&Cost::zero(), &mut bytes), Ok(room::<Cost>()));
/// ```
pub trait Payload: Sized {
    /// Kind of its records.
    const KIND: Kind;
    /// Most bytes that it takes, without the header.
    const MAX_BYTES: usize;

    /// Writes all fields.
    fn write(&self, fields: &mut FieldWriter<'_>);

    /// Reads all fields.
    ///
    /// # Errors
    /// [`RecordError::WrongLength`] where they do not fit, [`RecordError::Value`] where one has a value that is none.
    fn read(fields: &mut FieldReader<'_>) -> Result<Self, RecordError>;
}

/// Ends a stream.
///
/// ```
/// use sinew_core::record::{Cost, End, RecordError, RecordStream, encode};
///
/// // Two records were written, but only one came through.
/// let mut bytes = [0; 64];
/// let length = encode(&Cost::zero(), &mut bytes)?;
/// encode(&End { records: 2 }, &mut bytes[length..])?;
/// let mut stream = RecordStream::<_, 64>::new(bytes.as_slice());
/// assert!(stream.next_record().is_some_and(|record| record.is_ok()));
/// assert_eq!(stream.next_record(), Some(Err(RecordError::Lost)));
/// # Ok::<(), RecordError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct End {
    /// Number of records before this one.
    pub records: u32,
}

impl Payload for End {
    const KIND: Kind = Kind::End;
    const MAX_BYTES: usize = 4;

    fn write(&self, fields: &mut FieldWriter<'_>) {
        fields.u32(self.records);
    }

    fn read(fields: &mut FieldReader<'_>) -> Result<Self, RecordError> {
        Ok(Self { records: fields.u32()? })
    }
}
