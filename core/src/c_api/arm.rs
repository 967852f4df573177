//! The arm tracker: blobs of skin and moving edges in, the pose of one arm out.

use super::arm_config::SinewArmConfig;
use super::arm_frame::{
    ArmMemory, SINEW_ARM_PARTICLES, SINEW_SIDE_LEFT, SINEW_SIDE_RIGHT, SinewArmFrame, SinewArmResult,
};
use super::cyclic::SINEW_ALIGN;
use super::object::{Handle, Object, given, given_config, object, place, room};
use super::stateful::{Stateful, size_functions, state_functions};
use super::status::{Answer, SinewStatus, status};
use crate::saved_state::StateKind;
use crate::skeleton::Side;
use crate::tracker::arm::{ArmFrame, ArmModel, ArmTracker};
use core::ffi::c_void;
use core::mem::offset_of;

/// Bytes that always suffice for an arm tracker, on every target.
pub const SINEW_ARM_MAX_BYTES: usize = 12288;
/// Bytes that always suffice for the saved state of an arm tracker.
pub const SINEW_ARM_STATE_MAX_BYTES: usize = 4096;

const _: () = assert!(size_of::<SinewArm>() <= SINEW_ARM_MAX_BYTES && align_of::<SinewArm>() <= SINEW_ALIGN);
const _: () = assert!(offset_of!(SinewArm, 0) == 0);

type Tracker = ArmTracker<SINEW_ARM_PARTICLES>;

/// An arm tracker; see `sinew_arm_init`. Saved states fit the same configuration; seed and
/// shoulders may differ.
#[derive(Debug)]
pub struct SinewArm(Object<Arm>);

/// What an arm tracker holds.
#[derive(Debug)]
pub(super) struct Arm {
    fingerprint: u32,
    config: SinewArmConfig,
    model: ArmModel,
    memory: ArmMemory<Tracker>,
}

// SAFETY: that is its only field.
unsafe impl Handle for SinewArm {
    type Content = Arm;
    const KIND: [u8; 4] = *b"SNar";
}

size_functions!(SinewArm, sinew_arm_size, sinew_arm_align);

/// Makes an arm tracker in `memory`, which it needs as long as it is used; there is nothing to
/// free. `config` is copied.
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
            let (handle, config) = (room(tracker)?, given_config(config)?);
            let mut place = place::<SinewArm>(memory, memory_bytes)?;
            place.is_apart(tracker, 1)?;
            place.is_apart(config, 1)?;
            let side = match side {
                SINEW_SIDE_LEFT => Side::Left,
                SINEW_SIDE_RIGHT => Side::Right,
                _ => return Err(SinewStatus::OutOfRange),
            };
            config.check()?;
            config.shoulder(side)?;
            // Zeros are a memory that did not begin.
            let arm = place.clear();
            (&raw mut (*arm).fingerprint).write(config.fingerprint(side as u32));
            (&raw mut (*arm).config).write(*config);
            config.write_model(side, Some(&mut *(&raw mut (*arm).model).cast()))?;
            place.install(handle, Stateful::begin)
        })()
    })
}

/// Takes in one frame, and writes where the arm is then.
///
/// Every status but SINEW_STATUS_OK leaves the tracker as it was: a number that is NaN, infinite or
/// out of range, lists over capacity, a timestamp not after the last one.
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
            let mut tracker = object(tracker)?;
            tracker.is_apart(frame, 1)?;
            tracker.is_apart(result, 1)?;
            let (frame, result) = (given(frame)?, room(result)?);
            tracker.is_apart(frame.candidates, frame.candidate_count as usize)?;
            tracker.is_apart(frame.edges, frame.edge_count as usize)?;
            let Arm { model, memory, .. } = &mut *tracker;
            let frame_of_arm = ArmFrame {
                timestamp_us: frame.timestamp_us,
                image: frame.image()?,
                shoulder_m: frame.shoulder(model.side())?,
            };
            memory.admit(frame.timestamp_us)?;
            let estimate = memory.tracker.step(model, &frame_of_arm);
            result.write(SinewArmResult::of(frame.timestamp_us, model, &estimate));
            Ok(())
        })()
    })
}

state_functions!(SinewArm, tracker, sinew_arm_reset, sinew_arm_save, sinew_arm_restore);

impl Stateful for Arm {
    type Memory = ArmMemory<Tracker>;
    const KIND: StateKind = StateKind::Arm;

    fn fingerprint(&self) -> u32 {
        self.fingerprint
    }

    fn memory(&mut self) -> &mut ArmMemory<Tracker> {
        &mut self.memory
    }

    fn reset(&mut self) -> Answer {
        let shoulder_m = self.config.shoulder(self.model.side())?;
        self.memory.forget();
        Ok(self.memory.tracker.begin(&self.model, shoulder_m, self.config.seed)?)
    }
}
