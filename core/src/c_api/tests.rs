//! Each object from its memory to its saved state.
//!
//! The memory has exactly the object's size, and nothing was written into it: under Miri a read of
//! what was not written, and an access beyond the memory, fail the test.

use super::arm::sinew_arm_step;
use super::arm::{SinewArm, sinew_arm_init, sinew_arm_reset, sinew_arm_restore, sinew_arm_save, sinew_arm_size};
use super::arm_config::{SinewArmConfig, sinew_arm_default_config};
use super::arm_frame::{SINEW_ARM_UNCERTAIN, SINEW_SIDE_LEFT, SinewArmFrame, SinewArmResult};
use super::arm_pair::{
    SinewArmPair, sinew_arm_pair_init, sinew_arm_pair_reset, sinew_arm_pair_restore, sinew_arm_pair_save,
    sinew_arm_pair_size, sinew_arm_pair_step,
};
use super::body::{
    SinewBody, sinew_body_init, sinew_body_reset, sinew_body_restore, sinew_body_save, sinew_body_size, sinew_body_step,
};
use super::body_config::{SinewBodyConfig, sinew_body_default_config};
use super::body_frame::{SINEW_BODY_PREDICTED, SINEW_BODY_TRACKING, SinewBodyFrame, SinewBodyResult};
use super::cyclic::{
    SinewCyclic, sinew_cyclic_init, sinew_cyclic_mean_pose, sinew_cyclic_reset, sinew_cyclic_restore,
    sinew_cyclic_save, sinew_cyclic_size, sinew_cyclic_step,
};
use super::cyclic_frame::{SINEW_MAX_ANGLES, SinewCyclicFrame, SinewCyclicResult};
use super::cyclic_particles::{
    SinewCyclicParticles, sinew_cyclic_particles_init, sinew_cyclic_particles_reset, sinew_cyclic_particles_restore,
    sinew_cyclic_particles_save, sinew_cyclic_particles_size, sinew_cyclic_particles_step,
};
use super::cyclic_particles_config::{SinewCyclicParticlesConfig, sinew_cyclic_particles_default_config};
use super::every_object::{Memory, StateFunctions, written};
use super::status::SinewStatus;
use super::vision::{
    SinewVision, sinew_vision_begin_calibration, sinew_vision_begin_frame, sinew_vision_end_calibration,
    sinew_vision_end_frame, sinew_vision_init, sinew_vision_line, sinew_vision_reset, sinew_vision_restore,
    sinew_vision_save, sinew_vision_size,
};
use super::vision_frame::{SinewBox, SinewVisionConfig, SinewVisionResult, sinew_vision_default_config};
use crate::camera::Pixel;
use crate::cyclic::example::{swing_pose_rad, swing_table};
use crate::cyclic::model::bytes::{COUPLED_MAGIC, write, write_coupled};
use crate::vision::candidate::HandCandidate;
use crate::vision::edges::EdgePixel;
use core::ffi::c_void;
use core::mem::MaybeUninit;
use core::ptr::{null, null_mut};

/// Memory of zeros is no object.
#[test]
fn memory_that_was_not_initialised_is_no_object() {
    let mut zeros = vec![0_u64; sinew_cyclic_size() / 8];
    // SAFETY: the memory has the object's size.
    assert_eq!(unsafe { sinew_cyclic_reset(zeros.as_mut_ptr().cast()) }, SinewStatus::NotInitialised);
}

/// The model of `swing_table` in words, which are aligned to four bytes, and its length in bytes.
pub(super) fn model() -> (Vec<u32>, usize) {
    let mut bytes = vec![0; 8192];
    let count = write(&swing_table().model().unwrap(), &mut bytes).unwrap();
    (bytes[..count].as_chunks::<4>().0.iter().map(|word| u32::from_ne_bytes(*word)).collect(), count)
}

pub(super) fn swing(timestamp_us: u64, seen: u32) -> SinewCyclicFrame {
    let mut angles_rad = [0.0; SINEW_MAX_ANGLES];
    angles_rad[..2].copy_from_slice(&swing_pose_rad(timestamp_us as f32 * 1.0e-6));
    SinewCyclicFrame { timestamp_us, seen, angle_count: 2, angles_rad, std_rad: [0.05; SINEW_MAX_ANGLES] }
}

#[test]
fn a_cyclic_tracker_goes_on_from_its_state() {
    let functions =
        StateFunctions { save: sinew_cyclic_save, restore: sinew_cyclic_restore, reset: sinew_cyclic_reset };
    let (model, bytes) = model();
    let init = |memory: &mut Memory| {
        // SAFETY: memory and model have the sizes that are said.
        written(|handle| unsafe {
            sinew_cyclic_init(memory.start(), memory.bytes(), model.as_ptr().cast(), bytes, null(), handle)
        })
    };
    let step = |tracker: *mut SinewCyclic, frame: &SinewCyclicFrame| {
        // SAFETY: the tracker was initialised, frame and result are there.
        written(|result: *mut SinewCyclicResult| unsafe { sinew_cyclic_step(tracker, frame, result) })
    };
    let mut memories = [Memory::new(sinew_cyclic_size()), Memory::new(sinew_cyclic_size())];
    let [first, other] = memories.each_mut().map(init);
    let mut result = MaybeUninit::uninit();
    // SAFETY: the tracker was initialised, frame and result are there.
    let status = unsafe { sinew_cyclic_step(first, &swing(0, 0), result.as_mut_ptr()) };
    assert_eq!(status, SinewStatus::Waiting);
    step(first, &swing(0, 0b11));
    functions.copy(first, other);
    functions.refuse_misuse(first);
    let next = swing(16_667, 0b01);
    assert_eq!(step(first, &next), step(other, &next));
    let mut pose_rad = [f32::NAN; 2];
    // SAFETY: the tracker was initialised, and there is room for two angles.
    let status = unsafe { sinew_cyclic_mean_pose(other, 0.0, pose_rad.as_mut_ptr(), 2) };
    assert_eq!((status, pose_rad), (SinewStatus::Ok, swing_pose_rad(0.0)));
    functions.reset(first);
}

#[test]
fn a_cyclic_particle_filter_goes_on_from_its_state() {
    let functions = StateFunctions {
        save: sinew_cyclic_particles_save,
        restore: sinew_cyclic_particles_restore,
        reset: sinew_cyclic_particles_reset,
    };
    let (model, bytes) = model();
    // SAFETY: there is room for one.
    let config = written(|config: *mut SinewCyclicParticlesConfig| unsafe {
        sinew_cyclic_particles_default_config(config, size_of::<SinewCyclicParticlesConfig>())
    });
    let config = SinewCyclicParticlesConfig { particles: if cfg!(miri) { 3 } else { 60 }, ..config };
    let init = |memory: &mut Memory| {
        // SAFETY: memory and model have the sizes that are said.
        written(|handle| unsafe {
            let model = model.as_ptr().cast();
            sinew_cyclic_particles_init(memory.start(), memory.bytes(), model, bytes, &raw const config, handle)
        })
    };
    let step = |tracker: *mut SinewCyclicParticles, frame: &SinewCyclicFrame| {
        // SAFETY: the tracker was initialised, frame and result are there.
        written(|result: *mut SinewCyclicResult| unsafe { sinew_cyclic_particles_step(tracker, frame, result) })
    };
    let mut memories = [Memory::new(sinew_cyclic_particles_size()), Memory::new(sinew_cyclic_particles_size())];
    let [first, other] = memories.each_mut().map(init);
    let mut result = MaybeUninit::uninit();
    // SAFETY: the tracker was initialised, frame and result are there.
    let status = unsafe { sinew_cyclic_particles_step(first, &swing(0, 0), result.as_mut_ptr()) };
    assert_eq!(status, SinewStatus::Waiting);
    let begun = step(first, &swing(0, 0b11));
    assert!(begun.cycle_position < 0.05 || begun.cycle_position > 0.95, "{begun:?}");
    step(first, &swing(16_667, 0b11));
    functions.copy(first, other);
    functions.refuse_misuse(first);
    let next = swing(50_000, 0b01);
    assert_eq!(step(first, &next), step(other, &next));
    functions.reset(first);
    assert_eq!(step(first, &swing(0, 0b11)), begun);
}

#[test]
fn models_for_c_are_checked() {
    let (model, bytes) = model();
    let mut memory = Memory::new(sinew_cyclic_size());
    let start: *const c_void = model.as_ptr().cast();
    let mut init = |model: *const c_void, bytes: usize| {
        let mut handle: *mut SinewCyclic = null_mut();
        // SAFETY: memory and model have the sizes that are said, or are null or misaligned.
        let status =
            unsafe { sinew_cyclic_init(memory.start(), memory.bytes(), model, bytes, null(), &raw mut handle) };
        assert!(handle.is_null());
        status
    };
    assert_eq!(init(start.wrapping_byte_add(1), bytes - 1), SinewStatus::Misaligned);
    assert_eq!(init(start, bytes - 4), SinewStatus::BadModel);
    assert_eq!(init(start, 3), SinewStatus::BadModel);
    assert_eq!(init(null(), bytes), SinewStatus::NullPointer);
    // Numbers of the form for all filters are too many for the one of the coupled filter.
    let mut other_form = model.clone();
    other_form[0] = COUPLED_MAGIC;
    assert_eq!(init(other_form.as_ptr().cast(), bytes), SinewStatus::BadModel);
    let mut other_version = model;
    other_version[1] += 1;
    assert_eq!(init(other_version.as_ptr().cast(), bytes), SinewStatus::BadModel);
}

#[test]
fn the_coupled_form_of_a_model_suffices() {
    let table = swing_table();
    let mut words = [0_u32; 256];
    let mut bytes = [0; 1024];
    let count = write_coupled(&table.model().unwrap(), &mut bytes).unwrap();
    for (word, bytes) in words.iter_mut().zip(bytes.as_chunks::<4>().0) {
        *word = u32::from_ne_bytes(*bytes);
    }
    let mut memory = Memory::new(sinew_cyclic_size());
    // SAFETY: memory and model have the sizes that are said.
    let tracker = written(|handle| unsafe {
        sinew_cyclic_init(memory.start(), memory.bytes(), words.as_ptr().cast(), count, null(), handle)
    });
    let mut pose_rad = [f32::NAN; 2];
    // SAFETY: the tracker was initialised, and there is room for two angles.
    let status = unsafe { sinew_cyclic_mean_pose(tracker, 0.25, pose_rad.as_mut_ptr(), 2) };
    assert_eq!((status, pose_rad), (SinewStatus::Ok, swing_pose_rad(0.25)));
}

/// A hand below the left shoulder and some edges.
pub(super) fn arm_lists() -> ([HandCandidate; 2], [EdgePixel; 3]) {
    let hand = |u_px: f32| HandCandidate {
        centre: Pixel::new(u_px, 190.0),
        moments_px2: [100.0, 0.0, 100.0],
        area_px: 1200.0,
        likelihood: 0.8,
    };
    (
        [hand(210.0), hand(110.0)],
        [EdgePixel { u: 200, v: 150 }, EdgePixel { u: 205, v: 160 }, EdgePixel { u: 319, v: 239 }],
    )
}

pub(super) fn arm_frame(
    timestamp_us: u64,
    (candidates, edges): &([HandCandidate; 2], [EdgePixel; 3]),
) -> SinewArmFrame {
    SinewArmFrame {
        timestamp_us,
        candidates: candidates.as_ptr(),
        edges: edges.as_ptr(),
        candidate_count: candidates.len() as u32,
        edge_count: edges.len() as u32,
        has_image: 1,
        shoulders_m: [[0.19, -0.05, 1.25], [-0.19, -0.05, 1.25]],
    }
}

pub(super) fn arm_config() -> SinewArmConfig {
    // SAFETY: there is room for one.
    written(|config| unsafe { sinew_arm_default_config(320, 240, 1.0, config, size_of::<SinewArmConfig>()) })
}

/// Miri takes minutes for a step of an arm tracker, seconds to begin one. There a frame that is
/// refused after its lists were read has to do, and a tracker goes on from its own state.
const STEPS_ARMS: bool = !cfg!(miri);

/// Two trackers, or twice the same one.
fn two_trackers<T>([first, other]: [&mut Memory; 2], init: impl Fn(&mut Memory) -> *mut T) -> [*mut T; 2] {
    let first = init(first);
    [first, if STEPS_ARMS { init(other) } else { first }]
}

/// Lists whose last candidate has a likelihood out of range.
fn wrong_lists() -> ([HandCandidate; 2], [EdgePixel; 3]) {
    let (mut candidates, edges) = arm_lists();
    candidates[1].likelihood = 2.0;
    (candidates, edges)
}

/// A frame without an image, whose lists are not looked at.
pub(super) fn dark(timestamp_us: u64) -> SinewArmFrame {
    let absent = SinewArmFrame { candidates: null(), edges: null(), ..arm_frame(timestamp_us, &arm_lists()) };
    SinewArmFrame { has_image: 0, ..absent }
}

#[test]
fn an_arm_tracker_goes_on_from_its_state() {
    let functions = StateFunctions { save: sinew_arm_save, restore: sinew_arm_restore, reset: sinew_arm_reset };
    let config = arm_config();
    let init = |memory: &mut Memory| {
        // SAFETY: the memory has the size that is said.
        written(|handle| unsafe {
            sinew_arm_init(memory.start(), memory.bytes(), &raw const config, SINEW_SIDE_LEFT, handle)
        })
    };
    let step = |tracker: *mut SinewArm, frame: &SinewArmFrame| {
        // SAFETY: the tracker was initialised, the lists are there or not looked at.
        written(|result: *mut SinewArmResult| unsafe { sinew_arm_step(tracker, frame, result) })
    };
    let mut memories = [Memory::new(sinew_arm_size()), Memory::new(sinew_arm_size())];
    let [first, other] = two_trackers(memories.each_mut(), init);
    let mut result = MaybeUninit::uninit();
    // SAFETY: the tracker was initialised, the lists are there.
    let status = unsafe { sinew_arm_step(first, &arm_frame(0, &wrong_lists()), result.as_mut_ptr()) };
    assert_eq!(status, SinewStatus::OutOfRange);
    if STEPS_ARMS {
        // Two blobs, and nothing yet says which is the hand.
        assert_eq!(step(first, &arm_frame(0, &arm_lists())).state, SINEW_ARM_UNCERTAIN);
    }
    functions.copy(first, other);
    functions.refuse_misuse(first);
    if STEPS_ARMS {
        assert_eq!(step(first, &dark(33_333)), step(other, &dark(33_333)));
        functions.reset(first);
    }
}

#[test]
fn a_tracker_of_both_arms_goes_on_from_its_state() {
    let functions =
        StateFunctions { save: sinew_arm_pair_save, restore: sinew_arm_pair_restore, reset: sinew_arm_pair_reset };
    let config = arm_config();
    let init = |memory: &mut Memory| {
        // SAFETY: the memory has the size that is said.
        written(|handle| unsafe { sinew_arm_pair_init(memory.start(), memory.bytes(), &raw const config, handle) })
    };
    let step = |tracker: *mut SinewArmPair, frame: &SinewArmFrame| {
        // SAFETY: the tracker was initialised, the lists are there or not looked at.
        written(|results: *mut [SinewArmResult; 2]| unsafe { sinew_arm_pair_step(tracker, frame, results.cast()) })
    };
    let mut memories = [Memory::new(sinew_arm_pair_size()), Memory::new(sinew_arm_pair_size())];
    let [first, other] = two_trackers(memories.each_mut(), init);
    let mut results = [MaybeUninit::<SinewArmResult>::uninit(); 2];
    // SAFETY: the tracker was initialised, the lists are there.
    let status = unsafe { sinew_arm_pair_step(first, &arm_frame(0, &wrong_lists()), results.as_mut_ptr().cast()) };
    assert_eq!(status, SinewStatus::OutOfRange);
    if STEPS_ARMS {
        assert_eq!(step(first, &arm_frame(0, &arm_lists())).map(|result| result.candidate), [0, 1]);
    }
    functions.copy(first, other);
    functions.refuse_misuse(first);
    if STEPS_ARMS {
        assert_eq!(step(first, &dark(33_333)), step(other, &dark(33_333)));
        functions.reset(first);
    }
}

/// Points on the front of a trunk and two hanging arms, two metres away.
fn body_points(shift_m: f32) -> Vec<[f32; 3]> {
    let trunk = (0..60).map(|i| [0.02 * (i % 10) as f32 - 0.09, 0.08 * (i / 10) as f32, 1.88]);
    let arm = |side: f32| (0..40).map(move |i| [side * 0.21, 0.02 + 0.014 * i as f32, 1.96]);
    let all = trunk.chain(arm(1.0)).chain(arm(-1.0));
    all.map(|[x, y, z]| [x + shift_m, y, z]).collect()
}

#[test]
fn a_body_tracker_goes_on_from_its_state() {
    let functions = StateFunctions { save: sinew_body_save, restore: sinew_body_restore, reset: sinew_body_reset };
    // SAFETY: there is room for one.
    let config = written(|config: *mut SinewBodyConfig| unsafe {
        sinew_body_default_config(2.0, config, size_of::<SinewBodyConfig>())
    });
    let init = |memory: &mut Memory| {
        // SAFETY: the memory has the size that is said.
        written(|handle| unsafe { sinew_body_init(memory.start(), memory.bytes(), &raw const config, handle) })
    };
    let step = |tracker: *mut SinewBody, timestamp_us: u64, points_m: &mut [[f32; 3]]| {
        let (points_m, point_count) = (points_m.as_mut_ptr(), points_m.len() as u32);
        let frame = SinewBodyFrame { timestamp_us, points_m, point_count, reserved: 0 };
        let mut result = MaybeUninit::uninit();
        // SAFETY: the tracker was initialised, the points are there.
        let status = unsafe { sinew_body_step(tracker, &raw const frame, result.as_mut_ptr()) };
        // SAFETY: the status says that it was written.
        if status == SinewStatus::Ok { Ok::<SinewBodyResult, _>(unsafe { result.assume_init() }) } else { Err(status) }
    };
    let mut memories = [Memory::new(sinew_body_size()), Memory::new(sinew_body_size())];
    let [first, other] = memories.each_mut().map(init);
    let steps = if cfg!(miri) { 1 } else { 6 };
    for frame in 0..steps {
        let mut points_m = body_points(0.01 * frame as f32);
        points_m.push([f32::NAN, 0.0, 1.0]);
        let result = step(first, 66_667 * frame, &mut points_m).unwrap();
        assert_eq!((result.state, result.used_points, result.left_out_points), (SINEW_BODY_TRACKING, 140, 1));
        // The trunk.
        assert_eq!(result.observed >> 1 & 1, 1, "{result:?}");
    }
    functions.copy(first, other);
    functions.refuse_misuse(first);
    let next_us = 66_667 * steps;
    assert_eq!(step(first, next_us, &mut body_points(0.05)), step(other, next_us, &mut body_points(0.05)));
    assert_eq!(step(first, next_us, &mut []), Err(SinewStatus::OutOfOrder));
    let dark = step(first, next_us + 1, &mut []).unwrap();
    assert_eq!((dark.state, dark.observed), (SINEW_BODY_PREDICTED, 0));
    functions.reset(first);
    assert!(step(first, 0, &mut body_points(0.0)).is_ok());
}

#[test]
fn options_of_the_body_are_checked() {
    type Change = fn(&mut SinewBodyConfig);
    // SAFETY: there is room for one.
    let config = written(|config: *mut SinewBodyConfig| unsafe {
        sinew_body_default_config(2.0, config, size_of::<SinewBodyConfig>())
    });
    let changes: [(Change, SinewStatus); 10] = [
        (|config| config.struct_bytes -= 4, SinewStatus::StructSize),
        (|config| config.solver_steps = 0, SinewStatus::OutOfRange),
        (|config| config.height_m = 3.0, SinewStatus::OutOfRange),
        (|config| config.point_std_m = 0.0, SinewStatus::OutOfRange),
        (|config| config.outlier_m = f32::NAN, SinewStatus::NotFinite),
        (|config| config.root_shift_std_m_per_sqrt_s = -1.0, SinewStatus::OutOfRange),
        (|config| config.root_turn_std_rad_per_sqrt_s = 0.0, SinewStatus::OutOfRange),
        (|config| config.jitter_std_m = -0.1, SinewStatus::OutOfRange),
        (|config| config.first_coordinates[16] = f32::INFINITY, SinewStatus::NotFinite),
        (|config| config.reserved = 1, SinewStatus::OutOfRange),
    ];
    let mut memory = Memory::new(sinew_body_size());
    for (change, expected) in changes {
        let mut wrong = config;
        change(&mut wrong);
        let mut handle = null_mut();
        // SAFETY: the memory has the size that is said.
        let status = unsafe { sinew_body_init(memory.start(), memory.bytes(), &raw const wrong, &raw mut handle) };
        assert_eq!((status, handle), (expected, null_mut()), "{wrong:?}");
    }
}

const SKIN: u16 = 0xcc6c;
const WALL: u16 = 0x39c7;
/// Sides of the frames, pixels.
const WIDTH_PX: u32 = 48;
const HEIGHT_PX: u32 = 24;

/// Reads a frame with a hand whose left edge lies at `left_px`; numbers of candidates and edges.
pub(super) fn see(vision: *mut SinewVision, left_px: usize) -> (usize, usize) {
    // SAFETY: the front end was initialised, and the lists of its result are there until the next
    // frame.
    unsafe {
        assert_eq!(sinew_vision_begin_frame(vision), SinewStatus::Ok);
        for row in 0..HEIGHT_PX {
            let mut line = [WALL; WIDTH_PX as usize];
            if (4..20).contains(&row) {
                line[left_px..left_px + 20].fill(SKIN);
            }
            assert_eq!(sinew_vision_line(vision, row, line.as_ptr(), line.len()), SinewStatus::Ok);
        }
        let result = written(|result: *mut SinewVisionResult| sinew_vision_end_frame(vision, result));
        let (candidates, edges) = (result.candidate_count as usize, result.edge_count as usize);
        for index in 0..candidates {
            assert!((*result.candidates.add(index)).area_px > 0.0);
        }
        for index in 0..edges {
            assert!(u32::from((*result.edges.add(index)).u) < WIDTH_PX);
        }
        (candidates, edges)
    }
}

#[test]
fn a_front_end_goes_on_from_its_state() {
    let functions =
        StateFunctions { save: sinew_vision_save, restore: sinew_vision_restore, reset: sinew_vision_reset };
    // SAFETY: there is room for one.
    let config = written(|config| unsafe { sinew_vision_default_config(config, size_of::<SinewVisionConfig>()) });
    let config = SinewVisionConfig { width_px: WIDTH_PX, height_px: HEIGHT_PX, ..config };
    let init = |memory: &mut Memory| {
        // SAFETY: the memory has the size that is said.
        written(|handle| unsafe { sinew_vision_init(memory.start(), memory.bytes(), &raw const config, handle) })
    };
    let mut memories = [Memory::new(sinew_vision_size()), Memory::new(sinew_vision_size())];
    let [first, other] = memories.each_mut().map(init);
    assert_eq!(see(first, 10).0, 1);
    let box_px = SinewBox { left_px: 16, top_px: 12, width_px: 2, height_px: 2 };
    // SAFETY: the front end was initialised, and the box is there.
    assert_eq!(unsafe { sinew_vision_begin_calibration(first, &raw const box_px) }, SinewStatus::Ok);
    assert!(see(first, 14).1 > 0);
    // SAFETY: the front end was initialised; the skin may be null.
    assert_eq!(unsafe { sinew_vision_end_calibration(first, null_mut()) }, SinewStatus::Ok);
    functions.copy(first, other);
    functions.refuse_misuse(first);
    functions.reset(first);
    assert_eq!(see(other, 10).0, 1);
}
