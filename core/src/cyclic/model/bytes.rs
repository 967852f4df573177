//! A motion model as bytes: made on a host, put into flash, read where it lies.
//!
//! Little-endian words of four bytes, so that a processor reads the numbers in place if the first
//! byte lies at a multiple of four:
//!
//! | words | what |
//! |---|---|
//! | 0 | [`MAGIC`], or [`COUPLED_MAGIC`] |
//! | 1 | version, [`VERSION`] |
//! | 2, 3 | number n of angles, number l of positions |
//! | 4, 5 | mean duration, frames; frames per second |
//! | 6 | CRC-32 of words 1 to 5 and all after word 6 |
//! | then | mean acceleration (l n), covariance (l n (n + 1) / 2), mean pose (l n), mean velocity (l n) |
//! | then | spread of offset, cosine, sine and rest, rate of the rest (n each) |
//! | last | turns per cycle, a signed byte each, filled with zeros to a whole word |
//!
//! A model for the phase-coupled filter alone begins with [`COUPLED_MAGIC`]. It has neither
//! accelerations nor covariances nor velocities.

use crate::checksum::Crc32;
use crate::cyclic::model::coupled_model::{CoupledModel, CoupledParts, MAX_ANGLES, ModelError};
use crate::cyclic::model::coupled_table::CoupledTable;
use crate::cyclic::model::deviation::Deviation;
use crate::cyclic::model::motion_model::MotionModel;
use crate::cyclic::model::table::ModelTable;
use crate::error::{ParameterError, Rule};
use crate::numeric::semi_definite::packed_len;
use core::fmt;

/// First word of a model for all filters: `SNWM`.
pub const MAGIC: u32 = u32::from_le_bytes(*b"SNWM");
/// First word of a model for the phase-coupled filter alone: `SNWC`.
pub const COUPLED_MAGIC: u32 = u32::from_le_bytes(*b"SNWC");
/// Version of the layout.
pub const VERSION: u32 = 2;
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
    /// A model for the phase-coupled filter alone, where one for all filters is needed.
    CoupledOnly,
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
            Self::CoupledOnly => {
                "the motion model is one for the coupled filter alone; export it with `--form bytes` for the others"
            }
            Self::Shape => "the motion model has too many or too few angles or positions",
            Self::Length => "the motion model has another length than its header says",
            Self::Checksum => "the motion model's checksum is wrong; its bytes were changed",
        })
    }
}

impl core::error::Error for ModelBytesError {}

/// Which filters a model in bytes is for.
///
/// ```
/// use sinew_core::cyclic::model::bytes::{ModelForm, ModelHeader};
///
/// let form = |flash: &[u8]| ModelHeader::read(flash).ok().map(|header| header.form);
/// assert_eq!(form(b"no model"), None);
/// # #[cfg(feature = "walking-model")] {
/// # use sinew_core::cyclic::model::{bytes::write_coupled, walking::WALKING_COUPLED};
/// # let mut memory = [0; 8 * 1024];
/// # let model = WALKING_COUPLED.model().expect("the shipped model is sound");
/// # let length = write_coupled(&model, &mut memory).expect("it fits");
/// # let flash = &memory[..length];
/// // What `sinew export walking --form coupled-bytes` writes.
/// assert_eq!(form(flash), Some(ModelForm::Coupled));
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ModelForm {
    /// All filters: [`MAGIC`].
    Full,
    /// The phase-coupled filter: [`COUPLED_MAGIC`].
    Coupled,
}

impl ModelForm {
    const fn magic(self) -> u32 {
        match self {
            Self::Full => MAGIC,
            Self::Coupled => COUPLED_MAGIC,
        }
    }
}

/// Header of a model.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::model::bytes::{ModelBytesError, ModelForm, ModelHeader, write};
/// # use sinew_core::cyclic::model::walking::WALKING;
///
/// # let mut memory = [0; 64 * 1024];
/// # let length = write(&WALKING.model().expect("the shipped model is sound"), &mut memory).expect("it fits");
/// # let flash = &mut memory[..length];
/// // Which model is in flash, before a filter is made for it.
/// let header = ModelHeader::read(flash)?;
/// assert_eq!((header.form, header.angle_count, header.position_count), (ModelForm::Full, 13, 100));
/// assert_eq!(header.byte_count(), flash.len());
/// flash[1000] ^= 1;
/// assert_eq!(ModelHeader::read(flash), Err(ModelBytesError::Checksum));
/// # }
/// # Ok::<(), sinew_core::cyclic::model::bytes::ModelBytesError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModelHeader {
    /// Which filters it is for.
    pub form: ModelForm,
    /// Number n of angles.
    pub angle_count: usize,
    /// Number l of positions.
    pub position_count: usize,
    /// See [`CoupledParts::mean_duration_frames`].
    pub mean_duration_frames: f32,
    /// See [`CoupledParts::rate_hz`].
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
    /// The header of `model` for all filters.
    #[must_use]
    pub const fn of(model: &MotionModel<'_>) -> Self {
        Self::of_parts(ModelForm::Full, &model.parts().coupled())
    }

    /// The header of `model` for the phase-coupled filter alone.
    #[must_use]
    pub const fn of_coupled(model: &CoupledModel<'_>) -> Self {
        Self::of_parts(ModelForm::Coupled, model.parts())
    }

    const fn of_parts(form: ModelForm, parts: &CoupledParts<'_>) -> Self {
        Self {
            form,
            angle_count: parts.angle_count,
            // A checked model has at least one angle.
            position_count: match parts.mean_pose_rad.len().checked_div(parts.angle_count) {
                Some(count) => count,
                None => 0,
            },
            mean_duration_frames: parts.mean_duration_frames,
            rate_hz: parts.rate_hz,
        }
    }

    /// Reads the header and checks length and checksum.
    ///
    /// # Errors
    /// See [`ModelBytesError`].
    pub const fn read(bytes: &[u8]) -> Result<Self, ModelBytesError> {
        let form = match word(bytes, 0) {
            MAGIC => ModelForm::Full,
            COUPLED_MAGIC => ModelForm::Coupled,
            _ => return Err(ModelBytesError::NoModel),
        };
        if word(bytes, 1) != VERSION {
            return Err(ModelBytesError::Version);
        }
        let (angle_count, position_count) = (word(bytes, 2) as usize, word(bytes, 3) as usize);
        if angle_count == 0 || angle_count > MAX_ANGLES || position_count < 4 || position_count > MAX_POSITIONS {
            return Err(ModelBytesError::Shape);
        }
        let header = Self {
            form,
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
        let (n, l) = (self.angle_count, self.position_count);
        self.first_pose() + l * n + self.velocity_count() + 5 * n
    }

    /// Numbers before the mean pose.
    const fn first_pose(&self) -> usize {
        let n = self.angle_count;
        match self.form {
            ModelForm::Full => self.position_count * (n + packed_len(n)),
            ModelForm::Coupled => 0,
        }
    }

    /// Numbers between the mean pose and the deviation.
    const fn velocity_count(&self) -> usize {
        match self.form {
            ModelForm::Full => self.position_count * self.angle_count,
            ModelForm::Coupled => 0,
        }
    }

    /// Bytes of the whole model.
    #[must_use]
    pub const fn byte_count(&self) -> usize {
        HEADER_BYTES + 4 * self.number_count() + self.angle_count.next_multiple_of(4)
    }

    /// Lends the numbers that follow the header, and the turns after them, as a model for all
    /// filters.
    ///
    /// # Errors
    /// Those of [`MotionModel::new`]; lengths other than the header's among them, and a model for
    /// the phase-coupled filter alone.
    pub fn lend<'a>(&self, numbers: &'a [f32], turns_per_cycle: &'a [i8]) -> Result<MotionModel<'a>, ModelError> {
        let (n, l) = (self.angle_count, self.position_count);
        let (mean_acceleration, rest) = part(numbers, l * n);
        let (acceleration_covariance, _) = part(rest, l * packed_len(n));
        let (_, rest) = part(numbers, self.first_pose() + l * n);
        if self.form == ModelForm::Coupled {
            return Err(ModelError::of_all(ParameterError::new("mean_acceleration", Rule::NotEmpty)));
        }
        let coupled = self.lend_coupled(numbers, turns_per_cycle)?;
        MotionModel::of_coupled(coupled, mean_acceleration, acceleration_covariance, part(rest, l * n).0)
    }

    /// Lends them as a model for the phase-coupled filter, in either form; of the other numbers
    /// none is read.
    ///
    /// # Errors
    /// Those of [`CoupledModel::new`]; lengths other than the header's among them.
    pub fn lend_coupled<'a>(
        &self,
        numbers: &'a [f32],
        turns_per_cycle: &'a [i8],
    ) -> Result<CoupledModel<'a>, ModelError> {
        CoupledModel::new(self.coupled_parts(numbers, turns_per_cycle))
    }

    fn coupled_parts<'a>(&self, numbers: &'a [f32], turns_per_cycle: &'a [i8]) -> CoupledParts<'a> {
        let n = self.angle_count;
        let (_, rest) = part(numbers, self.first_pose());
        let (mean_pose_rad, rest) = part(rest, self.position_count * n);
        let (_, rest) = part(rest, self.velocity_count());
        let (offset_std_rad, rest) = part(rest, n);
        let (cosine_std_rad, rest) = part(rest, n);
        let (sine_std_rad, rest) = part(rest, n);
        let (rest_std_rad, rest) = part(rest, n);
        let (rest_rate_per_cycle, _) = part(rest, n);
        CoupledParts {
            angle_count: n,
            mean_pose_rad,
            deviation: Deviation { offset_std_rad, cosine_std_rad, sine_std_rad, rest_std_rad, rest_rate_per_cycle },
            turns_per_cycle,
            mean_duration_frames: self.mean_duration_frames,
            rate_hz: self.rate_hz,
        }
    }
}

/// The first `count` numbers and those after them; none where there are fewer.
fn part(numbers: &[f32], count: usize) -> (&[f32], &[f32]) {
    numbers.split_at_checked(count).unwrap_or((&[], &[]))
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
    write_numbers(&ModelHeader::of(model), &model.parts().tables(), model, bytes)
}

/// Writes the part of `model` that the phase-coupled filter reads, as [`write()`] writes a whole
/// one.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::model::bytes::{ModelBytesError, write_coupled};
/// use sinew_core::cyclic::model::walking::{WALKING, WALKING_COUPLED};
/// use sinew_core::cyclic::{HumanCoupledTable, HumanModelTable};
///
/// let model = WALKING.model().expect("the shipped model is sound");
/// let mut bytes = [0; 6000];
/// let length = write_coupled(&model, &mut bytes).expect("they suffice");
/// assert_eq!(HumanCoupledTable::from_bytes(&bytes[..length])?, WALKING_COUPLED);
/// // The Kalman filter and the particle filter cannot take it.
/// assert_eq!(HumanModelTable::from_bytes(&bytes[..length]), Err(ModelBytesError::CoupledOnly));
/// # }
/// # Ok::<(), sinew_core::cyclic::model::bytes::ModelBytesError>(())
/// ```
pub fn write_coupled(model: &CoupledModel<'_>, bytes: &mut [u8]) -> Option<usize> {
    let parts = model.parts();
    let Deviation { offset_std_rad, cosine_std_rad, sine_std_rad, rest_std_rad, rest_rate_per_cycle } = parts.deviation;
    let tables = [parts.mean_pose_rad, offset_std_rad, cosine_std_rad, sine_std_rad, rest_std_rad, rest_rate_per_cycle];
    write_numbers(&ModelHeader::of_coupled(model), &tables, model, bytes)
}

fn write_numbers(header: &ModelHeader, tables: &[&[f32]], model: &CoupledModel<'_>, bytes: &mut [u8]) -> Option<usize> {
    let parts = model.parts();
    let bytes = bytes.get_mut(..header.byte_count()).filter(|_| !parts.deviation.is_absent())?;
    bytes.fill(0);
    let first = [
        header.form.magic(),
        VERSION,
        header.angle_count as u32,
        header.position_count as u32,
        header.mean_duration_frames.to_bits(),
        header.rate_hz.to_bits(),
        0,
    ];
    let words = first.into_iter().chain(tables.iter().copied().flatten().map(|number| number.to_bits()));
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

/// The header of a model of `ANGLES` angles and `POSITIONS` positions in bytes.
const fn header_of<const POSITIONS: usize, const ANGLES: usize>(bytes: &[u8]) -> Result<ModelHeader, ModelBytesError> {
    match ModelHeader::read(bytes) {
        Ok(header) if header.angle_count == ANGLES && header.position_count == POSITIONS => Ok(header),
        Ok(_) => Err(ModelBytesError::Shape),
        Err(error) => Err(error),
    }
}

impl<const POSITIONS: usize, const ANGLES: usize> CoupledTable<POSITIONS, ANGLES> {
    /// The table of a model in bytes, of either form; for a `static`, so that it is read when the
    /// program is built, and of a model for all filters only this part is linked.
    ///
    /// # Errors
    /// See [`ModelBytesError`]; [`ModelBytesError::Shape`] for a model of another shape than the
    /// table's.
    pub const fn from_bytes(bytes: &[u8]) -> Result<Self, ModelBytesError> {
        let header = match header_of::<POSITIONS, ANGLES>(bytes) {
            Ok(header) => header,
            Err(error) => return Err(error),
        };
        let pose = HEADER_BYTES / 4 + header.first_pose();
        let deviation = pose + POSITIONS * ANGLES + header.velocity_count();
        let mut turns_per_cycle = [0; ANGLES];
        let [offset_std_rad, cosine_std_rad, sine_std_rad, rest_std_rad, rest_rate_per_cycle] =
            rows::<ANGLES, 5>(bytes, deviation);
        let mut angle = 0;
        while angle < ANGLES {
            let turns = word(bytes, deviation + 5 * ANGLES + angle / 4);
            turns_per_cycle[angle] = turns.to_le_bytes()[angle % 4].cast_signed();
            angle += 1;
        }
        Ok(Self {
            mean_pose_rad: rows(bytes, pose),
            offset_std_rad,
            cosine_std_rad,
            sine_std_rad,
            rest_std_rad,
            rest_rate_per_cycle,
            turns_per_cycle,
            mean_duration_frames: header.mean_duration_frames,
            rate_hz: header.rate_hz,
        })
    }
}

impl<const POSITIONS: usize, const ANGLES: usize, const PACKED: usize> ModelTable<POSITIONS, ANGLES, PACKED> {
    /// The table of a model in bytes; for a `static`, so that it is read when the program is built.
    ///
    /// # Errors
    /// See [`ModelBytesError`]; [`ModelBytesError::Shape`] for a model of another shape than the
    /// table's, [`ModelBytesError::CoupledOnly`] for one of the phase-coupled filter alone.
    pub const fn from_bytes(bytes: &[u8]) -> Result<Self, ModelBytesError> {
        let header = match header_of::<POSITIONS, ANGLES>(bytes) {
            Ok(header) => header,
            Err(error) => return Err(error),
        };
        if PACKED != packed_len(ANGLES) {
            return Err(ModelBytesError::Shape);
        }
        if let ModelForm::Coupled = header.form {
            return Err(ModelBytesError::CoupledOnly);
        }
        let coupled = match CoupledTable::<POSITIONS, ANGLES>::from_bytes(bytes) {
            Ok(coupled) => coupled,
            Err(error) => return Err(error),
        };
        let covariance = HEADER_BYTES / 4 + POSITIONS * ANGLES;
        let velocity = covariance + POSITIONS * (PACKED + ANGLES);
        Ok(Self {
            mean_acceleration: rows(bytes, HEADER_BYTES / 4),
            acceleration_covariance: rows(bytes, covariance),
            mean_pose_rad: coupled.mean_pose_rad,
            mean_velocity: rows(bytes, velocity),
            offset_std_rad: coupled.offset_std_rad,
            cosine_std_rad: coupled.cosine_std_rad,
            sine_std_rad: coupled.sine_std_rad,
            rest_std_rad: coupled.rest_std_rad,
            rest_rate_per_cycle: coupled.rest_rate_per_cycle,
            turns_per_cycle: coupled.turns_per_cycle,
            mean_duration_frames: header.mean_duration_frames,
            rate_hz: header.rate_hz,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::model::coupled_table::HumanCoupledTable;
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
    fn the_coupled_form_holds_what_the_coupled_filter_reads() {
        let mut table = synthetic::table(4.0e-3, 9);
        table.turns_per_cycle[3] = -1;
        let (whole, model) = (bytes_of(&table), table.model().unwrap());
        let mut bytes = vec![0xAA; 8192];
        let count = write_coupled(&model, &mut bytes).unwrap();
        bytes.truncate(count);
        assert_eq!(count, ModelHeader::of_coupled(&model).byte_count());
        assert_eq!(write_coupled(&model, &mut vec![0; count - 1]), None);
        let from = |bytes: &[u8]| HumanCoupledTable::from_bytes(bytes).unwrap();
        assert_eq!(from(&bytes), from(&whole));
        assert_eq!(from(&bytes).model().unwrap(), *model);
        assert_eq!(HumanModelTable::from_bytes(&bytes), Err(ModelBytesError::CoupledOnly));
        for bytes in [&bytes, &whole] {
            let header = ModelHeader::read(bytes).unwrap();
            let numbers: Vec<f32> =
                bytes[HEADER_BYTES..].as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)).collect();
            let numbers = &numbers[..header.number_count()];
            assert_eq!(header.lend_coupled(numbers, &table.turns_per_cycle).unwrap(), *model);
            assert_eq!(header.lend(numbers, &table.turns_per_cycle).is_ok(), header.form == ModelForm::Full);
            assert!(header.lend_coupled(&numbers[..numbers.len() - 1], &table.turns_per_cycle).is_err());
        }
        // A whole model's numbers under the other first word are too many.
        let mut swapped = whole;
        swapped[..4].copy_from_slice(&COUPLED_MAGIC.to_le_bytes());
        assert_eq!(ModelHeader::read(&swapped), Err(ModelBytesError::Length));
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
