#![cfg_attr(not(test), no_std)]
//! Fixed records: what is recorded on the host is played to firmware bit for bit, and what firmware
//! answers is compared.
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
//! A stream is records one after the other; the last one is [`End`], which counts them.
//! [`RecordStream`] reads from any [`Source`] with a buffer of fixed size, and goes on at the next
//! sound record after a broken one.
//!
//! ```
//! use sinew_record::{Cost, Kind, RecordStream, decode, encode};
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
mod body;
mod camera;
mod cyclic;
mod end;
mod error;
mod fields;
mod header;
mod kind;
mod payload;
mod results;
#[cfg(feature = "prove-no-panic")]
pub mod rust_entry_points;
mod stream;
#[cfg(test)]
mod tests;

pub use arm::{ArmInput, ArmSetup, CANDIDATES_A_RECORD, CandidateChunk, EDGES_A_RECORD, EdgeChunk};
pub use body::BodyResult;
pub use camera::{CameraFace, CameraLine, CameraSetup, LINE_PIXELS, VisionResult};
pub use cyclic::{CyclicInput, CyclicSetup, model_checksum};
pub use end::End;
pub use error::RecordError;
pub use fields::{FieldReader, FieldWriter};
pub use header::{HEADER_BYTES, Record, decode, encode};
pub use kind::{Kind, VERSION};
pub use payload::Payload;
pub use results::{ArmResult, Cost, CyclicResult, Failure};
pub use stream::{RecordStream, Source};
