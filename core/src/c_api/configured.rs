//! What the options of configurations change, and which are refused.

use super::arm::{SinewArm, sinew_arm_init, sinew_arm_restore, sinew_arm_save, sinew_arm_size, sinew_arm_step};
use super::arm_config::{SINEW_ARM_BOOTSTRAP, SINEW_ARM_STANDARD, SinewArmConfig, sinew_arm_default_config};
use super::arm_frame::{SINEW_ARM_PARTICLES, SINEW_SIDE_LEFT, SinewArmResult};
use super::clock::{SinewClock, sinew_clock_us};
use super::cyclic::{SinewCyclic, sinew_cyclic_init, sinew_cyclic_size, sinew_cyclic_step};
use super::cyclic_config::{SinewCyclicConfig, sinew_cyclic_default_config};
use super::cyclic_frame::SinewCyclicResult;
use super::cyclic_particles::{sinew_cyclic_particles_init, sinew_cyclic_particles_size, sinew_cyclic_particles_step};
use super::cyclic_particles_config::{SinewCyclicParticlesConfig, sinew_cyclic_particles_default_config};
use super::every_object::{Memory, written};
use super::status::SinewStatus;
use super::tests::{arm_config, arm_frame, arm_lists, model, see, swing};
use super::vision::{
    SINEW_VISION_STATE_MAX_BYTES, SinewVision, sinew_vision_init, sinew_vision_learn_skin, sinew_vision_restore,
    sinew_vision_save, sinew_vision_size,
};
use super::vision_frame::{SinewSkin, SinewVisionConfig, sinew_vision_default_config};
use core::ptr::null_mut;

struct Arm {
    _memory: Memory,
    tracker: *mut SinewArm,
}

impl Arm {
    fn new(config: &SinewArmConfig) -> Result<Self, SinewStatus> {
        let mut memory = Memory::new(sinew_arm_size());
        let mut tracker = null_mut();
        let (start, bytes) = (memory.start(), memory.bytes());
        // SAFETY: that much memory is there.
        match unsafe { sinew_arm_init(start, bytes, config, SINEW_SIDE_LEFT, &raw mut tracker) } {
            SinewStatus::Ok => Ok(Self { _memory: memory, tracker }),
            refused => Err(refused),
        }
    }

    /// After three frames with a hand.
    fn result(&self) -> SinewArmResult {
        let lists = arm_lists();
        let step = |frame: u64| {
            let frame = arm_frame(33_333 * frame, &lists);
            // SAFETY: the tracker was initialised, the lists are there.
            written(|result| unsafe { sinew_arm_step(self.tracker, &raw const frame, result) })
        };
        step(0);
        step(1);
        step(2)
    }

    fn state(&self) -> Vec<u8> {
        let mut state = vec![0; 4096];
        // SAFETY: the tracker was initialised, the buffer has the size that is said.
        let bytes = written(|bytes| unsafe { sinew_arm_save(self.tracker, state.as_mut_ptr(), state.len(), bytes) });
        state.truncate(bytes);
        state
    }

    fn restore(&self, state: &[u8]) -> SinewStatus {
        // SAFETY: the tracker was initialised, the state is there.
        unsafe { sinew_arm_restore(self.tracker, state.as_ptr(), state.len()) }
    }
}

fn refusal(config: &SinewArmConfig) -> SinewStatus {
    Arm::new(config).err().unwrap_or(SinewStatus::Ok)
}

#[test]
fn a_structure_of_another_size_is_refused() {
    let mut config = arm_config();
    let bytes = size_of::<SinewArmConfig>();
    for wrong in [0, 1, bytes - 4, bytes + 4] {
        // SAFETY: there is room for one.
        let status = unsafe { sinew_arm_default_config(320, 240, 1.0, &raw mut config, wrong) };
        assert_eq!(status, SinewStatus::StructSize);
        assert_eq!(refusal(&SinewArmConfig { struct_bytes: wrong as u32, ..config }), SinewStatus::StructSize);
    }
    assert_eq!(config, arm_config(), "nothing was written");
    let mut memory = Memory::new(sinew_vision_size());
    // SAFETY: there is room for one.
    let vision = written(|config| unsafe { sinew_vision_default_config(config, size_of::<SinewVisionConfig>()) });
    let vision = SinewVisionConfig { struct_bytes: 40, ..vision };
    // SAFETY: that much memory is there.
    let status = unsafe { sinew_vision_init(memory.start(), memory.bytes(), &raw const vision, &mut null_mut()) };
    assert_eq!(status, SinewStatus::StructSize);
}

#[test]
fn options_of_the_arm_are_checked() {
    let config = arm_config();
    assert_eq!(refusal(&config), SinewStatus::Ok);
    assert_eq!(refusal(&SinewArmConfig { particles: 51, ..config }), SinewStatus::OverCapacity);
    for wrong in [
        SinewArmConfig { particles: 0, ..config },
        SinewArmConfig { variant: SINEW_ARM_STANDARD + 1, ..config },
        SinewArmConfig { max_pairs: 9, ..config },
        SinewArmConfig { max_pairs: 65_536, ..config },
        SinewArmConfig { solver_steps: 101, ..config },
        SinewArmConfig { has_guessed_shoulders: 2, ..config },
        SinewArmConfig { hand_std_m_per_sqrt_s: 0.0, ..config },
        SinewArmConfig { ray_std_m_per_sqrt_s: -1.0, ..config },
        SinewArmConfig { angle_std_rad_per_sqrt_s: 0.0, ..config },
        SinewArmConfig { hand_area_m2: 0.0, ..config },
        SinewArmConfig { area_log_std: 0.0, ..config },
        SinewArmConfig { gate_std_m: 0.0, ..config },
        SinewArmConfig { gate_growth_m_per_s: -1.0, ..config },
        SinewArmConfig { gate_floor: 0.0, ..config },
        SinewArmConfig { lost_after_s: 0.0, ..config },
        SinewArmConfig { reserved: 1, ..config },
    ] {
        assert_eq!(refusal(&wrong), SinewStatus::OutOfRange, "{wrong:?}");
    }
    let wrong = SinewArmConfig { hand_std_m_per_sqrt_s: f32::NAN, ..config };
    assert_eq!(refusal(&wrong), SinewStatus::NotFinite);
}

#[test]
#[cfg_attr(miri, ignore = "steps of an arm tracker take minutes")]
fn each_option_of_the_arm_changes_what_it_is_for() {
    let config = arm_config();
    let full = Arm::new(&config).unwrap().result();
    assert!(full.effective_sample_size > 20.0 && full.effective_sample_size <= SINEW_ARM_PARTICLES as f32);
    let few = Arm::new(&SinewArmConfig { particles: 20, ..config }).unwrap().result();
    assert!(few.effective_sample_size <= 20.0, "{few:?}");
    for other in [
        SinewArmConfig { variant: SINEW_ARM_BOOTSTRAP, ..config },
        SinewArmConfig { solver_steps: 1, ..config },
        SinewArmConfig { has_guessed_shoulders: 1, ..config },
        SinewArmConfig { hand_std_m_per_sqrt_s: 0.3, ..config },
        SinewArmConfig { ray_std_m_per_sqrt_s: 0.5, ..config },
        SinewArmConfig { angle_std_rad_per_sqrt_s: 0.2, ..config },
        SinewArmConfig { hand_area_m2: 0.01, ..config },
        SinewArmConfig { area_log_std: 1.0, ..config },
        SinewArmConfig { gate_std_m: 0.1, ..config },
        SinewArmConfig { gate_floor: 0.5, ..config },
    ] {
        assert_ne!(Arm::new(&other).unwrap().result(), full, "{other:?}");
    }
}

#[test]
fn a_state_belongs_to_its_options() {
    let config = arm_config();
    let state = Arm::new(&config).unwrap().state();
    for other in [
        SinewArmConfig { particles: 49, ..config },
        SinewArmConfig { variant: SINEW_ARM_STANDARD, ..config },
        SinewArmConfig { max_pairs: 200, ..config },
        SinewArmConfig { solver_steps: 3, ..config },
        SinewArmConfig { gate_growth_m_per_s: 2.0, ..config },
        SinewArmConfig { lost_after_s: 2.0, ..config },
    ] {
        assert_eq!(Arm::new(&other).unwrap().restore(&state), SinewStatus::ForeignState, "{other:?}");
    }
    let other = SinewArmConfig { seed: 9, shoulders_m: [[0.2, 0.0, 1.5]; 2], ..config };
    assert_eq!(Arm::new(&other).unwrap().restore(&state), SinewStatus::Ok);
}

/// A front end with other options than the defaults.
fn front_end(change: impl Fn(&mut SinewVisionConfig)) -> Result<(Memory, *mut SinewVision), SinewStatus> {
    // SAFETY: there is room for one.
    let mut config = written(|config| unsafe { sinew_vision_default_config(config, size_of::<SinewVisionConfig>()) });
    (config.width_px, config.height_px) = (48, 24);
    change(&mut config);
    let (mut memory, mut vision) = (Memory::new(sinew_vision_size()), null_mut());
    // SAFETY: that much memory is there.
    match unsafe { sinew_vision_init(memory.start(), memory.bytes(), &raw const config, &raw mut vision) } {
        SinewStatus::Ok => Ok((memory, vision)),
        refused => Err(refused),
    }
}

#[test]
fn options_of_the_front_end_are_checked_and_count() {
    for wrong in [
        |config: &mut SinewVisionConfig| config.new_step = 256.0,
        |config: &mut SinewVisionConfig| config.known_step = config.new_step + 1.0,
        |config: &mut SinewVisionConfig| config.min_area_share = 1.5,
        |config: &mut SinewVisionConfig| config.min_area_share = -0.1,
    ] {
        assert_eq!(front_end(wrong).err(), Some(SinewStatus::OutOfRange));
    }
    let (_memory, vision) = front_end(|_| ()).unwrap();
    assert_eq!(see(vision, 10).0, 1);
    assert!(see(vision, 14).1 > 0);
    let (_memory, blind) = front_end(|config| (config.min_area_share, config.new_step) = (0.9, 255.0)).unwrap();
    assert_eq!([see(blind, 10), see(blind, 14)], [(0, 0); 2]);
}

/// The saved state of a front end.
fn saved(vision: *mut SinewVision) -> Vec<u8> {
    let (mut bytes, mut written) = (vec![0; SINEW_VISION_STATE_MAX_BYTES], 0);
    // SAFETY: the front end was initialised, the buffer is as large as is said.
    let status = unsafe { sinew_vision_save(vision, bytes.as_mut_ptr(), bytes.len(), &raw mut written) };
    assert_eq!(status, SinewStatus::Ok);
    bytes.truncate(written);
    bytes
}

#[test]
#[cfg_attr(miri, ignore = "a whole table takes a minute")]
fn another_skin_is_learned_at_once_or_frame_by_frame() {
    // Green skin: the hand of `see` is none.
    let green = SinewSkin { mean: [0.2, 0.6], covariance: [1e-3, 0.0, 1e-3], threshold: 2.0, min_sum: 100 };
    let learn = |per_frame| {
        let (memory, vision) = front_end(|config| config.skin_colours_per_frame = per_frame).unwrap();
        assert_eq!(see(vision, 10).0, 1);
        // SAFETY: the front end was initialised, the skin is there.
        assert_eq!(unsafe { sinew_vision_learn_skin(vision, &raw const green) }, SinewStatus::Ok);
        (memory, vision)
    };
    let frames_with_hand = |vision| (0..100).take_while(|_| see(vision, 10).0 == 1).count();
    let (_memory, at_once) = learn(0);
    assert_eq!(frames_with_hand(at_once), 0);
    // 64 frames judge all 65536 colours, in the order of their numbers; the hand's is a late one.
    let (_memory, vision) = learn(1024);
    let frames = frames_with_hand(vision);
    assert!((32..64).contains(&frames), "{frames}");
    let state = saved(vision);
    assert!(state == saved(at_once), "both learned the same");
    // A state that is saved before the end is that of the end.
    let (_memory, vision) = learn(1024);
    assert_eq!(see(vision, 10).0, 1);
    assert!(saved(vision) == state);
    assert_eq!(see(vision, 10).0, 0);
    // A state that is restored ends what was being learned.
    let (_memory, other) = front_end(|config| config.skin_colours_per_frame = 1024).unwrap();
    let before = saved(other);
    // SAFETY: the front end was initialised, skin and state are there.
    unsafe {
        assert_eq!(sinew_vision_learn_skin(other, &raw const green), SinewStatus::Ok);
        assert_eq!(sinew_vision_restore(other, before.as_ptr(), before.len()), SinewStatus::Ok);
    }
    assert_eq!(frames_with_hand(other), 100);
}

struct Walker {
    _memory: Memory,
    _model: Vec<u32>,
    tracker: *mut SinewCyclic,
}

impl Walker {
    fn new(change: impl Fn(&mut SinewCyclicConfig)) -> Result<Self, SinewStatus> {
        // SAFETY: there is room for one.
        let mut config =
            written(|config| unsafe { sinew_cyclic_default_config(config, size_of::<SinewCyclicConfig>()) });
        change(&mut config);
        let ((model, bytes), mut memory) = (model(), Memory::new(sinew_cyclic_size()));
        let (start, size, mut tracker) = (memory.start(), memory.bytes(), null_mut());
        // SAFETY: memory and model have the sizes that are said.
        let status = unsafe {
            sinew_cyclic_init(start, size, model.as_ptr().cast(), bytes, &raw const config, &raw mut tracker)
        };
        if status == SinewStatus::Ok { Ok(Self { _memory: memory, _model: model, tracker }) } else { Err(status) }
    }

    fn step(&self, swing_us: u64, timestamp_us: u64) -> SinewCyclicResult {
        let mut frame = swing(swing_us, 0b11);
        frame.timestamp_us = timestamp_us;
        // SAFETY: the tracker was initialised.
        written(|result| unsafe { sinew_cyclic_step(self.tracker, &raw const frame, result) })
    }
}

#[test]
fn the_first_position_and_cadence_can_be_given() {
    for wrong in [
        |config: &mut SinewCyclicConfig| config.has_first_position = 2,
        |config: &mut SinewCyclicConfig| (config.has_first_position, config.first_position) = (1, 1.5),
        |config: &mut SinewCyclicConfig| config.first_cadence_per_min = -1.0,
        |config: &mut SinewCyclicConfig| config.first_cadence_per_min = 1.0e6,
    ] {
        assert_eq!(Walker::new(wrong).err(), Some(SinewStatus::OutOfRange));
    }
    assert_eq!(Walker::new(|config| config.struct_bytes -= 1).err(), Some(SinewStatus::StructSize));
    let given = Walker::new(|config| {
        (config.has_first_position, config.first_position, config.first_cadence_per_min) = (1, 0.25, 42.0);
    })
    .unwrap();
    let first = given.step(0, 0);
    assert!((first.cycle_position - 0.25).abs() < 0.05, "{first:?}");
    assert!((first.cadence_per_min - 42.0).abs() < 3.0, "{first:?}");
}

/// A counter of 32 bits wraps in the middle of a walk, and nothing but the timestamps shows it.
#[test]
fn a_walk_goes_on_where_the_counter_wraps() {
    let [steady, wrapping] = [(); 2].map(|()| Walker::new(|_| ()).unwrap());
    let mut clock = SinewClock::default();
    let begun_us = u32::MAX - 300_000;
    let frames = if cfg!(miri) { 20 } else { 120 };
    for frame in 0..frames {
        let elapsed_us = 16_667 * frame;
        let counter_us = begun_us.wrapping_add(elapsed_us);
        // SAFETY: both are there.
        let time_us = written(|time| unsafe { sinew_clock_us(&raw mut clock, counter_us, time) });
        let expected = steady.step(elapsed_us.into(), elapsed_us.into());
        let result = wrapping.step(elapsed_us.into(), time_us);
        assert_eq!(SinewCyclicResult { timestamp_us: expected.timestamp_us, ..result }, expected, "{frame}");
    }
    assert!(clock.counter_us < begun_us, "it wrapped");
}

/// A particle filter of a walk of a second and a half, or why it is refused.
fn particles(change: impl Fn(&mut SinewCyclicParticlesConfig)) -> Result<SinewCyclicResult, SinewStatus> {
    // SAFETY: there is room for one.
    let mut config = written(|config| unsafe {
        sinew_cyclic_particles_default_config(config, size_of::<SinewCyclicParticlesConfig>())
    });
    change(&mut config);
    let ((model, bytes), mut memory) = (model(), Memory::new(sinew_cyclic_particles_size()));
    let (start, size, mut tracker) = (memory.start(), memory.bytes(), null_mut());
    // SAFETY: memory and model have the sizes that are said.
    let status = unsafe {
        let model = model.as_ptr().cast();
        sinew_cyclic_particles_init(start, size, model, bytes, &raw const config, &raw mut tracker)
    };
    if status != SinewStatus::Ok {
        return Err(status);
    }
    let mut last = None;
    for frame in 0..if cfg!(miri) { 2 } else { 90 } {
        // SAFETY: the tracker was initialised.
        last = Some(written(|result| unsafe {
            sinew_cyclic_particles_step(tracker, &swing(16_667 * frame, 0b11), result)
        }));
    }
    Ok(last.unwrap())
}

#[test]
fn options_of_the_cyclic_particle_filter_are_checked_and_count() {
    type Change = fn(&mut SinewCyclicParticlesConfig);
    let refused: [(Change, SinewStatus); 10] = [
        (|config| config.struct_bytes += 4, SinewStatus::StructSize),
        (|config| config.particles = 0, SinewStatus::OutOfRange),
        (|config| config.particles = 101, SinewStatus::OverCapacity),
        (|config| config.has_first_position = 2, SinewStatus::OutOfRange),
        (|config| config.first_cadence_per_min = -1.0, SinewStatus::OutOfRange),
        (|config| config.first_angle_std_rad = -0.1, SinewStatus::OutOfRange),
        (|config| config.first_velocity_share = 11.0, SinewStatus::OutOfRange),
        (|config| config.first_position_std = f32::NAN, SinewStatus::NotFinite),
        (|config| config.first_cycle_velocity_std = 0.6, SinewStatus::OutOfRange),
        (|config| config.cycle_acceleration_std = 0.2, SinewStatus::OutOfRange),
    ];
    for (change, status) in refused {
        assert_eq!(particles(change).err(), Some(status));
    }
    if cfg!(miri) {
        return;
    }
    let usual = particles(|_| ()).unwrap();
    // The model's mean cadence is a cycle a second: half a cycle after the first.
    assert_eq!(usual.cycles_completed, 1);
    assert!((usual.cycle_position - 0.483).abs() < 0.05, "{usual:?}");
    let changes: [Change; 8] = [
        |config| config.particles = 60,
        |config| config.seed = 2,
        |config| config.has_first_position = 1,
        |config| config.first_cadence_per_min = 66.0,
        |config| config.first_angle_std_rad = 0.1,
        |config| config.first_velocity_share = 2.0,
        |config| config.first_cycle_velocity_std = 0.01,
        |config| config.cycle_acceleration_std = 1.0e-4,
    ];
    for change in changes {
        assert_ne!(particles(change).unwrap(), usual);
    }
    let known = |std| particles(|config| (config.has_first_position, config.first_position_std) = (1, std)).unwrap();
    assert_ne!(known(0.1), known(0.03));
}
