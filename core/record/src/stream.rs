//! Records one after the other, from any source of bytes.
//!
//! ```
//! use sinew_record::{Cost, End, Failure, Kind, RecordStream, encode};
//!
//! // Two records and the end, which counts them.
//! let mut bytes = [0; 256];
//! let mut length = encode(&Failure { frame: 3, code: 1 }, &mut bytes).expect("there is room");
//! length += encode(&Cost::zero(), &mut bytes[length..]).expect("there is room");
//! length += encode(&End { records: 2 }, &mut bytes[length..]).expect("there is room");
//!
//! let mut stream = RecordStream::<_, 64>::new(&bytes[..length]);
//! let first = stream.next_record().expect("there is one").expect("it is whole");
//! assert_eq!(first.read::<Failure>(), Ok(Failure { frame: 3, code: 1 }));
//! assert_eq!(stream.next_record().expect("another").expect("it is whole").kind, Kind::Cost);
//! assert!(stream.next_record().is_none(), "the count is right");
//! ```

use crate::end::End;
use crate::error::RecordError;
use crate::header::{MARK, announced_len};
use crate::header::{Record, decode};
use crate::kind::Kind;

/// Where bytes come from.
///
/// ```
/// use sinew_record::{Cost, RecordStream, Source, encode};
///
/// /// A serial port that has a few bytes at a time.
/// struct Port<'a>(&'a [u8]);
///
/// impl Source for Port<'_> {
///     fn read(&mut self, bytes: &mut [u8]) -> usize {
///         let few = bytes.len().min(3);
///         self.0.read(&mut bytes[..few])
///     }
/// }
///
/// let mut bytes = [0; 64];
/// let length = encode(&Cost { worst: 70_000, ..Cost::zero() }, &mut bytes)?;
/// let mut stream = RecordStream::<_, 64>::new(Port(&bytes[..length]));
/// let record = stream.next_record().expect("there is one")?;
/// assert_eq!(record.read::<Cost>()?.worst, 70_000);
/// # Ok::<(), sinew_record::RecordError>(())
/// ```
pub trait Source {
    /// Fills the start of `bytes` and returns how many bytes it filled; none at the end.
    fn read(&mut self, bytes: &mut [u8]) -> usize;
}

impl Source for &[u8] {
    fn read(&mut self, bytes: &mut [u8]) -> usize {
        let count = self.len().min(bytes.len());
        let (now, later) = self.split_at_checked(count).unwrap_or_default();
        for (place, byte) in bytes.iter_mut().zip(now) {
            *place = *byte;
        }
        *self = later;
        count
    }
}

impl<S: Source + ?Sized> Source for &mut S {
    fn read(&mut self, bytes: &mut [u8]) -> usize {
        (**self).read(bytes)
    }
}

/// Reads records from a source with a buffer of `BYTES`, the longest record that it can read.
///
/// Every broken record gives one error or more, then reading goes on at the next sound one.
///
/// ```
/// use sinew_record::{Cost, Failure, RecordError, RecordStream, encode};
///
/// // The first record is broken, the second is sound.
/// let mut bytes = [0; 64];
/// let length = encode(&Failure { frame: 3, code: 1 }, &mut bytes)?;
/// bytes[length - 1] ^= 1;
/// let end = length + encode(&Cost::zero(), &mut bytes[length..])?;
///
/// let mut stream = RecordStream::<_, 64>::new(&bytes[..end]);
/// assert_eq!(stream.next_record(), Some(Err(RecordError::Checksum)));
/// let sound = stream.next_record().expect("it goes on behind the broken one")?;
/// assert_eq!(sound.read::<Cost>()?, Cost::zero());
/// # Ok::<(), RecordError>(())
/// ```
#[derive(Debug)]
pub struct RecordStream<S, const BYTES: usize> {
    source: S,
    buffer: [u8; BYTES],
    start: usize,
    end: usize,
    /// The source has no more bytes.
    dry: bool,
    /// Looking for the next mark after a broken record.
    lost: bool,
    /// Sound records so far.
    records: u32,
    /// Whether the last sound record was [`End`].
    ended: bool,
    /// A missing [`End`] was reported.
    reported_end: bool,
}

/// What lies at the start of the buffer.
enum Ahead {
    Record(usize),
    Broken(RecordError),
    Nothing,
}

impl<S: Source, const BYTES: usize> RecordStream<S, BYTES> {
    /// Reads from the start of `source` on.
    pub const fn new(source: S) -> Self {
        Self {
            source,
            buffer: [0; BYTES],
            start: 0,
            end: 0,
            dry: false,
            lost: false,
            records: 0,
            ended: false,
            reported_end: false,
        }
    }

    /// The next record, or what is wrong with it; `None` after the last one.
    ///
    /// [`End`] is checked here and not handed out: [`RecordError::Lost`] where it counts other
    /// records than came, [`RecordError::Truncated`] where it is missing.
    pub fn next_record(&mut self) -> Option<Result<Record<'_>, RecordError>> {
        let length = match self.ahead() {
            Ahead::Record(length) => length,
            Ahead::Broken(error) => {
                self.lost = true;
                // The mark is passed, so that the search goes on behind it.
                self.start = (self.start + 1).min(self.end);
                return Some(Err(error));
            }
            Ahead::Nothing => {
                let is_missing = !(self.ended || self.reported_end);
                self.reported_end = true;
                return is_missing.then_some(Err(RecordError::Truncated));
            }
        };
        let start = self.start;
        self.start = (start + length).min(self.end);
        let before = self.records;
        self.records = before.saturating_add(1);
        let record = decode(self.buffer.get(start..).unwrap_or_default()).map(|(record, _)| record);
        self.ended = matches!(record, Ok(Record { kind: Kind::End, .. }));
        if self.ended {
            let end = record.and_then(|record| record.read::<End>());
            return match end {
                Ok(End { records }) if records == before => None,
                Ok(_) => Some(Err(RecordError::Lost)),
                Err(error) => Some(Err(error)),
            };
        }
        Some(record)
    }

    /// Finds the next whole record.
    fn ahead(&mut self) -> Ahead {
        loop {
            if self.lost {
                self.skip_to_mark();
            }
            if self.start == self.end && !self.refill() {
                return Ahead::Nothing;
            }
            let bytes = self.buffer.get(self.start..self.end).unwrap_or_default();
            match announced_len(bytes) {
                Err(RecordError::Truncated) if !self.dry => {}
                Err(RecordError::Truncated) if self.lost => {
                    // What is left after a broken record is too short for another one.
                    self.start = self.end;
                    return Ahead::Nothing;
                }
                Err(RecordError::NoRecord) if self.lost => {
                    self.start += 1;
                    continue;
                }
                Err(error) => return Ahead::Broken(error),
                Ok(length) if length > BYTES => return Ahead::Broken(RecordError::TooLong),
                Ok(length) if length > bytes.len() => {
                    if self.dry {
                        return Ahead::Broken(RecordError::Truncated);
                    }
                }
                Ok(length) => {
                    return match decode(bytes) {
                        Err(error @ RecordError::UnknownKind { .. }) => {
                            // Sound, but of a later program: it counts, and only it is left out.
                            self.records = self.records.saturating_add(1);
                            self.start += length - 1;
                            self.lost = false;
                            Ahead::Broken(error)
                        }
                        Err(error) => Ahead::Broken(error),
                        Ok(_) => {
                            self.lost = false;
                            Ahead::Record(length)
                        }
                    };
                }
            }
            self.refill();
        }
    }

    /// Drops bytes before the next one that may begin a record.
    fn skip_to_mark(&mut self) {
        while let Some(byte) = self.buffer.get(self.start..self.end).and_then(<[u8]>::first) {
            if *byte == MARK[0] {
                return;
            }
            self.start += 1;
        }
    }

    /// Moves what is left to the front and fills the rest; whether there is anything then.
    fn refill(&mut self) -> bool {
        let left = self.end.saturating_sub(self.start);
        for index in 0..left {
            let byte = self.buffer.get(self.start + index).copied().unwrap_or_default();
            if let Some(place) = self.buffer.get_mut(index) {
                *place = byte;
            }
        }
        self.start = 0;
        self.end = left;
        if let Some(free) = self.buffer.get_mut(left..) {
            let count = self.source.read(free).min(free.len());
            self.dry |= count == 0;
            self.end += count;
        }
        self.end > 0
    }
}
