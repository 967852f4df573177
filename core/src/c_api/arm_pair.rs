//! The trackers of both arms of a person, which share one list of blobs.

use super::arm_config::SinewArmConfig;
use super::arm_frame::{ArmMemory, SINEW_ARM_PARTICLES, SinewArmFrame, SinewArmResult};
use super::cyclic::SINEW_ALIGN;
use super::object::{Handle, Object, given, given_config, object, place, room};
use super::stateful::{Stateful, size_functions, state_functions};
use super::status::{Answer, SinewStatus, status};
use crate::saved_state::StateKind;
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
const _: () = assert!(offset_of!(SinewArmPair, 0) == 0);

type Tracker = ArmPair<SINEW_ARM_PARTICLES>;

/// A tracker of both arms; see `sinew_arm_pair_init`. Saved states fit the same configuration; seed
/// and shoulders may differ.
#[derive(Debug)]
pub struct SinewArmPair(Object<BothArms>);

/// What a tracker of both arms holds.
#[derive(Debug)]
pub(super) struct BothArms {
    fingerprint: u32,
    config: SinewArmConfig,
    left: ArmModel,
    right: ArmModel,
    memory: ArmMemory<Tracker>,
}

// SAFETY: that is its only field.
unsafe impl Handle for SinewArmPair {
    type Content = BothArms;
    const KIND: [u8; 4] = *b"SNap";
}

size_functions!(SinewArmPair, sinew_arm_pair_size, sinew_arm_pair_align);

/// Makes a tracker of both arms in `memory`, which it needs as long as it is used; there is nothing
/// to free. `config` is copied.
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
            let (handle, config) = (room(tracker)?, given_config(config)?);
            let mut place = place::<SinewArmPair>(memory, memory_bytes)?;
            place.is_apart(tracker, 1)?;
            place.is_apart(config, 1)?;
            config.check()?;
            config.shoulder(Side::Left)?;
            config.shoulder(Side::Right)?;
            // Zeros are a memory that did not begin.
            let arms = place.clear();
            (&raw mut (*arms).fingerprint).write(config.fingerprint(2));
            (&raw mut (*arms).config).write(*config);
            config.write_model(Side::Left, Some(&mut *(&raw mut (*arms).left).cast()))?;
            config.write_model(Side::Right, Some(&mut *(&raw mut (*arms).right).cast()))?;
            place.install(handle, Stateful::begin)
        })()
    })
}

/// Takes in one frame, and writes where both arms are then, left and right.
///
/// Every status but SINEW_STATUS_OK leaves the tracker as it was: a number that is NaN, infinite or
/// out of range, lists over capacity, a timestamp not after the last one.
///
/// # Safety
/// `tracker` comes from `sinew_arm_pair_init`; the frame's lists have as many elements as it says.
/// `results` has room for two.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_arm_pair_step(
    tracker: *mut SinewArmPair,
    frame: *const SinewArmFrame,
    results: *mut SinewArmResult,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe {
        (|| {
            let mut tracker = object(tracker)?;
            tracker.is_apart(frame, 1)?;
            tracker.is_apart(results, 2)?;
            let (frame, results) = (given(frame)?, room(results.cast::<[SinewArmResult; 2]>())?);
            tracker.is_apart(frame.candidates, frame.candidate_count as usize)?;
            tracker.is_apart(frame.edges, frame.edge_count as usize)?;
            let BothArms { left, right, memory, .. } = &mut *tracker;
            let pair_frame = PairFrame {
                timestamp_us: frame.timestamp_us,
                image: frame.image()?,
                shoulders_m: [frame.shoulder(Side::Left)?, frame.shoulder(Side::Right)?],
            };
            memory.admit(frame.timestamp_us)?;
            let [of_left, of_right] = memory.tracker.step([left, right], &pair_frame);
            results.write([
                SinewArmResult::of(frame.timestamp_us, left, &of_left),
                SinewArmResult::of(frame.timestamp_us, right, &of_right),
            ]);
            Ok(())
        })()
    })
}

state_functions!(SinewArmPair, tracker, sinew_arm_pair_reset, sinew_arm_pair_save, sinew_arm_pair_restore);

impl Stateful for BothArms {
    type Memory = ArmMemory<Tracker>;
    const KIND: StateKind = StateKind::ArmPair;

    fn fingerprint(&self) -> u32 {
        self.fingerprint
    }

    fn memory(&mut self) -> &mut ArmMemory<Tracker> {
        &mut self.memory
    }

    fn reset(&mut self) -> Answer {
        let shoulders_m = [self.config.shoulder(Side::Left)?, self.config.shoulder(Side::Right)?];
        self.memory.forget();
        Ok(self.memory.tracker.begin([&self.left, &self.right], shoulders_m, self.config.seed)?)
    }
}
