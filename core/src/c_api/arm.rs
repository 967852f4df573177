//! The arm tracker: blobs of skin and moving edges in, the pose of one arm out.

use super::arm_frame::{
    SINEW_ARM_PARTICLES, SINEW_SIDE_LEFT, SINEW_SIDE_RIGHT, SinewArmConfig, SinewArmFrame, SinewArmResult,
};
use super::cyclic::SINEW_ALIGN;
use super::object::{Seal, Sealed, bytes_mut, given, list, object, place, room};
use super::status::{Answer, SinewStatus, status};
use crate::saved_state::{SavedState, StateError, StateKind, StateVisitor, restore, save, saved_bytes};
use crate::skeleton::Side;
use crate::tracker::arm::{ArmFrame, ArmModel, ArmTracker};
use core::ffi::c_void;
use core::mem::offset_of;

/// Bytes that always suffice for an arm tracker, on every target.
pub const SINEW_ARM_MAX_BYTES: usize = 12288;
/// Bytes that always suffice for the saved state of an arm tracker.
pub const SINEW_ARM_STATE_MAX_BYTES: usize = 4096;

const _: () = assert!(size_of::<SinewArm>() <= SINEW_ARM_MAX_BYTES && align_of::<SinewArm>() <= SINEW_ALIGN);

/// An arm tracker; see `sinew_arm_init`.
#[derive(Debug)]
pub struct SinewArm {
    seal: Seal,
    fingerprint: u32,
    config: SinewArmConfig,
    model: ArmModel,
    memory: Memory,
}

/// What changes from frame to frame.
#[derive(Debug)]
struct Memory {
    /// That of the last frame, if there was one.
    timestamp_us: Option<u64>,
    tracker: ArmTracker<SINEW_ARM_PARTICLES>,
}

// SAFETY: the seal is that field.
unsafe impl Sealed for SinewArm {
    const SEAL: Seal = Seal::of(*b"SNar");
    const SEAL_AT: usize = offset_of!(SinewArm, seal);
}

/// Bytes that an arm tracker takes on this target; `SINEW_ARM_MAX_BYTES` at most.
#[unsafe(no_mangle)]
pub extern "C" fn sinew_arm_size() -> usize {
    size_of::<SinewArm>()
}

/// Alignment that the memory of an arm tracker needs; `SINEW_ALIGN` at most.
#[unsafe(no_mangle)]
pub extern "C" fn sinew_arm_align() -> usize {
    align_of::<SinewArm>()
}

/// Makes an arm tracker in `memory`, which it needs as long as it is used; there is nothing to free. `config` is copied.
///
/// `side` is SINEW_SIDE_LEFT or SINEW_SIDE_RIGHT, the person's own.
/// `tracker` is written only if the status is SINEW_STATUS_OK.
///
/// # Safety
/// `memory` has the size that is said.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_arm_init(
    memory: *mut c_void,
    memory_bytes: usize,
    config: *const SinewArmConfig,
    side: u32,
    tracker: *mut *mut SinewArm,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe {
        (|| {
            let (handle, config) = (room(tracker)?, *given(config)?);
            let place = place::<SinewArm>(memory, memory_bytes)?;
            let side = match side {
                SINEW_SIDE_LEFT => Side::Left,
                SINEW_SIDE_RIGHT => Side::Right,
                _ => return Err(SinewStatus::OutOfRange),
            };
            let model = config.model(side)?;
            let fingerprint = config.fingerprint(side as u32);
            let memory = Memory { timestamp_us: None, tracker: ArmTracker::empty() };
            // The seal comes last: a tracker that did not begin is none.
            let object = place.write(SinewArm { seal: Seal::BROKEN, fingerprint, config, model, memory });
            object.reset()?;
            object.seal = SinewArm::SEAL;
            handle.write(object);
            Ok(())
        })()
    })
}

/// Takes in one frame, and writes where the arm is then.
///
/// Every status but SINEW_STATUS_OK leaves the tracker as it was: a number that is NaN, infinite or out of range, lists over
/// capacity, a timestamp not after the last one.
///
/// # Safety
/// `tracker` comes from `sinew_arm_init`; the frame's lists have as many elements as it says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_arm_step(
    tracker: *mut SinewArm,
    frame: *const SinewArmFrame,
    result: *mut SinewArmResult,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe {
        (|| {
            let (tracker, frame) = (object(tracker)?, given(frame)?);
            let result = room(result)?;
            let SinewArm { model, memory, .. } = tracker;
            let frame_of_arm = ArmFrame {
                timestamp_us: frame.timestamp_us,
                image: frame.image()?,
                shoulder_m: frame.shoulder(model.side())?,
            };
            if memory.timestamp_us.is_some_and(|before| frame.timestamp_us <= before) {
                return Err(SinewStatus::OutOfOrder);
            }
            memory.timestamp_us = Some(frame.timestamp_us);
            let estimate = memory.tracker.step(model, &frame_of_arm);
            result.write(SinewArmResult::of(frame.timestamp_us, model, &estimate));
            Ok(())
        })()
    })
}

/// Forgets all frames, as after `sinew_arm_init` with the same configuration.
///
/// # Safety
/// `tracker` comes from `sinew_arm_init`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_arm_reset(tracker: *mut SinewArm) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe { object(tracker) }.and_then(SinewArm::reset))
}

/// Writes the state into `buffer`, so that a tracker made with the same configuration (seed and shoulders may differ), on this
/// processor or another, can go on from it.
///
/// Writes into `written` how many bytes the state takes, also where the buffer is too small. The tracker is not changed.
///
/// # Safety
/// `tracker` comes from `sinew_arm_init`, `buffer` has the size that is said.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_arm_save(
    tracker: *mut SinewArm,
    buffer: *mut u8,
    buffer_bytes: usize,
    written: *mut usize,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe {
        (|| {
            let (tracker, buffer, written) = (object(tracker)?, bytes_mut(buffer, buffer_bytes)?, room(written)?);
            written.write(saved_bytes(&mut tracker.memory));
            save(StateKind::Arm, tracker.fingerprint, &mut tracker.memory, buffer)?;
            Ok(())
        })()
    })
}

/// Goes on from a state that was saved, all of `state_bytes`.
///
/// A state that is not whole, of another version or configuration is refused, and the tracker is as before. A state that is whole
/// and yet holds a number that cannot be (SINEW_STATUS_BAD_STATE too) leaves a tracker that begins anew, as after `sinew_arm_reset`.
///
/// # Safety
/// `tracker` comes from `sinew_arm_init`, `state` has the size that is said.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_arm_restore(
    tracker: *mut SinewArm,
    state: *const u8,
    state_bytes: usize,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe {
        (|| {
            let (tracker, state) = (object(tracker)?, list(state, state_bytes)?);
            let answer = restore(StateKind::Arm, tracker.fingerprint, &mut tracker.memory, state);
            if answer == Err(StateError::Illegal) {
                tracker.reset()?;
            }
            Ok(answer?)
        })()
    })
}

impl SinewArm {
    fn reset(&mut self) -> Answer {
        let shoulder_m = self.config.shoulder(self.model.side())?;
        self.memory.timestamp_us = None;
        Ok(self.memory.tracker.begin(&self.model, shoulder_m, self.config.seed)?)
    }
}

impl SavedState for Memory {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.optional_long(&mut self.timestamp_us);
        self.tracker.visit(visitor);
    }
}
