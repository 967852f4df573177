//! The last record of a stream.

use crate::error::RecordError;
use crate::fields::{FieldReader, FieldWriter};
use crate::kind::Kind;
use crate::payload::Payload;

/// Ends a stream.
///
/// ```
/// use sinew_record::{Cost, End, RecordError, RecordStream, encode};
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
