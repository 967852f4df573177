//! A motion model as bytes: made on a host, put into flash, read where it lies.
//!
//! Little-endian words of four bytes, so that a processor reads the numbers in place if the first
//! byte lies at a multiple of four:
//!
//! | words | what |
//! |---|---|
//! | 0 | [`MAGIC`] |
//! | 1 | version, [`VERSION`] |
//! | 2, 3 | number n of angles, number l of positions |
//! | 4, 5 | mean duration, frames; frames per second |
//! | 6 | CRC-32 of words 1 to 5 and all after word 6 |
//! | then | mean acceleration (l n), covariance (l n (n + 1) / 2), mean pose (l n), mean velocity (l n) |
//! | then | spread of offset, swing and rest, rate of the rest (n each) |
//! | last | turns per cycle, a signed byte each, filled with zeros to a whole word |

use crate::checksum::Crc32;
use crate::cyclic::model::deviation::Deviation;
use crate::cyclic::model::motion_model::{MAX_ANGLES, ModelError, ModelParts, MotionModel};
use crate::cyclic::model::table::ModelTable;
use crate::numeric::semi_definite::packed_len;
use core::fmt;

/// First word of a model: `SNWM`.
pub const MAGIC: u32 = u32::from_le_bytes(*b"SNWM");
/// Version of the layout.
pub const VERSION: u32 = 1;
/// Bytes before the numbers.
pub const HEADER_BYTES: usize = 28;
/// Most positions of a model in this form.
pub const MAX_POSITIONS: usize = 1000;

/// Why bytes are no motion model.
///
/// ```
/// use sinew_core::cyclic::HumanModelTable;
/// use sinew_core::cyclic::model::bytes::{MAGIC, ModelBytesError};
///
/// // A picture, and a model of which only the first word came.
/// assert_eq!(HumanModelTable::from_bytes(b"GIF89a"), Err(ModelBytesError::NoModel));
/// assert_eq!(HumanModelTable::from_bytes(&MAGIC.to_le_bytes()), Err(ModelBytesError::Version));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ModelBytesError {
    /// The first word is another one.
    NoModel,
    /// A version that this program does not know.
    Version,
    /// Numbers of angles or positions out of range.
    Shape,
    /// Fewer or more bytes than the shape asks for.
    Length,
    /// The checksum is another one: the bytes changed.
    Checksum,
}

impl fmt::Display for ModelBytesError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::NoModel => "the bytes do not begin as a motion model; make them again with this version",
            Self::Version => "the motion model's version is unknown; make it again with this version",
            Self::Shape => "the motion model has too many or too few angles or positions",
            Self::Length => "the motion model has another length than its header says",
            Self::Checksum => "the motion model's checksum is wrong; its bytes were changed",
        })
    }
}

impl core::error::Error for ModelBytesError {}

/// Header of a model.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::model::bytes::{ModelBytesError, ModelHeader, write};
/// # use sinew_core::cyclic::model::walking::WALKING;
///
/// # let mut memory = [0; 64 * 1024];
/// # let length = write(&WALKING.model().expect("the shipped model is sound"), &mut memory).expect("it fits");
/// # let flash = &mut memory[..length];
/// // Which model is in flash, before a filter is made for it.
/// let header = ModelHeader::read(flash)?;
/// assert_eq!((header.angle_count, header.position_count), (13, 100));
/// assert_eq!(header.byte_count(), flash.len());
/// flash[1000] ^= 1;
/// assert_eq!(ModelHeader::read(flash), Err(ModelBytesError::Checksum));
/// # }
/// # Ok::<(), sinew_core::cyclic::model::bytes::ModelBytesError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModelHeader {
    /// Number n of angles.
    pub angle_count: usize,
    /// Number l of positions.
    pub position_count: usize,
    /// See [`ModelParts::mean_duration_frames`].
    pub mean_duration_frames: f32,
    /// See [`ModelParts::rate_hz`].
    pub rate_hz: f32,
}

/// Word `index` of `bytes`, 0 beyond the end.
const fn word(bytes: &[u8], index: usize) -> u32 {
    match bytes.split_at_checked(4 * index) {
        Some((_, rest)) => match rest.first_chunk::<4>() {
            Some(chunk) => u32::from_le_bytes(*chunk),
            None => 0,
        },
        None => 0,
    }
}

const fn checksum(bytes: &[u8]) -> u32 {
    let mut sum = Crc32::new();
    let mut index = 4;
    let mut rest = match bytes.split_at_checked(4) {
        Some((_, rest)) => rest,
        None => &[],
    };
    while let Some((&byte, tail)) = rest.split_first() {
        // The checksum does not count itself.
        if index < 24 || index >= HEADER_BYTES {
            sum = sum.and(byte);
        }
        index += 1;
        rest = tail;
    }
    sum.value()
}

impl ModelHeader {
    /// Reads the header and checks length and checksum.
    ///
    /// # Errors
    /// See [`ModelBytesError`].
    pub const fn read(bytes: &[u8]) -> Result<Self, ModelBytesError> {
        if word(bytes, 0) != MAGIC {
            return Err(ModelBytesError::NoModel);
        }
        if word(bytes, 1) != VERSION {
            return Err(ModelBytesError::Version);
        }
        let (angle_count, position_count) = (word(bytes, 2) as usize, word(bytes, 3) as usize);
        if angle_count == 0 || angle_count > MAX_ANGLES || position_count < 4 || position_count > MAX_POSITIONS {
            return Err(ModelBytesError::Shape);
        }
        let header = Self {
            angle_count,
            position_count,
            mean_duration_frames: f32::from_bits(word(bytes, 4)),
            rate_hz: f32::from_bits(word(bytes, 5)),
        };
        if bytes.len() != header.byte_count() {
            return Err(ModelBytesError::Length);
        }
        if word(bytes, 6) != checksum(bytes) { Err(ModelBytesError::Checksum) } else { Ok(header) }
    }

    /// Numbers between header and turns.
    #[must_use]
    pub const fn number_count(&self) -> usize {
        let n = self.angle_count;
        self.position_count * (3 * n + packed_len(n)) + 4 * n
    }

    /// Bytes of the whole model.
    #[must_use]
    pub const fn byte_count(&self) -> usize {
        HEADER_BYTES + 4 * self.number_count() + self.angle_count.next_multiple_of(4)
    }

    /// Lends the numbers that follow the header, and the turns after them, as a model.
    ///
    /// # Errors
    /// Those of [`MotionModel::new`]; lengths other than the header's among them.
    pub fn lend<'a>(&self, numbers: &'a [f32], turns_per_cycle: &'a [i8]) -> Result<MotionModel<'a>, ModelError> {
        let (n, l) = (self.angle_count, self.position_count);
        let mut rest = numbers;
        let mut next = |count: usize| {
            let (part, others) = rest.split_at_checked(count).unwrap_or((&[], &[]));
            rest = others;
            part
        };
        MotionModel::new(ModelParts {
            angle_count: n,
            mean_acceleration: next(l * n),
            acceleration_covariance: next(l * packed_len(n)),
            mean_pose_rad: next(l * n),
            mean_velocity: next(l * n),
            deviation: Deviation {
                offset_std_rad: next(n),
                swing_std_rad: next(n),
                rest_std_rad: next(n),
                rest_rate_per_cycle: next(n),
            },
            turns_per_cycle,
            mean_duration_frames: self.mean_duration_frames,
            rate_hz: self.rate_hz,
        })
    }
}

/// Writes `model` into `bytes` and gives the number of bytes written; `None` where they are too few
/// (see [`ModelHeader::byte_count`]) or the model has no deviation.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::HumanModelTable;
/// use sinew_core::cyclic::model::bytes::write;
/// use sinew_core::cyclic::model::walking::WALKING;
///
/// let model = WALKING.model().expect("the shipped model is sound");
/// let mut bytes = [0; 64 * 1024];
/// let length = write(&model, &mut bytes).expect("64 KiB suffice");
/// assert_eq!(HumanModelTable::from_bytes(&bytes[..length])?, WALKING);
/// assert_eq!(write(&model, &mut bytes[..1000]), None);
/// # }
/// # Ok::<(), sinew_core::cyclic::model::bytes::ModelBytesError>(())
/// ```
pub fn write(model: &MotionModel<'_>, bytes: &mut [u8]) -> Option<usize> {
    let parts = model.parts();
    let header = ModelHeader {
        angle_count: model.angle_count(),
        position_count: model.position_count(),
        mean_duration_frames: parts.mean_duration_frames,
        rate_hz: parts.rate_hz,
    };
    let bytes = bytes.get_mut(..header.byte_count()).filter(|_| !parts.deviation.is_absent())?;
    bytes.fill(0);
    let first = [
        MAGIC,
        VERSION,
        header.angle_count as u32,
        header.position_count as u32,
        header.mean_duration_frames.to_bits(),
        header.rate_hz.to_bits(),
        0,
    ];
    let words = first.into_iter().chain(parts.tables().into_iter().flatten().map(|number| number.to_bits()));
    for (slot, word) in bytes.as_chunks_mut::<4>().0.iter_mut().zip(words) {
        *slot = word.to_le_bytes();
    }
    let turns = bytes.iter_mut().skip(HEADER_BYTES + 4 * header.number_count());
    for (slot, turn) in turns.zip(parts.turns_per_cycle) {
        *slot = turn.to_le_bytes()[0];
    }
    let sum = checksum(bytes);
    *bytes.as_chunks_mut::<4>().0.get_mut(6)? = sum.to_le_bytes();
    Some(bytes.len())
}

/// `ROWS` rows of numbers that begin at word `first`.
const fn rows<const COLUMNS: usize, const ROWS: usize>(bytes: &[u8], first: usize) -> [[f32; COLUMNS]; ROWS] {
    let mut table = [[0.0; COLUMNS]; ROWS];
    let mut index = 0;
    while index < ROWS * COLUMNS {
        table[index / COLUMNS][index % COLUMNS] = f32::from_bits(word(bytes, first + index));
        index += 1;
    }
    table
}

impl<const POSITIONS: usize, const ANGLES: usize, const PACKED: usize> ModelTable<POSITIONS, ANGLES, PACKED> {
    /// The table of a model in bytes; for a `static`, so that it is read when the program is built.
    ///
    /// # Errors
    /// See [`ModelBytesError`]; [`ModelBytesError::Shape`] for a model of another shape than the
    /// table's.
    pub const fn from_bytes(bytes: &[u8]) -> Result<Self, ModelBytesError> {
        let header = match ModelHeader::read(bytes) {
            Ok(header) => header,
            Err(error) => return Err(error),
        };
        if header.angle_count != ANGLES || header.position_count != POSITIONS || PACKED != packed_len(ANGLES) {
            return Err(ModelBytesError::Shape);
        }
        let numbers = HEADER_BYTES / 4;
        let covariance = numbers + POSITIONS * ANGLES;
        let pose = covariance + POSITIONS * PACKED;
        let velocity = pose + POSITIONS * ANGLES;
        let deviation = velocity + POSITIONS * ANGLES;
        let mut turns_per_cycle = [0; ANGLES];
        let [offset_std_rad, swing_std_rad, rest_std_rad, rest_rate_per_cycle] = rows::<ANGLES, 4>(bytes, deviation);
        let mut angle = 0;
        while angle < ANGLES {
            let turns = word(bytes, deviation + 4 * ANGLES + angle / 4);
            turns_per_cycle[angle] = turns.to_le_bytes()[angle % 4].cast_signed();
            angle += 1;
        }
        Ok(Self {
            mean_acceleration: rows(bytes, numbers),
            acceleration_covariance: rows(bytes, covariance),
            mean_pose_rad: rows(bytes, pose),
            mean_velocity: rows(bytes, velocity),
            offset_std_rad,
            swing_std_rad,
            rest_std_rad,
            rest_rate_per_cycle,
            turns_per_cycle,
            mean_duration_frames: header.mean_duration_frames,
            rate_hz: header.rate_hz,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::model::table::HumanModelTable;
    use crate::cyclic::synthetic;

    fn bytes_of(table: &HumanModelTable) -> Vec<u8> {
        let mut bytes = vec![0xAA; 64 * 1024];
        let count = write(&table.model().unwrap(), &mut bytes).unwrap();
        bytes.truncate(count);
        bytes
    }

    #[test]
    fn a_table_survives_its_bytes() {
        let mut table = synthetic::table(4.0e-3, 9);
        table.turns_per_cycle[3] = -1;
        let bytes = bytes_of(&table);
        let back = HumanModelTable::from_bytes(&bytes).unwrap();
        assert_eq!(back, *table);
        let header = ModelHeader::read(&bytes).unwrap();
        let numbers: Vec<f32> =
            bytes[HEADER_BYTES..].as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)).collect();
        let model = header.lend(&numbers[..header.number_count()], &table.turns_per_cycle).unwrap();
        assert_eq!(model, table.model().unwrap());
        assert_eq!(write(&model, &mut vec![0; bytes.len() - 1]), None);
    }

    #[test]
    fn invalid_bytes_are_refused() {
        let good = bytes_of(&synthetic::table(4.0e-3, 9));
        let wrong = |index: usize, to: u8| {
            let mut bytes = good.clone();
            bytes[index] ^= to;
            ModelHeader::read(&bytes).unwrap_err()
        };
        assert_eq!(wrong(0, 1), ModelBytesError::NoModel);
        assert_eq!(wrong(4, 2), ModelBytesError::Version);
        assert_eq!(wrong(8, 64), ModelBytesError::Shape);
        assert_eq!(wrong(8, 1), ModelBytesError::Length);
        for index in [16, 24, 28, 2000, good.len() - 1] {
            assert_eq!(wrong(index, 1), ModelBytesError::Checksum, "byte {index}");
        }
        for length in 0..40 {
            assert!(ModelHeader::read(&good[..length]).is_err());
        }
        assert_eq!(ModelTable::<100, 12, 78>::from_bytes(&good).unwrap_err(), ModelBytesError::Shape);
    }
}
