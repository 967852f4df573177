//! The trackers of both arms of a person, which share one list of blobs.

use super::arm_frame::{SINEW_ARM_PARTICLES, SinewArmConfig, SinewArmFrame, SinewArmResult};
use super::cyclic::SINEW_ALIGN;
use super::object::{Seal, Sealed, bytes_mut, given, list, object, place, room};
use super::status::{Answer, SinewStatus, status};
use crate::saved_state::{SavedState, StateError, StateKind, StateVisitor, restore, save, saved_bytes};
use crate::skeleton::Side;
use crate::tracker::arm::{ArmModel, ArmPair, PairFrame};
use core::ffi::c_void;
use core::mem::offset_of;

/// Bytes that always suffice for a tracker of both arms, on every target.
pub const SINEW_ARM_PAIR_MAX_BYTES: usize = 24576;
/// Bytes that always suffice for the saved state of a tracker of both arms.
pub const SINEW_ARM_PAIR_STATE_MAX_BYTES: usize = 8192;

const _: () =
    assert!(size_of::<SinewArmPair>() <= SINEW_ARM_PAIR_MAX_BYTES && align_of::<SinewArmPair>() <= SINEW_ALIGN);

/// A tracker of both arms; see `sinew_arm_pair_init`.
#[derive(Debug)]
pub struct SinewArmPair {
    seal: Seal,
    fingerprint: u32,
    config: SinewArmConfig,
    left: ArmModel,
    right: ArmModel,
    memory: Memory,
}

/// What changes from frame to frame.
#[derive(Debug)]
struct Memory {
    /// That of the last frame, if there was one.
    timestamp_us: Option<u64>,
    tracker: ArmPair<SINEW_ARM_PARTICLES>,
}

// SAFETY: the seal is that field.
unsafe impl Sealed for SinewArmPair {
    const SEAL: Seal = Seal::of(*b"SNap");
    const SEAL_AT: usize = offset_of!(SinewArmPair, seal);
}

/// Bytes that a tracker of both arms takes on this target; `SINEW_ARM_PAIR_MAX_BYTES` at most.
#[unsafe(no_mangle)]
pub extern "C" fn sinew_arm_pair_size() -> usize {
    size_of::<SinewArmPair>()
}

/// Alignment that the memory of a tracker of both arms needs; `SINEW_ALIGN` at most.
#[unsafe(no_mangle)]
pub extern "C" fn sinew_arm_pair_align() -> usize {
    align_of::<SinewArmPair>()
}

/// Makes a tracker of both arms in `memory`, which it needs as long as it is used; there is nothing to free. `config` is copied.
///
/// `tracker` is written only if the status is SINEW_STATUS_OK.
///
/// # Safety
/// `memory` has the size that is said.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_arm_pair_init(
    memory: *mut c_void,
    memory_bytes: usize,
    config: *const SinewArmConfig,
    tracker: *mut *mut SinewArmPair,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe {
        (|| {
            let (handle, config) = (room(tracker)?, *given(config)?);
            let place = place::<SinewArmPair>(memory, memory_bytes)?;
            let (left, right) = (config.model(Side::Left)?, config.model(Side::Right)?);
            let fingerprint = config.fingerprint(2);
            let memory = Memory { timestamp_us: None, tracker: ArmPair::empty() };
            // The seal comes last: a tracker that did not begin is none.
            let object = place.write(SinewArmPair { seal: Seal::BROKEN, fingerprint, config, left, right, memory });
            object.reset()?;
            object.seal = SinewArmPair::SEAL;
            handle.write(object);
            Ok(())
        })()
    })
}

/// Takes in one frame, and writes where both arms are then, left and right.
///
/// Every status but SINEW_STATUS_OK leaves the tracker as it was: a number that is NaN, infinite or out of range, lists over
/// capacity, a timestamp not after the last one.
///
/// # Safety
/// `tracker` comes from `sinew_arm_pair_init`; the frame's lists have as many elements as it says. `results` has room for two.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_arm_pair_step(
    tracker: *mut SinewArmPair,
    frame: *const SinewArmFrame,
    results: *mut SinewArmResult,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe {
        (|| {
            let (tracker, frame) = (object(tracker)?, given(frame)?);
            let results = room(results.cast::<[SinewArmResult; 2]>())?;
            let SinewArmPair { left, right, memory, .. } = tracker;
            let pair_frame = PairFrame {
                timestamp_us: frame.timestamp_us,
                image: frame.image()?,
                shoulders_m: [frame.shoulder(Side::Left)?, frame.shoulder(Side::Right)?],
            };
            if memory.timestamp_us.is_some_and(|before| frame.timestamp_us <= before) {
                return Err(SinewStatus::OutOfOrder);
            }
            memory.timestamp_us = Some(frame.timestamp_us);
            let [of_left, of_right] = memory.tracker.step([left, right], &pair_frame);
            results.write([
                SinewArmResult::of(frame.timestamp_us, left, &of_left),
                SinewArmResult::of(frame.timestamp_us, right, &of_right),
            ]);
            Ok(())
        })()
    })
}

/// Forgets all frames, as after `sinew_arm_pair_init` with the same configuration.
///
/// # Safety
/// `tracker` comes from `sinew_arm_pair_init`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_arm_pair_reset(tracker: *mut SinewArmPair) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe { object(tracker) }.and_then(SinewArmPair::reset))
}

/// Writes the state into `buffer`, so that a tracker made with the same configuration (seed and shoulders may differ), on this
/// processor or another, can go on from it.
///
/// Writes into `written` how many bytes the state takes, also where the buffer is too small. The tracker is not changed.
///
/// # Safety
/// `tracker` comes from `sinew_arm_pair_init`, `buffer` has the size that is said.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_arm_pair_save(
    tracker: *mut SinewArmPair,
    buffer: *mut u8,
    buffer_bytes: usize,
    written: *mut usize,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe {
        (|| {
            let (tracker, buffer, written) = (object(tracker)?, bytes_mut(buffer, buffer_bytes)?, room(written)?);
            written.write(saved_bytes(&mut tracker.memory));
            save(StateKind::ArmPair, tracker.fingerprint, &mut tracker.memory, buffer)?;
            Ok(())
        })()
    })
}

/// Goes on from a state that was saved, all of `state_bytes`.
///
/// A state that is not whole, of another version or configuration is refused, and the tracker is as before. A state that is whole
/// and yet holds a number that cannot be (SINEW_STATUS_BAD_STATE too) leaves a tracker that begins anew, as after `sinew_arm_pair_reset`.
///
/// # Safety
/// `tracker` comes from `sinew_arm_pair_init`, `state` has the size that is said.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_arm_pair_restore(
    tracker: *mut SinewArmPair,
    state: *const u8,
    state_bytes: usize,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe {
        (|| {
            let (tracker, state) = (object(tracker)?, list(state, state_bytes)?);
            let answer = restore(StateKind::ArmPair, tracker.fingerprint, &mut tracker.memory, state);
            if answer == Err(StateError::Illegal) {
                tracker.reset()?;
            }
            Ok(answer?)
        })()
    })
}

impl SinewArmPair {
    fn reset(&mut self) -> Answer {
        let shoulders_m = [self.config.shoulder(Side::Left)?, self.config.shoulder(Side::Right)?];
        self.memory.timestamp_us = None;
        Ok(self.memory.tracker.begin([&self.left, &self.right], shoulders_m, self.config.seed)?)
    }
}

impl SavedState for Memory {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.optional_long(&mut self.timestamp_us);
        self.tracker.visit(visitor);
    }
}
