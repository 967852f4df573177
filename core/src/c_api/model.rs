//! Motion models for C: bytes in the caller's flash, read where they lie.

use super::cyclic_frame::SINEW_MAX_ANGLES;
use super::object::list;
use super::status::SinewStatus;
use crate::checksum::Crc32;
use crate::cyclic::MotionModel;
use crate::cyclic::model::bytes::{HEADER_BYTES, ModelHeader};
use core::ffi::c_void;

#[cfg(target_endian = "big")]
compile_error!("motion models are read in place, as little-endian numbers");

/// The model in the bytes given; the walking model for null and zero bytes.
///
/// # Errors
/// A misaligned pointer; bytes that are no model of at most [`SINEW_MAX_ANGLES`] angles; a library
/// without the walking model.
///
/// # Safety
/// `model` points at `bytes` bytes that never change.
pub(super) unsafe fn read_model(model: *const c_void, bytes: usize) -> Result<MotionModel<'static>, SinewStatus> {
    if model.is_null() && bytes == 0 {
        return walking();
    }
    if !model.cast::<f32>().is_aligned() {
        return Err(SinewStatus::Misaligned);
    }
    // SAFETY: the caller's duty.
    let bytes = unsafe { list(model.cast::<u8>(), bytes)? };
    let header = ModelHeader::read(bytes).map_err(|_| SinewStatus::BadModel)?;
    if header.angle_count > SINEW_MAX_ANGLES {
        return Err(SinewStatus::BadModel);
    }
    let (_, numbers) = bytes.split_at_checked(HEADER_BYTES).ok_or(SinewStatus::BadModel)?;
    let (numbers, turns) = numbers.split_at_checked(4 * header.number_count()).ok_or(SinewStatus::BadModel)?;
    let turns = turns.get(..header.angle_count).ok_or(SinewStatus::BadModel)?;
    // SAFETY: any bits make an f32 or an i8, which live as long as the bytes; the numbers begin at
    // a multiple of four.
    let (numbers, turns) = unsafe { (numbers.align_to::<f32>().1, turns.align_to::<i8>().1) };
    Ok(header.lend(numbers, turns)?)
}

#[cfg(feature = "walking-model")]
fn walking() -> Result<MotionModel<'static>, SinewStatus> {
    Ok(crate::cyclic::model::walking::WALKING.model()?)
}

#[cfg(not(feature = "walking-model"))]
fn walking() -> Result<MotionModel<'static>, SinewStatus> {
    Err(SinewStatus::NoModel)
}

/// A checksum of all that the coupled filter takes from a model: states belong to it.
pub(super) fn fingerprint(model: &MotionModel<'_>) -> u32 {
    let parts = model.parts();
    let deviation = &parts.deviation;
    let numbers = [
        &[parts.mean_duration_frames, parts.rate_hz],
        parts.mean_pose_rad,
        deviation.offset_std_rad,
        deviation.swing_std_rad,
        deviation.rest_std_rad,
        deviation.rest_rate_per_cycle,
    ];
    let numbers = numbers.into_iter().flatten().fold(Crc32::new(), |sum, number| sum.and_word(number.to_bits()));
    parts.turns_per_cycle.iter().fold(numbers, |sum, turns| sum.and(turns.to_le_bytes()[0])).value()
}
