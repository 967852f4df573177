//! What may be wrong with a record.

use core::fmt;

/// Why a record cannot be used. [`Self::code`] is the number that firmware reports.
///
/// ```
/// use sinew_record::{Cost, End, RecordError, decode, encode};
///
/// let mut bytes = [0; 64];
/// let length = encode(&Cost::zero(), &mut bytes)?;
/// assert_eq!(decode(&bytes[..length - 1]), Err(RecordError::Truncated));
/// assert_eq!(decode(&bytes)?.0.read::<End>(), Err(RecordError::OutOfOrder), "another kind was wanted");
/// // What firmware reports in place of words.
/// assert_eq!(RecordError::Checksum.code(), 6);
/// # Ok::<(), RecordError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RecordError {
    /// The bytes end within a record, or before [`crate::End`].
    Truncated,
    /// The bytes do not begin with the mark of a record.
    NoRecord,
    /// The format has another version.
    WrongVersion {
        /// Version that was found.
        found: u16,
    },
    /// No such kind.
    UnknownKind {
        /// Kind that was found.
        found: u16,
    },
    /// The payload is longer than any that the reader has room for.
    TooLong,
    /// Bytes were changed.
    Checksum,
    /// The payload is longer or shorter than its kind's.
    WrongLength,
    /// A field has a value that it cannot have.
    Value {
        /// Name of the field.
        field: &'static str,
    },
    /// There are more elements than the reader has room for.
    Capacity {
        /// Name of the list.
        list: &'static str,
    },
    /// A record came where another kind is needed, such as a frame before its setup.
    OutOfOrder,
    /// Fewer or more records came than were announced.
    Lost,
}

impl RecordError {
    /// Number of the error, 1 to 63; it never changes its meaning.
    #[must_use]
    pub const fn code(self) -> u16 {
        match self {
            Self::Truncated => 1,
            Self::NoRecord => 2,
            Self::WrongVersion { .. } => 3,
            Self::UnknownKind { .. } => 4,
            Self::TooLong => 5,
            Self::Checksum => 6,
            Self::WrongLength => 7,
            Self::Value { .. } => 8,
            Self::Capacity { .. } => 9,
            Self::OutOfOrder => 10,
            Self::Lost => 11,
        }
    }
}

impl fmt::Display for RecordError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Truncated => formatter.write_str("the records end too early"),
            Self::NoRecord => formatter.write_str("there are bytes that are no record"),
            Self::WrongVersion { found } => {
                write!(formatter, "the record has version {found}, but this program reads version {}", crate::VERSION)
            }
            Self::UnknownKind { found } => write!(formatter, "there is no kind {found} of records"),
            Self::TooLong => formatter.write_str("the record is longer than any of its kind"),
            Self::Checksum => formatter.write_str("the record was changed: its checksum is another one"),
            Self::WrongLength => formatter.write_str("the record has another length than its kind"),
            Self::Value { field } => write!(formatter, "`{field}` has a value that it cannot have"),
            Self::Capacity { list } => write!(formatter, "there is no room for so many `{list}`"),
            Self::OutOfOrder => formatter.write_str("the record cannot come at this place"),
            Self::Lost => formatter.write_str("records were lost before this one"),
        }
    }
}

impl core::error::Error for RecordError {}
