//! What a program may do wrong, and how it is answered.

use super::arm::{SinewArm, sinew_arm_init, sinew_arm_reset, sinew_arm_size, sinew_arm_step};
use super::arm_config::SinewArmConfig;
use super::arm_frame::{SINEW_SIDE_LEFT, SinewArmResult};
use super::cyclic::{
    SINEW_CYCLIC_STATE_MAX_BYTES, SinewCyclic, sinew_cyclic_init, sinew_cyclic_reset, sinew_cyclic_restore,
    sinew_cyclic_save, sinew_cyclic_size, sinew_cyclic_step,
};
use super::cyclic_frame::{SinewCyclicFrame, SinewCyclicResult};
use super::every_object::{Memory, written};
use super::object::object;
use super::status::SinewStatus;
use super::tests::{arm_config, dark, model, swing};
use core::ffi::c_void;
use core::mem::MaybeUninit;
use core::ptr::{null, null_mut};

/// A cyclic tracker in memory of exactly its size.
struct Walker {
    memory: Memory,
    model: Vec<u32>,
    tracker: *mut SinewCyclic,
}

impl Walker {
    fn new() -> Self {
        let mut memory = Memory::new(sinew_cyclic_size());
        let (model, bytes) = model();
        // SAFETY: memory and model have the sizes that are said.
        let tracker = written(|handle| unsafe {
            sinew_cyclic_init(memory.start(), memory.bytes(), model.as_ptr().cast(), bytes, null(), handle)
        });
        Self { memory, model, tracker }
    }

    fn step(&self, frame: &SinewCyclicFrame) -> Result<SinewCyclicResult, SinewStatus> {
        let mut result = MaybeUninit::uninit();
        // SAFETY: the tracker's memory, frame and result are there.
        let status = unsafe { sinew_cyclic_step(self.tracker, frame, result.as_mut_ptr()) };
        // SAFETY: the status says that it was written.
        if status == SinewStatus::Ok { Ok(unsafe { result.assume_init() }) } else { Err(status) }
    }

    fn save(&self) -> Vec<u8> {
        let mut state = vec![0; SINEW_CYCLIC_STATE_MAX_BYTES];
        // SAFETY: the tracker's memory and the buffer are there.
        let bytes = written(|bytes| unsafe { sinew_cyclic_save(self.tracker, state.as_mut_ptr(), state.len(), bytes) });
        state.truncate(bytes);
        state
    }

    fn restore(&self, state: &[u8]) -> SinewStatus {
        // SAFETY: the tracker's memory and the state are there.
        unsafe { sinew_cyclic_restore(self.tracker, state.as_ptr(), state.len()) }
    }
}

/// The memory is smaller than the object that is asked for: it must not be read to its end.
#[test]
fn an_object_of_another_kind_is_refused() {
    let walker = Walker::new();
    assert!(sinew_cyclic_size() < sinew_arm_size());
    // SAFETY: memory of an object.
    assert_eq!(unsafe { sinew_arm_reset(walker.tracker.cast()) }, SinewStatus::NotInitialised);
    assert!(walker.step(&swing(0, 0b11)).is_ok());
}

#[test]
fn a_call_while_another_one_runs_is_refused_and_changes_nothing() {
    let (walker, twin) = (Walker::new(), Walker::new());
    assert_eq!(walker.step(&swing(0, 0b11)), twin.step(&swing(0, 0b11)));
    {
        // SAFETY: the tracker was initialised.
        let running = unsafe { object(walker.tracker) };
        assert!(running.is_ok());
        assert_eq!(walker.step(&swing(16_667, 0b11)), Err(SinewStatus::Busy));
        // SAFETY: the tracker was initialised.
        assert_eq!(unsafe { sinew_cyclic_reset(walker.tracker) }, SinewStatus::Busy);
        assert_eq!(walker.restore(&twin.save()), SinewStatus::Busy);
    }
    assert_eq!(walker.step(&swing(33_333, 0b11)), twin.step(&swing(33_333, 0b11)));
    assert_eq!(walker.save(), twin.save());
}

#[test]
fn a_refused_call_leaves_the_object_free() {
    let walker = Walker::new();
    for _ in 0..3 {
        assert_eq!(walker.step(&swing(0, 1 << 12)), Err(SinewStatus::OutOfRange));
        // SAFETY: the tracker was initialised; null is refused.
        assert_eq!(unsafe { sinew_cyclic_step(walker.tracker, &swing(0, 0b11), null_mut()) }, SinewStatus::NullPointer);
    }
    assert!(walker.step(&swing(0, 0b11)).is_ok());
}

#[test]
fn an_object_that_another_one_overlaps_is_refused() {
    let walker_bytes = sinew_cyclic_size();
    let mut memory = Memory::new(sinew_arm_size() + walker_bytes);
    let (start, config) = (memory.start(), arm_config());
    let init = |place: *mut c_void| {
        // SAFETY: that much memory is there.
        written(|arm| unsafe { sinew_arm_init(place, sinew_arm_size(), &raw const config, SINEW_SIDE_LEFT, arm) })
    };
    // SAFETY: the objects were initialised, or overwritten.
    let reset = |arm: *mut SinewArm| unsafe { sinew_arm_reset(arm) };
    // The other object lies over the end of this one, then over its beginning.
    let first = init(start);
    let second = init(start.wrapping_byte_add(walker_bytes));
    assert_eq!((reset(first), reset(second)), (SinewStatus::NotInitialised, SinewStatus::Ok));
    let first = init(start);
    assert_eq!((reset(first), reset(second)), (SinewStatus::Ok, SinewStatus::NotInitialised));
}

#[test]
fn structures_inside_of_the_object_are_refused() {
    let mut walker = Walker::new();
    let (inside, bytes, model_bytes) =
        (walker.tracker.wrapping_byte_add(512), walker.memory.bytes(), 4 * walker.model.len());
    let frame = swing(0, 0b11);
    let start = walker.memory.start();
    // SAFETY: the tracker was initialised, the pointers point into its memory.
    unsafe {
        assert_eq!(sinew_cyclic_step(walker.tracker, &raw const frame, inside.cast()), SinewStatus::Overlap);
        assert_eq!(sinew_cyclic_save(walker.tracker, inside.cast(), 64, &mut 0), SinewStatus::Overlap);
        assert_eq!(sinew_cyclic_restore(walker.tracker, inside.cast(), 64), SinewStatus::Overlap);
        let model = walker.model.as_ptr().cast();
        assert_eq!(sinew_cyclic_init(start, bytes, model, model_bytes, null(), inside.cast()), SinewStatus::Overlap);
        let mut handle = null_mut();
        assert_eq!(
            sinew_cyclic_init(start, bytes, inside.cast(), model_bytes, null(), &raw mut handle),
            SinewStatus::Overlap
        );
        assert_eq!(
            sinew_cyclic_init(start, bytes, model, model_bytes, inside.cast(), &raw mut handle),
            SinewStatus::Overlap
        );
        // A list without elements lies nowhere.
        assert_eq!(sinew_cyclic_restore(walker.tracker, inside.cast(), 0), SinewStatus::BadState);
        let mut pair = [MaybeUninit::<SinewCyclicResult>::uninit(); 1];
        assert_eq!(sinew_cyclic_step(walker.tracker, &raw const frame, pair[0].as_mut_ptr()), SinewStatus::Ok);
    }
}

#[test]
fn too_little_memory_and_a_wrong_configuration_leave_what_was_there() {
    let mut memory = Memory::new(sinew_arm_size());
    let (start, bytes, config) = (memory.start(), memory.bytes(), arm_config());
    let init = |bytes: usize, config: &SinewArmConfig| {
        let mut arm = null_mut();
        // SAFETY: that much memory is there.
        let status = unsafe { sinew_arm_init(start, bytes, config, SINEW_SIDE_LEFT, &raw mut arm) };
        (status, arm)
    };
    let (status, arm) = init(bytes, &config);
    assert_eq!(status, SinewStatus::Ok);
    assert_eq!(init(bytes - 1, &config), (SinewStatus::TooSmall, null_mut()));
    let far = SinewArmConfig { shoulders_m: [[f32::NAN; 3]; 2], ..config };
    assert_eq!(init(bytes, &far), (SinewStatus::NotFinite, null_mut()));
    let long = SinewArmConfig { forearm_m: 3.0, ..config };
    assert_eq!(init(bytes, &long), (SinewStatus::OutOfRange, null_mut()));
    if !cfg!(miri) {
        // SAFETY: the tracker was initialised, a dark frame's lists are not looked at.
        written(|result: *mut SinewArmResult| unsafe { sinew_arm_step(arm, &dark(33_333), result) });
    }
}
