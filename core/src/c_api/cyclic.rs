//! The cyclic tracker: angles of a walking person in, pose, position in the cycle and cadence out.

use super::cyclic_config::SinewCyclicConfig;
use super::cyclic_frame::{SINEW_MAX_ANGLES, SinewCyclicFrame, SinewCyclicResult};
use super::model::read_model;
use super::object::{Handle, Object, given, given_config, object, place, room};
use super::stateful::{Stateful, size_functions, state_functions};
use super::status::{Answer, SinewStatus, status};
use crate::cyclic::measurement::MAX_STEP_FRAMES;
use crate::cyclic::phase::wrap_position;
use crate::cyclic::{AngleMeasurement, CoupledModel};
use crate::math::min;
use crate::saved_state::{SavedState, StateKind, StateVisitor};
use crate::tracker::cyclic::CoupledTracker;
use crate::tracker::cyclic::{CyclicFrame, FirstPhase};
use core::ffi::c_void;
use core::mem::offset_of;

/// Bytes that always suffice for a cyclic tracker, on every target.
pub const SINEW_CYCLIC_MAX_BYTES: usize = 4608;
/// Bytes that always suffice for the saved state of a cyclic tracker.
pub const SINEW_CYCLIC_STATE_MAX_BYTES: usize = 5120;
/// Alignment that suffices for every object of this library.
pub const SINEW_ALIGN: usize = 8;

const _: () = assert!(size_of::<SinewCyclic>() <= SINEW_CYCLIC_MAX_BYTES && align_of::<SinewCyclic>() <= SINEW_ALIGN);
const _: () = assert!(offset_of!(SinewCyclic, 0) == 0);

type Tracker = CoupledTracker<SINEW_MAX_ANGLES>;

/// A cyclic tracker; see `sinew_cyclic_init`. Saved states fit the same model. After a reset the
/// next frame may have any timestamp.
#[derive(Debug)]
pub struct SinewCyclic(Object<Cyclic>);

/// What a cyclic tracker holds.
#[derive(Debug)]
pub(super) struct Cyclic {
    fingerprint: u32,
    model: CoupledModel<'static>,
    first: FirstPhase,
    memory: Memory,
}

/// What changes from frame to frame.
#[derive(Debug)]
pub(super) struct Memory {
    timestamp_us: u64,
    /// Whether a frame showed something; the tracker means nothing until then.
    has_begun: bool,
    tracker: Tracker,
}

// SAFETY: that is its only field.
unsafe impl Handle for SinewCyclic {
    type Content = Cyclic;
    const KIND: [u8; 4] = *b"SNcy";
}

size_functions!(SinewCyclic, sinew_cyclic_size, sinew_cyclic_align);

/// Makes a cyclic tracker in `memory`, which it needs as long as it is used; there is nothing to
/// free.
///
/// `model` is a motion model in bytes (the command `sinew export` makes one), aligned to four,
/// which has to stay where it is as long as the tracker is used. The form for the coupled filter
/// suffices (`--form coupled-c`, 5.5 KB); of the form for all filters the rest is not read. Null
/// and zero bytes stand for the walking model that the library was built with. All numbers that the
/// tracker reads are checked once, here.
///
/// `config` is copied; null stands for what `sinew_cyclic_default_config` writes.
///
/// Returns SINEW_STATUS_BAD_MODEL for bytes that are no model of at most `SINEW_MAX_ANGLES` angles,
/// SINEW_STATUS_NO_MODEL if the library was built without the walking model. `tracker` is written
/// only if the status is SINEW_STATUS_OK.
///
/// # Safety
/// `memory` and `model` have the sizes that are said.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_cyclic_init(
    memory: *mut c_void,
    memory_bytes: usize,
    model: *const c_void,
    model_bytes: usize,
    config: *const SinewCyclicConfig,
    tracker: *mut *mut SinewCyclic,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe {
        (|| {
            let handle = room(tracker)?;
            let mut place = place::<SinewCyclic>(memory, memory_bytes)?;
            place.is_apart(tracker, 1)?;
            place.is_apart(model.cast::<u8>(), model_bytes)?;
            place.is_apart(config, 1)?;
            let model = read_model(model, model_bytes)?;
            let first =
                if config.is_null() { FirstPhase::default() } else { given_config(config)?.first_phase(&model)? };
            // Zeros are a memory that did not begin.
            let cyclic = place.clear();
            (&raw mut (*cyclic).fingerprint).write(model.checksum());
            (&raw mut (*cyclic).model).write(model);
            (&raw mut (*cyclic).first).write(first);
            place.install(handle, Stateful::begin)
        })()
    })
}

/// Takes in one frame, and writes what is known then.
///
/// A frame more than 600 frames of the model after the last counts as that much later. Returns
/// SINEW_STATUS_WAITING, and writes no result, until a first frame shows an angle. Every other
/// status but SINEW_STATUS_OK leaves the tracker as it was: a number that is NaN, infinite or
/// out of range, more angles than the model has, a timestamp not after the last one.
///
/// # Safety
/// `tracker` comes from `sinew_cyclic_init`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_cyclic_step(
    tracker: *mut SinewCyclic,
    frame: *const SinewCyclicFrame,
    result: *mut SinewCyclicResult,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe {
        (|| {
            let mut tracker = object(tracker)?;
            tracker.is_apart(frame, 1)?;
            tracker.is_apart(result, 1)?;
            let (frame, result) = (given(frame)?, room(result)?);
            let answer = tracker.step(frame)?;
            result.write(SinewCyclicResult::of(frame.timestamp_us, &answer, tracker.memory.is_searching()));
            Ok(())
        })()
    })
}

/// Writes the model's mean pose at a position of the cycle (any number; 1 is one cycle on) into the
/// first `angle_count` of `angles_rad`, radians.
///
/// Returns SINEW_STATUS_OVER_CAPACITY for more angles than the model has.
///
/// # Safety
/// `tracker` comes from `sinew_cyclic_init`, `angles_rad` has room for as many numbers as is said.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_cyclic_mean_pose(
    tracker: *mut SinewCyclic,
    cycle_position: f32,
    angles_rad: *mut f32,
    angle_count: usize,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe {
        (|| {
            let tracker = object(tracker)?;
            tracker.is_apart(angles_rad, angle_count)?;
            let position = wrap_position(crate::error::finite("cycle_position", cycle_position)?);
            let pose = tracker.model.mean_pose_rad::<SINEW_MAX_ANGLES>(tracker.model.point(position));
            if angle_count > tracker.model.angle_count() {
                return Err(SinewStatus::OverCapacity);
            }
            for (index, angle) in pose.iter().enumerate().take(angle_count) {
                room(angles_rad.wrapping_add(index))?.write(*angle);
            }
            Ok(())
        })()
    })
}

state_functions!(SinewCyclic, tracker, sinew_cyclic_reset, sinew_cyclic_save, sinew_cyclic_restore);

impl Stateful for Cyclic {
    type Memory = Memory;
    const KIND: StateKind = StateKind::Cyclic;

    fn fingerprint(&self) -> u32 {
        self.fingerprint
    }

    fn memory(&mut self) -> &mut Memory {
        &mut self.memory
    }

    fn reset(&mut self) -> Answer {
        self.memory.forget();
        Ok(())
    }
}

impl Cyclic {
    fn step(&mut self, frame: &SinewCyclicFrame) -> Result<CyclicFrame<SINEW_MAX_ANGLES>, SinewStatus> {
        let measurement = frame.measurement(self.model.angle_count())?;
        if !self.memory.has_begun {
            self.memory.begin(&self.model, &measurement, self.first)?;
            self.memory.timestamp_us = frame.timestamp_us;
            return Ok(self.memory.tracker.first_frame(&self.model, &measurement));
        }
        let elapsed_us = frame.timestamp_us.checked_sub(self.memory.timestamp_us).filter(|&elapsed| elapsed > 0);
        let elapsed_us = elapsed_us.ok_or(SinewStatus::OutOfOrder)?;
        let step_frames = min(elapsed_us as f32 * 1.0e-6 * self.model.rate_hz(), MAX_STEP_FRAMES);
        let measurement = measurement.after(step_frames)?;
        self.memory.timestamp_us = frame.timestamp_us;
        Ok(self.memory.tracker.step(&self.model, &measurement))
    }
}

impl Memory {
    /// Out of the way of the steps that follow, whose stack it would share.
    #[inline(never)]
    fn begin(
        &mut self,
        model: &CoupledModel<'_>,
        first: &AngleMeasurement<SINEW_MAX_ANGLES>,
        phase: FirstPhase,
    ) -> Answer {
        if first.is_empty(model.angle_count()) {
            return Err(SinewStatus::Waiting);
        }
        self.tracker.begin(model, first, phase)?;
        self.has_begun = true;
        Ok(())
    }

    fn forget(&mut self) {
        self.has_begun = false;
        self.timestamp_us = 0;
    }

    fn is_searching(&self) -> bool {
        self.has_begun && self.tracker.filter().is_searching()
    }
}

impl SavedState for Memory {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.long(&mut self.timestamp_us);
        visitor.flag(&mut self.has_begun);
        if self.has_begun {
            self.tracker.visit(visitor);
        }
    }
}
