//! The body tracker.

use super::saved::{Damage, damage};
use super::{Memory, cases, is_finite, is_refusal, real};
use proptest::prelude::*;
use sinew_core::c_api::body::*;
use sinew_core::c_api::body_config::*;
use sinew_core::c_api::body_frame::*;
use sinew_core::c_api::status::SinewStatus;
use std::mem::MaybeUninit;
use std::ptr::null_mut;

#[derive(Debug, Clone)]
enum Call {
    Step { after_us: i64, points_m: Vec<[f32; 3]> },
    Restore(Damage),
    Reset,
}

fn call() -> impl Strategy<Value = Call> {
    let after_us = prop_oneof![8 => 1_i64..200_000, 1 => -100_000_i64..=0, 1 => 0_i64..1_000_000_000_000];
    // About the body, or anywhere.
    let near = (-0.5_f32..0.5, -0.3_f32..0.8, 1.5_f32..2.5).prop_map(|(x, y, z)| [x, y, z]);
    let point = prop_oneof![20 => near, 1 => prop::array::uniform3(real())];
    prop_oneof![
        6 => (after_us, prop::collection::vec(point, 0..120))
            .prop_map(|(after_us, points_m)| Call::Step { after_us, points_m }),
        2 => damage().prop_map(Call::Restore),
        1 => Just(Call::Reset),
    ]
}

fn default_config() -> SinewBodyConfig {
    let mut config = MaybeUninit::uninit();
    // SAFETY: there is room for one.
    let status = unsafe { sinew_body_default_config(2.0, config.as_mut_ptr(), size_of::<SinewBodyConfig>()) };
    assert_eq!(status, SinewStatus::Ok);
    // SAFETY: the status says that it was written.
    unsafe { config.assume_init() }
}

fn config() -> impl Strategy<Value = SinewBodyConfig> {
    let option = || prop_oneof![6 => 0.001_f32..1.0, 1 => real()];
    let options = (option(), option(), option(), option(), option());
    (0_u32..22, 0.4_f32..2.6, options, prop::array::uniform17(prop_oneof![9 => -0.5_f32..0.5, 1 => real()])).prop_map(
        |(solver_steps, height_m, (point, outlier, shift, turn, jitter), mut first_coordinates)| {
            first_coordinates[2] += 2.0;
            SinewBodyConfig {
                solver_steps,
                height_m,
                point_std_m: point,
                outlier_m: outlier,
                root_shift_std_m_per_sqrt_s: shift,
                root_turn_std_rad_per_sqrt_s: turn,
                jitter_std_m: jitter,
                first_coordinates,
                ..default_config()
            }
        },
    )
}

struct Tracker {
    handle: *mut SinewBody,
    now_us: u64,
    /// Whether a forged state was restored, whose numbers are legal each and yet may lead anywhere.
    is_forged: bool,
    _memory: Memory,
}

impl Tracker {
    fn new(config: &SinewBodyConfig) -> Result<Self, SinewStatus> {
        let mut memory = Memory::new(SINEW_BODY_MAX_BYTES);
        let (start, mut handle) = (memory.start(), null_mut());
        // SAFETY: the memory is as large as is said.
        let status = unsafe { sinew_body_init(start, SINEW_BODY_MAX_BYTES, config, &raw mut handle) };
        let tracker = Self { handle, now_us: 0, is_forged: false, _memory: memory };
        if status == SinewStatus::Ok { Ok(tracker) } else { Err(status) }
    }

    fn saved(&self) -> Vec<u8> {
        let (mut bytes, mut written) = (vec![0; SINEW_BODY_STATE_MAX_BYTES], 0);
        // SAFETY: the buffer is as large as is said.
        let status = unsafe { sinew_body_save(self.handle, bytes.as_mut_ptr(), bytes.len(), &raw mut written) };
        assert_eq!(status, SinewStatus::Ok);
        bytes.truncate(written);
        bytes
    }

    fn step(&mut self, timestamp_us: u64, points_m: &mut [[f32; 3]]) {
        let before = self.saved();
        let (points_m, point_count) = (points_m.as_mut_ptr(), points_m.len() as u32);
        let frame = SinewBodyFrame { timestamp_us, points_m, point_count, reserved: 0 };
        let mut result = MaybeUninit::<SinewBodyResult>::uninit();
        // SAFETY: the points are there, and room for a result.
        let status = unsafe { sinew_body_step(self.handle, &raw const frame, result.as_mut_ptr()) };
        if status != SinewStatus::Ok {
            assert!(is_refusal(status), "{status:?}");
            assert_eq!(self.saved(), before, "{status:?} changed the tracker");
            return;
        }
        // SAFETY: the status says that it was written.
        let result = unsafe { result.assume_init() };
        self.now_us = timestamp_us;
        if !self.is_forged {
            assert!(is_finite(&result.coordinates) && is_finite(result.joints_m.as_flattened()), "{result:?}");
            assert!(is_finite(&result.joint_std_m), "{result:?}");
        }
        assert_eq!(result.used_points + result.left_out_points, point_count);
    }

    fn call(&mut self, call: &Call) {
        match call {
            Call::Step { after_us, points_m } => {
                self.step(self.now_us.saturating_add_signed(*after_us), &mut points_m.clone());
            }
            Call::Restore(damage) => self.restore(damage),
            Call::Reset => {
                // SAFETY: the tracker was initialised.
                assert_eq!(unsafe { sinew_body_reset(self.handle) }, SinewStatus::Ok);
                (self.is_forged, self.now_us) = (false, 0);
            }
        }
    }

    fn restore(&mut self, damage: &Damage) {
        let before = self.saved();
        let bytes = damage.applied(&before);
        // SAFETY: the bytes are there.
        let status = unsafe { sinew_body_restore(self.handle, bytes.as_ptr(), bytes.len()) };
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
    fn any_calls_leave_a_body_that_can_be_used(config in config(), calls in prop::collection::vec(call(), 1..16)) {
        let mut tracker = match Tracker::new(&config) {
            Ok(tracker) => tracker,
            Err(status) => {
                prop_assert!(matches!(status, SinewStatus::OutOfRange | SinewStatus::NotFinite), "{:?}", status);
                Tracker::new(&default_config()).unwrap()
            }
        };
        for call in &calls {
            tracker.call(call);
        }
        tracker.call(&Call::Reset);
        tracker.step(1, &mut [[0.0, 0.2, 1.9]; 40]);
    }
}
