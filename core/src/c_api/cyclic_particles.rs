//! The particle filter of the cyclic paper: angles of a walking person in, pose, position in the
//! cycle and cadence out.

use super::cyclic::SINEW_ALIGN;
use super::cyclic_frame::{SINEW_MAX_ANGLES, SinewCyclicFrame, SinewCyclicResult};
use super::cyclic_particles_config::{SINEW_CYCLIC_PARTICLES, SinewCyclicParticlesConfig};
use super::model::read_whole_model;
use super::object::{Handle, Object, given, given_config, object, place, room};
use super::stateful::{Stateful, size_functions, state_functions};
use super::status::{Answer, SinewStatus, status};
use crate::cyclic::measurement::MAX_STEP_FRAMES;
use crate::cyclic::{AngleMeasurement, MotionModel};
use crate::math::min;
use crate::saved_state::{SavedState, StateKind, StateVisitor};
use crate::tracker::cyclic::{CyclicFrame, FirstPhase, ParticleCycleTracker};
use core::ffi::c_void;
use core::mem::offset_of;

/// Bytes that always suffice for a cyclic particle filter, on every target.
pub const SINEW_CYCLIC_PARTICLES_MAX_BYTES: usize = 33792;
/// Bytes that always suffice for the saved state of a cyclic particle filter.
pub const SINEW_CYCLIC_PARTICLES_STATE_MAX_BYTES: usize = 11776;

const _: () = assert!(
    size_of::<SinewCyclicParticles>() <= SINEW_CYCLIC_PARTICLES_MAX_BYTES
        && align_of::<SinewCyclicParticles>() <= SINEW_ALIGN
);
const _: () = assert!(offset_of!(SinewCyclicParticles, 0) == 0);

type Tracker = ParticleCycleTracker<SINEW_MAX_ANGLES, SINEW_CYCLIC_PARTICLES>;

/// A cyclic particle filter; see `sinew_cyclic_particles_init`. Saved states fit the same model,
/// number of particles and `cycle_acceleration_std`. After a reset the next frame may have any
/// timestamp.
#[derive(Debug)]
pub struct SinewCyclicParticles(Object<Particles>);

/// What a cyclic particle filter holds.
#[derive(Debug)]
pub(super) struct Particles {
    fingerprint: u32,
    config: SinewCyclicParticlesConfig,
    first: FirstPhase,
    model: MotionModel<'static>,
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
unsafe impl Handle for SinewCyclicParticles {
    type Content = Particles;
    const KIND: [u8; 4] = *b"SNcp";
}

size_functions!(SinewCyclicParticles, sinew_cyclic_particles_size, sinew_cyclic_particles_align);

/// Makes a cyclic particle filter in `memory`, which it needs as long as it is used; there is
/// nothing to free.
///
/// `model` is a motion model in bytes for all filters (`sinew export WHICH --form c`, 52 KB),
/// aligned to four, which has to stay where it is as long as the filter is used. Null and zero
/// bytes stand for the walking model that the library was built with. All its numbers are checked
/// once, here, which takes some time.
///
/// `config` is copied; null stands for what `sinew_cyclic_particles_default_config` writes.
///
/// Returns SINEW_STATUS_BAD_MODEL for bytes that are no model of at most `SINEW_MAX_ANGLES` angles,
/// or one for the coupled filter alone; SINEW_STATUS_NO_MODEL if the library was built without the
/// walking model. `tracker` is written only if the status is SINEW_STATUS_OK.
///
/// # Safety
/// `memory` and `model` have the sizes that are said.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_cyclic_particles_init(
    memory: *mut c_void,
    memory_bytes: usize,
    model: *const c_void,
    model_bytes: usize,
    config: *const SinewCyclicParticlesConfig,
    tracker: *mut *mut SinewCyclicParticles,
) -> SinewStatus {
    // SAFETY: the caller's duty.
    status(unsafe {
        (|| {
            let handle = room(tracker)?;
            let mut place = place::<SinewCyclicParticles>(memory, memory_bytes)?;
            place.is_apart(tracker, 1)?;
            place.is_apart(model.cast::<u8>(), model_bytes)?;
            place.is_apart(config, 1)?;
            let config = if config.is_null() { SinewCyclicParticlesConfig::standard() } else { *given_config(config)? };
            config.check()?;
            let model = read_whole_model(model, model_bytes)?;
            let first = config.first_phase(&model)?;
            // Zeros are a memory that did not begin.
            let particles = place.clear();
            (&raw mut (*particles).fingerprint).write(config.fingerprint(model.checksum()));
            (&raw mut (*particles).config).write(config);
            (&raw mut (*particles).first).write(first);
            (&raw mut (*particles).model).write(model);
            place.install(handle, Stateful::begin)
        })()
    })
}

/// Takes in one frame, and writes what is known then. The result's `is_searching`, `is_outlier` and
/// `is_misfit` are zero.
///
/// A frame more than 600 frames of the model after the last counts as that much later. A frame n
/// frames of the model after the last takes the time of n steps. Returns SINEW_STATUS_WAITING, and
/// writes no result, until a first frame shows an angle. Every other status but SINEW_STATUS_OK
/// leaves the filter as it was: a number that is NaN, infinite or out of range, more angles than
/// the model has, a timestamp not after the last one.
///
/// # Safety
/// `tracker` comes from `sinew_cyclic_particles_init`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_cyclic_particles_step(
    tracker: *mut SinewCyclicParticles,
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
            result.write(SinewCyclicResult::of(frame.timestamp_us, &answer, false));
            Ok(())
        })()
    })
}

state_functions!(
    SinewCyclicParticles,
    tracker,
    sinew_cyclic_particles_reset,
    sinew_cyclic_particles_save,
    sinew_cyclic_particles_restore
);

impl Stateful for Particles {
    type Memory = Memory;
    const KIND: StateKind = StateKind::CyclicParticles;

    fn fingerprint(&self) -> u32 {
        self.fingerprint
    }

    fn memory(&mut self) -> &mut Memory {
        &mut self.memory
    }

    fn reset(&mut self) -> Answer {
        self.memory.has_begun = false;
        self.memory.timestamp_us = 0;
        Ok(self.memory.tracker.configure(self.config.options(), self.config.particles as usize)?)
    }
}

impl Particles {
    fn step(&mut self, frame: &SinewCyclicFrame) -> Result<CyclicFrame<SINEW_MAX_ANGLES>, SinewStatus> {
        let measurement = frame.measurement(self.model.angle_count())?;
        if !self.memory.has_begun {
            self.begin(&measurement)?;
            self.memory.timestamp_us = frame.timestamp_us;
            return Ok(self.memory.tracker.first_frame(&self.model));
        }
        let elapsed_us = frame.timestamp_us.checked_sub(self.memory.timestamp_us).filter(|&elapsed| elapsed > 0);
        let elapsed_us = elapsed_us.ok_or(SinewStatus::OutOfOrder)?;
        let step_frames = min(elapsed_us as f32 * 1.0e-6 * self.model.rate_hz(), MAX_STEP_FRAMES);
        let measurement = measurement.after(step_frames)?;
        self.memory.timestamp_us = frame.timestamp_us;
        Ok(self.memory.tracker.step(&self.model, &measurement))
    }

    /// Out of the way of the steps that follow, whose stack it would share.
    #[inline(never)]
    fn begin(&mut self, first: &AngleMeasurement<SINEW_MAX_ANGLES>) -> Answer {
        if first.is_empty(self.model.angle_count()) {
            return Err(SinewStatus::Waiting);
        }
        self.memory.tracker.begin(&self.model, first, self.first, self.config.seed)?;
        self.memory.has_begun = true;
        Ok(())
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
