//! The cyclic particle filter.

use super::saved::{Damage, damage};
use super::{Memory, cases, is_finite, is_refusal, mostly, real};
use proptest::prelude::*;
use sinew_core::c_api::cyclic_frame::{SINEW_MAX_ANGLES, SinewCyclicFrame, SinewCyclicResult};
use sinew_core::c_api::cyclic_particles::*;
use sinew_core::c_api::cyclic_particles_config::*;
use sinew_core::c_api::status::SinewStatus;
use std::mem::MaybeUninit;
use std::ptr::{null, null_mut};

#[derive(Debug, Clone)]
enum Call {
    Step { after_us: i64, seen: u32, angles: [f32; SINEW_MAX_ANGLES], std: f32 },
    Restore(Damage),
    Reset,
}

fn call() -> impl Strategy<Value = Call> {
    let after_us = prop_oneof![8 => 1_i64..100_000, 1 => -100_000_i64..=0, 1 => 0_i64..1_000_000];
    let seen = prop_oneof![8 => 0_u32..1 << 13, 1 => any::<u32>()];
    let angles = prop::array::uniform13(prop_oneof![60 => -3.0_f32..3.0, 1 => real()]);
    prop_oneof![
        6 => (after_us, seen, angles, mostly(0.01..1.0))
            .prop_map(|(after_us, seen, angles, std)| Call::Step { after_us, seen, angles, std }),
        3 => damage().prop_map(Call::Restore),
        1 => Just(Call::Reset),
    ]
}

/// Any number for an option, most of them legal.
fn option() -> impl Strategy<Value = f32> {
    prop_oneof![6 => 0.0_f32..0.1, 2 => Just(0.0), 1 => 0.0_f32..10.0, 1 => real()]
}

fn config() -> impl Strategy<Value = SinewCyclicParticlesConfig> {
    let particles = prop_oneof![8 => 1_u32..=100, 1 => Just(0), 1 => any::<u32>()];
    (particles, any::<u64>(), 0_u32..3, prop::array::uniform7(option())).prop_map(
        |(particles, seed, known, options)| {
            let [position, cadence, angle, share, position_std, velocity, acceleration] = options;
            SinewCyclicParticlesConfig {
                struct_bytes: size_of::<SinewCyclicParticlesConfig>() as u32,
                particles,
                seed,
                has_first_position: known,
                first_position: position,
                first_cadence_per_min: 100.0 * cadence,
                first_angle_std_rad: angle,
                first_velocity_share: share,
                first_position_std: position_std,
                first_cycle_velocity_std: velocity,
                cycle_acceleration_std: acceleration,
            }
        },
    )
}

struct Tracker {
    handle: *mut SinewCyclicParticles,
    now_us: u64,
    /// Whether a forged state was restored, whose numbers are legal each and yet may lead anywhere.
    is_forged: bool,
    _memory: Memory,
}

impl Tracker {
    fn new(config: *const SinewCyclicParticlesConfig) -> Result<Self, SinewStatus> {
        let mut memory = Memory::new(SINEW_CYCLIC_PARTICLES_MAX_BYTES);
        let (start, mut handle) = (memory.start(), null_mut());
        // SAFETY: the memory is as large as is said, and the options are there or null.
        let status = unsafe {
            let bytes = SINEW_CYCLIC_PARTICLES_MAX_BYTES;
            sinew_cyclic_particles_init(start, bytes, null(), 0, config, &raw mut handle)
        };
        let tracker = Self { handle, now_us: 0, is_forged: false, _memory: memory };
        if status == SinewStatus::Ok { Ok(tracker) } else { Err(status) }
    }

    fn saved(&self) -> Vec<u8> {
        let (mut bytes, mut written) = (vec![0; SINEW_CYCLIC_PARTICLES_STATE_MAX_BYTES], 0);
        // SAFETY: the buffer is as large as is said.
        let status =
            unsafe { sinew_cyclic_particles_save(self.handle, bytes.as_mut_ptr(), bytes.len(), &raw mut written) };
        assert_eq!(status, SinewStatus::Ok);
        bytes.truncate(written);
        bytes
    }

    fn step(&mut self, frame: &SinewCyclicFrame) -> SinewStatus {
        let before = self.saved();
        let mut result = MaybeUninit::<SinewCyclicResult>::uninit();
        // SAFETY: frame and room for a result are there.
        let status = unsafe { sinew_cyclic_particles_step(self.handle, frame, result.as_mut_ptr()) };
        if status != SinewStatus::Ok {
            assert!(is_refusal(status), "{status:?}");
            assert_eq!(self.saved(), before, "{status:?} changed the filter");
            return status;
        }
        // SAFETY: the status says that it was written.
        let result = unsafe { result.assume_init() };
        self.now_us = frame.timestamp_us;
        if !self.is_forged {
            assert!(is_finite(&result.angles_rad) && is_finite(&result.angle_std_rad), "{result:?}");
            assert!(
                is_finite(&[result.cadence_per_min, result.cycle_position_std, result.log_likelihood]),
                "{result:?}"
            );
            assert!((0.0..1.0).contains(&result.cycle_position), "{result:?}");
        }
        status
    }

    fn call(&mut self, call: &Call) {
        match call {
            Call::Step { after_us, seen, angles, std } => {
                let frame = SinewCyclicFrame {
                    timestamp_us: self.now_us.saturating_add_signed(*after_us),
                    seen: *seen,
                    angle_count: 13,
                    angles_rad: *angles,
                    std_rad: [*std; SINEW_MAX_ANGLES],
                };
                self.step(&frame);
            }
            Call::Restore(damage) => self.restore(damage),
            Call::Reset => {
                // SAFETY: the filter was initialised.
                assert_eq!(unsafe { sinew_cyclic_particles_reset(self.handle) }, SinewStatus::Ok);
                self.is_forged = false;
                self.now_us = 0;
            }
        }
    }

    fn restore(&mut self, damage: &Damage) {
        let before = self.saved();
        let bytes = damage.applied(&before);
        // SAFETY: the bytes are there.
        let status = unsafe { sinew_cyclic_particles_restore(self.handle, bytes.as_ptr(), bytes.len()) };
        // What a forged state led to may itself be no state.
        let is_lost = self.is_forged && status == SinewStatus::BadState;
        assert!(damage.allows(status) || is_lost, "{damage:?}: {status:?}");
        if matches!(damage, Damage::Forged { .. }) || is_lost {
            self.is_forged |= status == SinewStatus::Ok;
            self.now_us = u64::from_le_bytes(self.saved()[16..24].try_into().unwrap());
        } else {
            assert_eq!(self.saved(), before, "{damage:?}");
        }
    }
}

proptest! {
    #![proptest_config(cases(24))]

    #[test]
    fn any_calls_leave_a_filter_that_can_be_used(config in config(), calls in prop::collection::vec(call(), 1..20)) {
        let mut tracker = match Tracker::new(&raw const config) {
            Ok(tracker) => tracker,
            Err(status) => {
                prop_assert!(matches!(
                    status,
                    SinewStatus::OutOfRange | SinewStatus::OverCapacity | SinewStatus::NotFinite
                ));
                Tracker::new(null()).unwrap()
            }
        };
        for call in &calls {
            tracker.call(call);
        }
        tracker.call(&Call::Reset);
        tracker.call(&Call::Step { after_us: 1, seen: 0x1fff, angles: [0.1; SINEW_MAX_ANGLES], std: 0.1 });
    }
}
