//! The body tracker: points of a depth camera in, the pose of an upper body out.

use super::body_config::SinewBodyConfig;
use super::body_frame::{SinewBodyFrame, SinewBodyResult};
use super::cyclic::SINEW_ALIGN;
use super::object::{Handle, Object, given, given_config, list_mut, object, place, room};
use super::stateful::{Stateful, size_functions, state_functions};
use super::status::{Answer, SinewStatus, status};
use crate::math::Vec3;
use crate::saved_state::{SavedState, StateKind, StateVisitor};
use crate::tracker::body::upper::UpperBodyTracker;
use core::ffi::c_void;
use core::mem::offset_of;

/// Bytes that always suffice for a body tracker, on every target.
pub const SINEW_BODY_MAX_BYTES: usize = 16384;
/// Bytes that always suffice for the saved state of a body tracker.
pub const SINEW_BODY_STATE_MAX_BYTES: usize = 2048;

const _: () = assert!(size_of::<SinewBody>() <= SINEW_BODY_MAX_BYTES && align_of::<SinewBody>() <= SINEW_ALIGN);
const _: () = assert!(offset_of!(SinewBody, 0) == 0);
/// Three numbers lie as a place does.
const _: () = assert!(size_of::<[f32; 3]>() == size_of::<Vec3>() && align_of::<[f32; 3]>() == align_of::<Vec3>());

/// Most points that a frame may name. Chosen: bounds the work; a camera's image has more, and is
/// thinned out by the caller.
const MAX_GIVEN_POINTS: u32 = 65535;
/// Time before the first frame, seconds. Chosen: that of a depth camera of 15 frames a second.
const FIRST_DT_S: f32 = 1.0 / 15.0;

/// A body tracker; see `sinew_body_init`. Saved states fit the same configuration; the first pose
/// may differ.
#[derive(Debug)]
pub struct SinewBody(Object<Body>);

/// What a body tracker holds.
#[derive(Debug)]
pub(super) struct Body {
    fingerprint: u32,
    config: SinewBodyConfig,
    memory: Memory,
}

/// What changes from frame to frame.
#[derive(Debug)]
pub(super) struct Memory {
    /// Whether the tracker has begun: with its first frame, or a saved state.
    has_begun: bool,
    /// Whether there was a frame, with this timestamp.
    has_frame: bool,
    timestamp_us: u64,
    tracker: UpperBodyTracker,
}

// SAFETY: that is its only field.
unsafe impl Handle for SinewBody {
    type Content = Body;
    const KIND: [u8; 4] = *b"SNbo";
}

size_functions!(SinewBody, sinew_body_size, sinew_body_align);

/// Makes a tracker of an upper body in `memory`, which it needs as long as it is used; there is
/// nothing to free. `config` is copied. `tracker` is written only if the status is SINEW_STATUS_OK.
///
/// # Safety
/// `memory` has the size that is said.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_body_init(
    memory: *mut c_void,
    memory_bytes: usize,
    config: *const SinewBodyConfig,
    tracker: *mut *mut SinewBody,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe {
        (|| {
            let (handle, config) = (room(tracker)?, given_config(config)?);
            let mut place = place::<SinewBody>(memory, memory_bytes)?;
            place.is_apart(tracker, 1)?;
            place.is_apart(config, 1)?;
            config.check()?;
            // Zeros are a tracker that did not begin.
            let body = place.clear();
            (&raw mut (*body).fingerprint).write(config.fingerprint());
            (&raw mut (*body).config).write(*config);
            place.install(handle, Stateful::begin)
        })()
    })
}

/// Takes in one frame, and writes where the upper body is then. The frame's points are brought into
/// another order.
///
/// Every status but SINEW_STATUS_OK leaves the tracker as it was: too many points, a timestamp not
/// after the last one.
///
/// # Safety
/// `tracker` comes from `sinew_body_init`; the frame has as many points as it says, which no other
/// code uses.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_body_step(
    tracker: *mut SinewBody,
    frame: *const SinewBodyFrame,
    result: *mut SinewBodyResult,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe {
        (|| {
            let mut tracker = object(tracker)?;
            tracker.is_apart(frame, 1)?;
            tracker.is_apart(result, 1)?;
            let (frame, result) = (given(frame)?, room(result)?);
            if frame.point_count > MAX_GIVEN_POINTS {
                return Err(SinewStatus::OverCapacity);
            }
            tracker.is_apart(frame.points_m, frame.point_count as usize)?;
            // Any bits make a number, and a place is three of them.
            let points_m = list_mut(frame.points_m.cast::<Vec3>(), frame.point_count as usize)?;
            result.write(tracker.step(frame.timestamp_us, points_m)?);
            Ok(())
        })()
    })
}

state_functions!(SinewBody, tracker, sinew_body_reset, sinew_body_save, sinew_body_restore);

impl Stateful for Body {
    type Memory = Memory;
    const KIND: StateKind = StateKind::Body;

    fn fingerprint(&self) -> u32 {
        self.fingerprint
    }

    fn memory(&mut self) -> &mut Memory {
        &mut self.memory
    }

    fn reset(&mut self) -> Answer {
        (self.memory.has_begun, self.memory.has_frame, self.memory.timestamp_us) = (false, false, 0);
        Ok(())
    }

    /// A state is read into a tracker, which begins if it did not.
    fn before_restore(&mut self) -> Answer {
        if self.memory.tracker.is_empty() { self.begin_tracker() } else { Ok(()) }
    }
}

impl Body {
    fn step(&mut self, timestamp_us: u64, points_m: &mut [Vec3]) -> Result<SinewBodyResult, SinewStatus> {
        let last_us = self.memory.has_frame.then_some(self.memory.timestamp_us);
        if last_us.is_some_and(|last_us| timestamp_us <= last_us) {
            return Err(SinewStatus::OutOfOrder);
        }
        if !self.memory.has_begun {
            self.begin_tracker()?;
            self.memory.has_begun = true;
        }
        let dt_s = last_us.map_or(FIRST_DT_S, |last_us| (timestamp_us - last_us) as f32 * 1.0e-6);
        (self.memory.has_frame, self.memory.timestamp_us) = (true, timestamp_us);
        let count = points_m.len() as u32;
        let (estimate, left_out) = self.memory.tracker.step(points_m, dt_s).ok_or(SinewStatus::NotInitialised)?;
        Ok(SinewBodyResult::of(timestamp_us, &estimate, count, left_out))
    }

    /// Out of the way of the steps that follow, whose stack it would share.
    #[inline(never)]
    fn begin_tracker(&mut self) -> Answer {
        Ok(self.memory.tracker.begin(&self.config.options(), self.config.first_coordinates)?)
    }
}

impl SavedState for Memory {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.long(&mut self.timestamp_us);
        visitor.flag(&mut self.has_frame);
        visitor.flag(&mut self.has_begun);
        if self.has_begun {
            self.tracker.visit(visitor);
        }
    }
}
