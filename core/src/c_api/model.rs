//! Motion models for C: bytes in the caller's flash, read where they lie.

use super::cyclic_frame::SINEW_MAX_ANGLES;
use super::object::list;
use super::status::SinewStatus;
use crate::cyclic::model::bytes::{HEADER_BYTES, ModelHeader};
use crate::cyclic::{CoupledModel, MotionModel};
use core::ffi::c_void;

#[cfg(target_endian = "big")]
compile_error!("motion models are read in place, as little-endian numbers");

/// The model in the bytes given, of either form; the walking model for null and zero bytes.
///
/// # Errors
/// A misaligned pointer; bytes that are no model of at most [`SINEW_MAX_ANGLES`] angles; a library
/// without the walking model.
///
/// # Safety
/// `model` points at `bytes` bytes that never change.
pub(super) unsafe fn read_model(model: *const c_void, bytes: usize) -> Result<CoupledModel<'static>, SinewStatus> {
    if model.is_null() && bytes == 0 {
        return walking();
    }
    // SAFETY: the caller's duty.
    let (header, numbers, turns) = unsafe { read_numbers(model, bytes)? };
    Ok(header.lend_coupled(numbers, turns)?)
}

/// As [`read_model`], of the form for all filters.
///
/// # Errors
/// Those of [`read_model`]; a model for the phase-coupled filter alone.
///
/// # Safety
/// `model` points at `bytes` bytes that never change.
pub(super) unsafe fn read_whole_model(model: *const c_void, bytes: usize) -> Result<MotionModel<'static>, SinewStatus> {
    if model.is_null() && bytes == 0 {
        return whole_walking();
    }
    // SAFETY: the caller's duty.
    let (header, numbers, turns) = unsafe { read_numbers(model, bytes)? };
    Ok(header.lend(numbers, turns)?)
}

/// Header, numbers and turns of a model in bytes.
///
/// # Safety
/// `model` points at `bytes` bytes that never change.
unsafe fn read_numbers(
    model: *const c_void,
    bytes: usize,
) -> Result<(ModelHeader, &'static [f32], &'static [i8]), SinewStatus> {
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
    Ok((header, numbers, turns))
}

#[cfg(feature = "walking-model")]
fn walking() -> Result<CoupledModel<'static>, SinewStatus> {
    Ok(crate::cyclic::model::walking::WALKING_COUPLED.model()?)
}

#[cfg(feature = "walking-model")]
fn whole_walking() -> Result<MotionModel<'static>, SinewStatus> {
    Ok(crate::cyclic::model::walking::WALKING.model()?)
}

#[cfg(not(feature = "walking-model"))]
fn whole_walking() -> Result<MotionModel<'static>, SinewStatus> {
    Err(SinewStatus::NoModel)
}

#[cfg(not(feature = "walking-model"))]
fn walking() -> Result<CoupledModel<'static>, SinewStatus> {
    Err(SinewStatus::NoModel)
}
