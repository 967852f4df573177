//! The arm tracker: blobs of skin and moving edges in, the pose of one arm out.

use super::arm_frame::{
    ArmMemory, SINEW_ARM_PARTICLES, SINEW_SIDE_LEFT, SINEW_SIDE_RIGHT, SinewArmConfig, SinewArmFrame, SinewArmResult,
};
use super::cyclic::SINEW_ALIGN;
use super::object::{Seal, Sealed, given, object, place, room};
use super::stateful::{Stateful, install, size_functions, state_functions};
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

type Tracker = ArmTracker<SINEW_ARM_PARTICLES>;

/// An arm tracker; see `sinew_arm_init`. Saved states fit the same configuration; seed and
/// shoulders may differ.
#[derive(Debug)]
pub struct SinewArm {
    seal: Seal,
    fingerprint: u32,
    config: SinewArmConfig,
    model: ArmModel,
    memory: ArmMemory<Tracker>,
}

// SAFETY: the seal is that field.
unsafe impl Sealed for SinewArm {
    const SEAL: Seal = Seal::of(*b"SNar");
    const SEAL_AT: usize = offset_of!(SinewArm, seal);
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
            let (handle, config) = (room(tracker)?, *given(config)?);
            let place = place::<SinewArm>(memory, memory_bytes)?;
            let side = match side {
                SINEW_SIDE_LEFT => Side::Left,
                SINEW_SIDE_RIGHT => Side::Right,
                _ => return Err(SinewStatus::OutOfRange),
            };
            let model = config.model(side)?;
            let fingerprint = config.fingerprint(side as u32);
            let memory = ArmMemory::new(Tracker::empty());
            let object = place.write(SinewArm { seal: Seal::BROKEN, fingerprint, config, model, memory });
            install(object, handle)
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
            let (tracker, frame) = (object(tracker)?, given(frame)?);
            let result = room(result)?;
            let SinewArm { model, memory, .. } = tracker;
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

impl Stateful for SinewArm {
    type Memory = ArmMemory<Tracker>;
    const KIND: StateKind = StateKind::Arm;

    fn seal_mut(&mut self) -> &mut Seal {
        &mut self.seal
    }

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
