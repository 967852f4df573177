//! What every kind of record is read from and written to.

use crate::error::RecordError;
use crate::fields::{FieldReader, FieldWriter};
use crate::kind::Kind;

/// Something that a record holds.
///
/// ```
/// use sinew_record::{Cost, HEADER_BYTES, Payload, VisionResult, encode};
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
    /// [`RecordError::WrongLength`] where they do not fit, [`RecordError::Value`] where one has a
    /// value that is none.
    fn read(fields: &mut FieldReader<'_>) -> Result<Self, RecordError>;
}
