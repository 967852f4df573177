//! The cyclic tracker.

use super::saved::{Damage, damage};
use super::{Memory, cases, is_finite, is_refusal, mostly, real};
use proptest::prelude::*;
use sinew_core::c_api::cyclic::*;
use sinew_core::c_api::cyclic_frame::{SINEW_MAX_ANGLES, SinewCyclicFrame, SinewCyclicResult};
use sinew_core::c_api::status::SinewStatus;
use sinew_core::cyclic::model::bytes::{write, write_coupled};
use std::mem::MaybeUninit;
use std::ptr::{null, null_mut};

#[derive(Debug, Clone)]
enum Call {
    Step { after_us: i64, seen: u32, count: u32, angles: [f32; SINEW_MAX_ANGLES], std: f32 },
    Walk { frames: u8, std: f32 },
    Pose { position: f32, count: usize },
    Restore(Damage),
    Reset,
}

fn call() -> impl Strategy<Value = Call> {
    let after_us = prop_oneof![8 => 1_i64..100_000, 1 => -100_000_i64..=0, 1 => 0_i64..1_000_000_000_000];
    let count = prop_oneof![8 => Just(13_u32), 1 => 0_u32..20, 1 => any::<u32>()];
    let seen = prop_oneof![8 => 0_u32..1 << 13, 1 => any::<u32>()];
    let angles = prop::array::uniform13(prop_oneof![60 => -3.0_f32..3.0, 1 => real()]);
    prop_oneof![
        6 => (after_us, seen, count, angles, mostly(0.01..1.0))
            .prop_map(|(after_us, seen, count, angles, std)| Call::Step { after_us, seen, count, angles, std }),
        2 => (1_u8..60, 0.01_f32..0.5).prop_map(|(frames, std)| Call::Walk { frames, std }),
        1 => (real(), 0_usize..20).prop_map(|(position, count)| Call::Pose { position, count }),
        3 => damage().prop_map(Call::Restore),
        1 => Just(Call::Reset),
    ]
}

struct Tracker {
    handle: *mut SinewCyclic,
    now_us: u64,
    /// Whether a forged state was restored, whose numbers are legal each and yet may lead anywhere.
    is_forged: bool,
    _memory: Memory,
}

impl Tracker {
    fn new() -> Self {
        let mut memory = Memory::new(SINEW_CYCLIC_MAX_BYTES);
        let mut handle = null_mut();
        // SAFETY: the memory is as large as is said.
        let status =
            unsafe { sinew_cyclic_init(memory.start(), SINEW_CYCLIC_MAX_BYTES, null(), 0, null(), &raw mut handle) };
        assert_eq!(status, SinewStatus::Ok);
        Self { handle, now_us: 0, is_forged: false, _memory: memory }
    }

    fn saved(&self) -> Vec<u8> {
        let (mut bytes, mut written) = (vec![0; SINEW_CYCLIC_STATE_MAX_BYTES], 0);
        // SAFETY: the buffer is as large as is said.
        let status = unsafe { sinew_cyclic_save(self.handle, bytes.as_mut_ptr(), bytes.len(), &raw mut written) };
        assert_eq!(status, SinewStatus::Ok);
        bytes.truncate(written);
        bytes
    }

    fn step(&mut self, frame: &SinewCyclicFrame) -> SinewStatus {
        let before = self.saved();
        let mut result = MaybeUninit::<SinewCyclicResult>::uninit();
        // SAFETY: frame and room for a result are there.
        let status = unsafe { sinew_cyclic_step(self.handle, frame, result.as_mut_ptr()) };
        if status != SinewStatus::Ok {
            assert!(is_refusal(status), "{status:?}");
            assert_eq!(self.saved(), before, "{status:?} changed the tracker");
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

    fn walk(&mut self, frames: u8, std: f32) {
        for _ in 0..frames {
            let mut angles_rad = [0.0; SINEW_MAX_ANGLES];
            let timestamp_us = self.now_us.saturating_add(16_667);
            let position = (timestamp_us % 1_000_000) as f32 * 1.0e-6;
            // SAFETY: there is room for all angles.
            let status =
                unsafe { sinew_cyclic_mean_pose(self.handle, position, angles_rad.as_mut_ptr(), SINEW_MAX_ANGLES) };
            assert_eq!(status, SinewStatus::Ok);
            let frame = SinewCyclicFrame {
                timestamp_us,
                seen: 0x1fff,
                angle_count: 13,
                angles_rad,
                std_rad: [std; SINEW_MAX_ANGLES],
            };
            let status = self.step(&frame);
            assert!(status == SinewStatus::Ok || timestamp_us == u64::MAX || self.is_forged, "{status:?}");
        }
    }

    fn call(&mut self, call: &Call) {
        match call {
            Call::Step { after_us, seen, count, angles, std } => {
                let frame = SinewCyclicFrame {
                    timestamp_us: self.now_us.saturating_add_signed(*after_us),
                    seen: *seen,
                    angle_count: *count,
                    angles_rad: *angles,
                    std_rad: [*std; SINEW_MAX_ANGLES],
                };
                self.step(&frame);
            }
            Call::Walk { frames, std } => self.walk(*frames, *std),
            Call::Pose { position, count } => {
                let mut angles = [f32::NAN; 20];
                // SAFETY: there is room for twenty.
                let status = unsafe { sinew_cyclic_mean_pose(self.handle, *position, angles.as_mut_ptr(), *count) };
                assert_eq!(status == SinewStatus::Ok, position.is_finite() && *count <= SINEW_MAX_ANGLES);
                assert!(status != SinewStatus::Ok || is_finite(&angles[..*count]));
            }
            Call::Restore(damage) => self.restore(damage),
            Call::Reset => {
                // SAFETY: the tracker was initialised.
                assert_eq!(unsafe { sinew_cyclic_reset(self.handle) }, SinewStatus::Ok);
                self.is_forged = false;
                self.now_us = 0;
            }
        }
    }

    fn restore(&mut self, damage: &Damage) {
        let before = self.saved();
        let bytes = damage.applied(&before);
        // SAFETY: the bytes are there.
        let status = unsafe { sinew_cyclic_restore(self.handle, bytes.as_ptr(), bytes.len()) };
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
    #![proptest_config(cases(48))]

    #[test]
    fn any_calls_leave_a_tracker_that_can_be_used(calls in prop::collection::vec(call(), 1..30)) {
        let mut tracker = Tracker::new();
        for call in &calls {
            tracker.call(call);
        }
        tracker.call(&Call::Reset);
        tracker.walk(30, 0.1);
    }

    #[test]
    fn bytes_that_are_no_model_are_refused(bytes in prop::collection::vec(any::<u32>(), 1..200), with_magic: bool) {
        let mut bytes = bytes;
        if with_magic {
            bytes[0] = u32::from_le_bytes(*b"SNWM");
        }
        let mut memory = Memory::new(SINEW_CYCLIC_MAX_BYTES);
        let mut handle = null_mut();
        let model = bytes.as_ptr().cast();
        // SAFETY: memory and model are as large as is said.
        let status = unsafe {
            sinew_cyclic_init(memory.start(), SINEW_CYCLIC_MAX_BYTES, model, 4 * bytes.len(), null(), &raw mut handle)
        };
        prop_assert_eq!(status, SinewStatus::BadModel);
        prop_assert!(handle.is_null());
    }
}

#[test]
fn a_model_in_bytes_gives_the_same_results_as_the_one_built_in() {
    let whole = sinew_core::cyclic::model::walking::WALKING.model().unwrap();
    let mut bytes = vec![0_u8; 64 * 1024];
    let count = write(&whole, &mut bytes).unwrap();
    same_results(&bytes[..count]);
    let count = write_coupled(&whole, &mut bytes).unwrap();
    same_results(&bytes[..count]);
}

fn same_results(words: &[u8]) {
    let count = words.len();
    let mut model = Memory::new(count);
    for (word, bytes) in model.0.iter_mut().zip(words.as_chunks::<8>().0) {
        *word = u64::from_le_bytes(*bytes);
    }
    let mut memory = Memory::new(SINEW_CYCLIC_MAX_BYTES);
    let mut handle = null_mut();
    let mut init = |model: *const core::ffi::c_void, bytes: usize| {
        // SAFETY: memory and model are as large as is said.
        unsafe { sinew_cyclic_init(memory.start(), SINEW_CYCLIC_MAX_BYTES, model, bytes, null(), &raw mut handle) }
    };
    let start = model.start();
    assert_eq!(init(start.wrapping_byte_add(1), count), SinewStatus::Misaligned);
    assert_eq!(init(start, count - 1), SinewStatus::BadModel);
    assert_eq!(init(null(), 8), SinewStatus::NullPointer);
    assert_eq!(init(start, count), SinewStatus::Ok);
    let mut from_bytes = Tracker { handle, now_us: 0, is_forged: false, _memory: memory };
    let mut built_in = Tracker::new();
    for tracker in [&mut from_bytes, &mut built_in] {
        tracker.walk(100, 0.1);
    }
    assert_eq!(from_bytes.saved(), built_in.saved());
}

#[test]
fn pointers_and_memory_are_checked() {
    let mut memory = Memory::new(SINEW_CYCLIC_MAX_BYTES);
    let mut handle = null_mut();
    let start = memory.start();
    // SAFETY: each pointer is null, misaligned, or points at what is said.
    unsafe {
        let size = sinew_cyclic_size();
        assert_eq!(sinew_cyclic_init(null_mut(), size, null(), 0, null(), &raw mut handle), SinewStatus::NullPointer);
        assert_eq!(sinew_cyclic_init(start, size, null(), 0, null(), null_mut()), SinewStatus::NullPointer);
        assert_eq!(sinew_cyclic_init(start, size - 1, null(), 0, null(), &raw mut handle), SinewStatus::TooSmall);
        let odd = start.wrapping_byte_add(1);
        assert_eq!(sinew_cyclic_init(odd, size, null(), 0, null(), &raw mut handle), SinewStatus::Misaligned);
        assert_eq!(sinew_cyclic_reset(start.cast()), SinewStatus::NotInitialised, "memory of zeros");
        assert_eq!(sinew_cyclic_init(start, size, null(), 0, null(), &raw mut handle), SinewStatus::Ok);
        assert_eq!(sinew_cyclic_step(handle, null(), null_mut()), SinewStatus::NullPointer);
        assert_eq!(sinew_cyclic_step(null_mut(), null(), null_mut()), SinewStatus::NullPointer);
        let mut written = 0;
        let mut byte = 0;
        assert_eq!(sinew_cyclic_save(handle, &raw mut byte, 1, &raw mut written), SinewStatus::TooSmall);
        assert!((16..SINEW_CYCLIC_STATE_MAX_BYTES).contains(&written));
        assert_eq!(sinew_cyclic_restore(handle, null(), 10), SinewStatus::NullPointer);
        assert_eq!(sinew_cyclic_restore(handle, null(), 0), SinewStatus::BadState);
    }
}
