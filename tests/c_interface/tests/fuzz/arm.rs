//! The arm trackers.

use super::saved::{Damage, damage};
use super::{Memory, cases, is_finite, is_refusal, mostly, real};
use proptest::prelude::*;
use sinew_core::c_api::arm::*;
use sinew_core::c_api::arm_config::*;
use sinew_core::c_api::arm_frame::*;
use sinew_core::c_api::arm_pair::*;
use sinew_core::c_api::status::SinewStatus;
use sinew_core::camera::Pixel;
use sinew_core::vision::candidate::HandCandidate;
use sinew_core::vision::edges::EdgePixel;
use std::mem::MaybeUninit;
use std::ptr::null_mut;

#[derive(Debug, Clone)]
enum Call {
    Step { after_us: i64, has_image: bool, candidates: Vec<HandCandidate>, edges: Vec<EdgePixel>, shoulder_m: [f32; 3] },
    Restore(Damage),
    Reset,
}

fn candidate() -> impl Strategy<Value = HandCandidate> {
    let moments = [mostly(0.0..900.0), mostly(-100.0..100.0), mostly(0.0..900.0)];
    (mostly(-20.0..340.0), mostly(-20.0..260.0), moments, mostly(1.0..5000.0), mostly(0.0..1.0)).prop_map(
        |(u_px, v_px, moments_px2, area_px, likelihood)| HandCandidate {
            centre: Pixel::new(u_px, v_px),
            moments_px2,
            area_px,
            likelihood,
        },
    )
}

fn call() -> impl Strategy<Value = Call> {
    let after_us = prop_oneof![8 => 1_i64..200_000, 1 => -100_000_i64..=0, 1 => 0_i64..1_000_000_000_000];
    let candidates = prop_oneof![
        8 => prop::collection::vec(candidate(), 0..6),
        1 => prop::collection::vec(candidate(), 0..40),
    ];
    let edge = prop_oneof![8 => (0_u16..320, 0_u16..240), 1 => (any::<u16>(), any::<u16>())];
    let edges = prop::collection::vec(edge.prop_map(|(u, v)| EdgePixel { u, v }), 0..300);
    let shoulder_m = [mostly(-1.0..1.0), mostly(-1.0..1.0), mostly(0.3..4.0)];
    prop_oneof![
        8 => (after_us, prop::bool::weighted(0.9), candidates, edges, shoulder_m).prop_map(
            |(after_us, has_image, candidates, edges, shoulder_m)| Call::Step { after_us, has_image, candidates, edges, shoulder_m }
        ),
        2 => damage().prop_map(Call::Restore),
        1 => Just(Call::Reset),
    ]
}

fn config() -> SinewArmConfig {
    let mut config = MaybeUninit::uninit();
    // SAFETY: there is room for one, and it is written.
    unsafe {
        assert_eq!(
            sinew_arm_default_config(320, 240, 1.0, config.as_mut_ptr(), size_of::<SinewArmConfig>()),
            SinewStatus::Ok
        );
        config.assume_init()
    }
}

/// Options of any kind, most of them legal.
fn options() -> impl Strategy<Value = SinewArmConfig> {
    let counts = (1_u32..=50, 0_u32..=4, 10_u32..2000, 1_u32..8, 0_u32..=1);
    let stds = (mostly(0.001..10.0), mostly(0.001..10.0), mostly(0.001..10.0));
    let area_and_gate = (mostly(0.0001..1.0), mostly(0.01..10.0), mostly(0.01..10.0), mostly(0.0..100.0));
    (counts, stds, area_and_gate, mostly(1.0e-9..1.0), mostly(0.01..3600.0)).prop_map(
        |(
            (particles, variant, max_pairs, solver_steps, has_guessed_shoulders),
            stds,
            area_and_gate,
            gate_floor,
            lost_after_s,
        )| {
            SinewArmConfig {
                particles,
                variant,
                max_pairs,
                solver_steps,
                has_guessed_shoulders,
                hand_std_m_per_sqrt_s: stds.0,
                ray_std_m_per_sqrt_s: stds.1,
                angle_std_rad_per_sqrt_s: stds.2,
                hand_area_m2: area_and_gate.0,
                area_log_std: area_and_gate.1,
                gate_std_m: area_and_gate.2,
                gate_growth_m_per_s: area_and_gate.3,
                gate_floor,
                lost_after_s,
                ..config()
            }
        },
    )
}

/// One arm or both, and the memory that they lie in.
struct Tracker {
    one: *mut SinewArm,
    pair: *mut SinewArmPair,
    now_us: u64,
    /// Whether a forged state was restored, whose numbers are legal each and yet may lead anywhere.
    is_forged: bool,
    _memory: Memory,
}

fn init(config: &SinewArmConfig, side: Option<u32>) -> (SinewStatus, Tracker) {
    let mut memory = Memory::new(SINEW_ARM_PAIR_MAX_BYTES);
    let (mut one, mut pair) = (null_mut(), null_mut());
    let start = memory.start();
    // SAFETY: the memory is as large as is said.
    let status = unsafe {
        match side {
            Some(side) => sinew_arm_init(start, SINEW_ARM_MAX_BYTES, config, side, &raw mut one),
            None => sinew_arm_pair_init(start, SINEW_ARM_PAIR_MAX_BYTES, config, &raw mut pair),
        }
    };
    (status, Tracker { one, pair, now_us: 0, is_forged: false, _memory: memory })
}

impl Tracker {
    fn saved(&self) -> Vec<u8> {
        let (mut bytes, mut written) = (vec![0; SINEW_ARM_PAIR_STATE_MAX_BYTES], 0);
        let (start, len) = (bytes.as_mut_ptr(), bytes.len());
        // SAFETY: the buffer is as large as is said.
        let status = unsafe {
            if self.pair.is_null() {
                sinew_arm_save(self.one, start, len.min(SINEW_ARM_STATE_MAX_BYTES), &raw mut written)
            } else {
                sinew_arm_pair_save(self.pair, start, len, &raw mut written)
            }
        };
        assert_eq!(status, SinewStatus::Ok);
        bytes.truncate(written);
        bytes
    }

    fn step(&mut self, frame: &SinewArmFrame) -> SinewStatus {
        let before = self.saved();
        let mut results = [MaybeUninit::<SinewArmResult>::uninit(); 2];
        let room = results.as_mut_ptr().cast();
        // SAFETY: frame, lists and room for the results are there.
        let status = unsafe {
            if self.pair.is_null() {
                sinew_arm_step(self.one, frame, room)
            } else {
                sinew_arm_pair_step(self.pair, frame, room)
            }
        };
        if status != SinewStatus::Ok {
            assert!(is_refusal(status), "{status:?}");
            assert!(self.saved() == before, "{status:?} changed the tracker");
            return status;
        }
        self.now_us = frame.timestamp_us;
        let count = if self.pair.is_null() { 1 } else { 2 };
        for result in results.iter().take(count) {
            // SAFETY: the status says that they were written.
            let result = unsafe { result.assume_init() };
            let numbers =
                [result.hand_m, result.elbow_m, [result.hand_std_m, result.log_evidence, result.hand_likelihood]];
            assert!(self.is_forged || is_finite(numbers.as_flattened()) && is_finite(&result.angles_rad), "{result:?}");
        }
        status
    }

    fn call(&mut self, call: &Call) {
        match call {
            Call::Step { after_us, has_image, candidates, edges, shoulder_m } => {
                self.step(&SinewArmFrame {
                    timestamp_us: self.now_us.saturating_add_signed(*after_us),
                    candidates: candidates.as_ptr(),
                    edges: edges.as_ptr(),
                    candidate_count: candidates.len() as u32,
                    edge_count: edges.len() as u32,
                    has_image: u32::from(*has_image),
                    shoulders_m: [*shoulder_m, [-shoulder_m[0], shoulder_m[1], shoulder_m[2]]],
                });
            }
            Call::Restore(damage) => self.restore(damage),
            Call::Reset => self.reset(),
        }
    }

    fn reset(&mut self) {
        // SAFETY: the tracker was initialised.
        let status =
            unsafe { if self.pair.is_null() { sinew_arm_reset(self.one) } else { sinew_arm_pair_reset(self.pair) } };
        assert_eq!(status, SinewStatus::Ok);
        self.now_us = 0;
        self.is_forged = false;
    }

    fn restore(&mut self, damage: &Damage) {
        let before = self.saved();
        let bytes = damage.applied(&before);
        // SAFETY: the bytes are there.
        let status = unsafe {
            if self.pair.is_null() {
                sinew_arm_restore(self.one, bytes.as_ptr(), bytes.len())
            } else {
                sinew_arm_pair_restore(self.pair, bytes.as_ptr(), bytes.len())
            }
        };
        // What a forged state led to may itself be no state.
        let is_lost = self.is_forged && status == SinewStatus::BadState;
        assert!(damage.allows(status) || is_lost, "{damage:?}: {status:?}");
        if matches!(damage, Damage::Forged { .. }) || is_lost {
            self.is_forged |= status == SinewStatus::Ok;
            self.now_us = u64::from_le_bytes(self.saved()[20..28].try_into().unwrap());
        } else {
            assert!(self.saved() == before, "{damage:?}");
        }
    }
}

proptest! {
    #![proptest_config(cases(24))]

    #[test]
    fn any_calls_leave_a_tracker_that_can_be_used(
        config in prop_oneof![Just(config()), options()],
        calls in prop::collection::vec(call(), 1..12), side in prop_oneof![Just(None), (0_u32..2).prop_map(Some)],
    ) {
        let (status, mut tracker) = init(&config, side);
        if status != SinewStatus::Ok {
            prop_assert!(is_refusal(status), "{:?}", status);
            return Ok(());
        }
        let fresh = tracker.saved();
        for call in &calls {
            tracker.call(call);
        }
        tracker.reset();
        prop_assert!(tracker.saved() == fresh, "a reset leaves something");
    }

    #[test]
    fn any_configuration_is_answered(
        numbers in prop::collection::vec(real(), 12), size in prop::array::uniform2(any::<u32>()), side in 0_u32..4, seed: u64,
    ) {
        let [w, h] = size;
        let at = |i: usize| numbers[i];
        let config = SinewArmConfig {
            seed,
            image_width_px: w,
            image_height_px: h,
            focal_px: [at(0), at(1)],
            principal_point_px: [at(2), at(3)],
            upper_arm_m: at(4),
            forearm_m: at(5),
            shoulders_m: [[at(6), at(7), at(8)], [at(9), at(10), at(11)]],
            ..config()
        };
        let (status, tracker) = init(&config, Some(side));
        prop_assert!(status == SinewStatus::Ok || is_refusal(status), "{:?}", status);
        prop_assert_eq!(tracker.one.is_null(), status != SinewStatus::Ok);
        prop_assert!(side < 2 || status != SinewStatus::Ok);
    }
}
