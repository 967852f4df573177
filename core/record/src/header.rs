//! One record: header, payload, checksum.

use crate::error::RecordError;
use crate::fields::{FieldReader, FieldWriter};
use crate::kind::{Kind, VERSION};
use crate::payload::Payload;
use sinew_core::checksum::Crc32;

/// Bytes of a header.
pub const HEADER_BYTES: usize = 16;
/// First bytes of every record.
pub(super) const MARK: [u8; 4] = *b"SNWR";
/// Bytes of the header that the checksum covers.
const COVERED_BYTES: usize = 12;

/// A record whose checksum is right.
///
/// ```
/// use sinew_record::{Cost, Failure, Kind, Record, decode, encode};
///
/// let mut bytes = [0; 64];
/// encode(&Failure { frame: 3, code: 6 }, &mut bytes)?;
/// // A player looks at the kind first, then reads what it is for.
/// let (record, _) = decode(&bytes)?;
/// match record {
///     Record { kind: Kind::Failure, .. } => assert_eq!(record.read::<Failure>()?.frame, 3),
///     _ => unreachable!("nothing else was written"),
/// }
/// assert!(record.read::<Cost>().is_err());
/// # Ok::<(), sinew_record::RecordError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Record<'a> {
    /// What it holds.
    pub kind: Kind,
    /// Its payload.
    pub payload: &'a [u8],
}

impl Record<'_> {
    /// The payload's fields.
    ///
    /// # Errors
    /// [`RecordError::OutOfOrder`] for another kind, else those of [`Payload::read`]; all bytes
    /// have to be read.
    pub fn read<P: Payload>(&self) -> Result<P, RecordError> {
        if self.kind != P::KIND {
            return Err(RecordError::OutOfOrder);
        }
        let mut fields = FieldReader::new(self.payload);
        let payload = P::read(&mut fields)?;
        fields.finish()?;
        Ok(payload)
    }
}

/// Writes a record with header and checksum to the start of `bytes`; gives its length.
///
/// ```
/// use sinew_record::{Cost, End, RecordError, encode};
///
/// // Two records one after the other.
/// let mut bytes = [0; 64];
/// let first = encode(&Cost::zero(), &mut bytes)?;
/// let second = encode(&End { records: 1 }, &mut bytes[first..])?;
/// assert_eq!((first, second), (34, 20));
/// assert_eq!(encode(&Cost::zero(), &mut bytes[..10]), Err(RecordError::Capacity { list: "bytes" }));
/// # Ok::<(), RecordError>(())
/// ```
///
/// # Errors
/// [`RecordError::Capacity`] where `bytes` is shorter; [`HEADER_BYTES`] and [`Payload::MAX_BYTES`]
/// always suffice.
pub fn encode<P: Payload>(payload: &P, bytes: &mut [u8]) -> Result<usize, RecordError> {
    const NO_ROOM: RecordError = RecordError::Capacity { list: "bytes" };
    let (header, rest) = bytes.split_first_chunk_mut::<HEADER_BYTES>().ok_or(NO_ROOM)?;
    let mut fields = FieldWriter::new(rest);
    payload.write(&mut fields);
    let length = fields.finish().ok_or(NO_ROOM)?;
    let mut fields = FieldWriter::new(header);
    MARK.iter().for_each(|&byte| fields.u8(byte));
    fields.u16(VERSION);
    fields.u16(P::KIND as u16);
    fields.u32(length as u32);
    let payload = rest.get(..length).unwrap_or_default();
    let checksum = checksum(header, payload);
    if let Some(place) = header.last_chunk_mut::<4>() {
        *place = checksum.to_le_bytes();
    }
    Ok(HEADER_BYTES + length)
}

fn checksum(header: &[u8; HEADER_BYTES], payload: &[u8]) -> u32 {
    let covered = header.get(..COVERED_BYTES).unwrap_or_default();
    covered.iter().chain(payload).fold(Crc32::new(), |sum, &byte| sum.and(byte)).value()
}

/// Length of the record that `bytes` begin with, header included, as the header says.
///
/// # Errors
/// [`RecordError::Truncated`] where the header is not there as a whole, else
/// [`RecordError::NoRecord`] or [`RecordError::WrongVersion`].
pub(super) fn announced_len(bytes: &[u8]) -> Result<usize, RecordError> {
    let header = bytes.first_chunk::<HEADER_BYTES>().ok_or(RecordError::Truncated)?;
    if !header.starts_with(&MARK) {
        return Err(RecordError::NoRecord);
    }
    let mut fields = FieldReader::new(header.get(MARK.len()..).unwrap_or_default());
    let found = fields.u16()?;
    if found != VERSION {
        return Err(RecordError::WrongVersion { found });
    }
    fields.u16()?;
    Ok(HEADER_BYTES.saturating_add(fields.u32()? as usize))
}

/// Reads the record that `bytes` begin with; gives its length, too, header included.
///
/// ```
/// use sinew_record::{End, RecordError, decode, encode};
///
/// let mut bytes = [0; 32];
/// let length = encode(&End { records: 12 }, &mut bytes)?;
/// let (record, used) = decode(&bytes)?;
/// assert_eq!((record.read::<End>()?.records, used), (12, length), "what follows is left alone");
/// bytes[length - 1] ^= 1;
/// assert_eq!(decode(&bytes), Err(RecordError::Checksum));
/// # Ok::<(), RecordError>(())
/// ```
///
/// # Errors
/// What is wrong with it, checked in this order: whole header, mark, version, whole payload,
/// checksum, kind.
pub fn decode(bytes: &[u8]) -> Result<(Record<'_>, usize), RecordError> {
    let length = announced_len(bytes)?;
    let record = bytes.get(..length).ok_or(RecordError::Truncated)?;
    let (header, payload) = record.split_first_chunk::<HEADER_BYTES>().ok_or(RecordError::Truncated)?;
    let stored = header.last_chunk::<4>().map_or(0, |bytes| u32::from_le_bytes(*bytes));
    if stored != checksum(header, payload) {
        return Err(RecordError::Checksum);
    }
    let mut fields = FieldReader::new(header.get(6..).unwrap_or_default());
    let found = fields.u16()?;
    let kind = Kind::of(found).ok_or(RecordError::UnknownKind { found })?;
    Ok((Record { kind, payload }, length))
}
