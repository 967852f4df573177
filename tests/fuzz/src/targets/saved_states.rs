//! Saved states of the core, restored and stepped on.
//!
//! The bytes are a state without its envelope, so that they are not refused for their checksum.
//! They are also tried as they are. A forged covariance within its ranges may be indefinite, so
//! that a step leads to a variance below zero. Numbers stay numbers.

use super::cyclic::{model_table, seen};
use crate::Target;
use sinew_core::checksum::crc32;
use sinew_core::cyclic::particle::propose::{ParticleOptions, factors_len, fill_factors};
use sinew_core::cyclic::particle::tracker::ParticleTables;
use sinew_core::cyclic::recognition::bank::MotionBank;
use sinew_core::cyclic::{CoupledFilter, CycleStart, KalmanFilter, KalmanOptions, MotionModel, ParticleTracker};
use sinew_core::saved_state::{HEADER_WORDS, SavedState, StateKind, StateVisitor, VERSION, restore, save, saved_bytes};
use sinew_core::tracker::arm::example::{SHOULDERS_M, hand_blob, left_arm, right_arm};
use sinew_core::tracker::arm::{ArmFrame, ArmImage, ArmPair, ArmTracker, PairFrame};
use sinew_core::tracker::cyclic::{CoupledTracker, FirstPhase};
use std::ops::RangeInclusive;

/// Arm, pair of arms, the filters of a cycle, their tracker, and the bank of motions. The body is
/// among the targets of runs.
pub const TARGETS: &[Target] = &[
    Target { name: "saved_arm", run: arm, seeds: || vec![content(StateKind::Arm, &mut stepped_arm(5))] },
    Target { name: "saved_arm_pair", run: pair, seeds: || vec![content(StateKind::ArmPair, &mut stepped_pair())] },
    Target { name: "saved_kalman", run: kalman, seeds: || vec![with_model(|m| content(KIND, &mut new_kalman(m)))] },
    Target { name: "saved_coupled", run: coupled, seeds: || vec![with_model(|m| content(KIND, &mut new_coupled(m)))] },
    Target { name: "saved_particles", run: particles, seeds: || vec![with_model(|m| content(KIND, &mut swarm(m).0))] },
    Target { name: "saved_tracker", run: tracker, seeds: || vec![with_model(|m| content(KIND, &mut new_tracker(m)))] },
    Target { name: "saved_bank", run: bank, seeds: || vec![with_model(|m| content(KIND, &mut new_bank(m)))] },
];

const KIND: StateKind = StateKind::Cyclic;
const FINGERPRINT: u32 = 7;
/// Steps after a state is restored.
const STEPS: u8 = 4;
/// Particles of a tracker of the cycle.
const PARTICLES: usize = 24;

/// The words of a state without its envelope.
pub fn content(kind: StateKind, state: &mut impl SavedState) -> Vec<u8> {
    let mut bytes = vec![0; saved_bytes(state)];
    save(kind, FINGERPRINT, state, &mut bytes).expect("there is room");
    bytes[4 * HEADER_WORDS..bytes.len() - 4].to_vec()
}

/// A state with an envelope that is sound.
pub fn sealed(kind: StateKind, fingerprint: u32, content: &[u8]) -> Vec<u8> {
    let words = content.len() / 4 + HEADER_WORDS + 1;
    let first = [kind as u32 | u32::from(VERSION) << 16, 4 * words as u32, fingerprint];
    let mut bytes = b"SNWS".to_vec();
    bytes.extend(first.iter().flat_map(|word| word.to_le_bytes()));
    bytes.extend_from_slice(&content[..content.len() / 4 * 4]);
    let sum = crc32(&bytes);
    bytes.extend(sum.to_le_bytes());
    bytes
}

/// Restores the state; whether it came back, as it was saved.
fn is_restored(kind: StateKind, state: &mut (impl SavedState + Clone), bytes: &[u8]) -> bool {
    let _ = restore(kind, FINGERPRINT, &mut state.clone(), bytes);
    let whole = sealed(kind, FINGERPRINT, bytes);
    if restore(kind, FINGERPRINT, state, &whole).is_err() {
        return false;
    }
    assert!(state.is_finite(), "a state out of its ranges was restored");
    let mut again = vec![0; saved_bytes(state)];
    save(kind, FINGERPRINT, state, &mut again).expect("there is room");
    // A flag or a missing number may be written in one way only.
    let mut twice = state.clone();
    restore(kind, FINGERPRINT, &mut twice, &again).expect("it was saved");
    true
}

/// Looks for a number that is none.
#[derive(Default)]
struct Finite {
    /// Numbers so far.
    count: usize,
    /// The places and values of what is no number.
    wrong: Vec<(usize, f32)>,
}

impl StateVisitor for Finite {
    fn word(&mut self, _: &mut u32) {}

    fn refuse(&mut self) {}

    fn real(&mut self, value: &mut f32, _: &RangeInclusive<f32>) {
        if !value.is_finite() {
            self.wrong.push((self.count, *value));
        }
        self.count += 1;
    }
}

/// Panics where a state holds a number that is none. A state that is restored may lie at the edge
/// of its ranges, so that a step leads beyond them.
pub fn check_numbers(state: &mut impl SavedState) {
    let mut finite = Finite::default();
    state.visit(&mut finite);
    assert!(finite.wrong.is_empty(), "of {} numbers: {:?}", finite.count, finite.wrong);
}

type Arm = ArmTracker<20>;

fn step_arm(tracker: &mut Arm, steps: u8) {
    let model = left_arm().expect("it is built in");
    for frame in 0..steps {
        let candidates = [hand_blob()];
        let image = (frame % 3 != 2).then_some(ArmImage { candidates: &candidates, edges: &[] });
        let timestamp_us = 66_667 * u64::from(frame);
        let estimate = tracker.step(&model, &ArmFrame { timestamp_us, image, shoulder_m: SHOULDERS_M[0] });
        assert!(estimate.angles_rad.iter().all(|angle| angle.is_finite()), "{estimate:?}");
        assert!(tracker.is_finite(), "the state after {estimate:?}");
    }
}

fn new_arm() -> Arm {
    let mut model = left_arm().expect("it is built in");
    let options = sinew_core::tracker::arm::ArmOptions { particles: 20, ..*model.options() };
    model = sinew_core::tracker::arm::ArmModel::new(*model.camera(), (640, 480), *model.geometry(), options)
        .expect("it is built in");
    Arm::new(&model, SHOULDERS_M[0], 1).expect("it is built in")
}

fn stepped_arm(steps: u8) -> Arm {
    let mut tracker = new_arm();
    step_arm(&mut tracker, steps);
    tracker
}

fn arm(bytes: &[u8]) {
    let mut tracker = new_arm();
    if is_restored(StateKind::Arm, &mut tracker, bytes) {
        step_arm(&mut tracker, STEPS);
    }
}

fn step_pair(pair: &mut ArmPair<50>) {
    let models = [left_arm(), right_arm()].map(|model| model.expect("it is built in"));
    for frame in 0..STEPS {
        let image = Some(ArmImage { candidates: &[hand_blob()], edges: &[] });
        let frame = PairFrame { timestamp_us: 66_667 * u64::from(frame), image, shoulders_m: SHOULDERS_M };
        let [left, right] = &models;
        let estimates = pair.step([left, right], &frame);
        assert!(estimates.iter().flat_map(|side| side.angles_rad).all(f32::is_finite), "{estimates:?}");
        assert!(pair.is_finite(), "the state after {estimates:?}");
    }
}

fn new_pair() -> ArmPair<50> {
    let models = [left_arm(), right_arm()].map(|model| model.expect("it is built in"));
    ArmPair::new([&models[0], &models[1]], SHOULDERS_M, 1).expect("it is built in")
}

fn stepped_pair() -> ArmPair<50> {
    let mut pair = new_pair();
    step_pair(&mut pair);
    pair
}

fn pair(bytes: &[u8]) {
    let mut pair = new_pair();
    if is_restored(StateKind::ArmPair, &mut pair, bytes) {
        step_pair(&mut pair);
    }
}

fn with_model<T>(call: impl FnOnce(&MotionModel<'_>) -> T) -> T {
    call(&model_table().model().expect("it is built in"))
}

fn new_kalman(model: &MotionModel<'_>) -> KalmanFilter<2> {
    let start = CycleStart::standard(model, seen(0).angles_rad(), Some(0.0), None).expect("it is built in");
    KalmanFilter::new(model, &KalmanOptions::default(), &start).expect("it is built in")
}

fn kalman(bytes: &[u8]) {
    with_model(|model| {
        for options in [KalmanOptions::default(), KalmanOptions::cut()] {
            let mut filter = new_kalman(model);
            if !is_restored(KIND, &mut filter, bytes) {
                return;
            }
            for frame in 0..STEPS {
                super::cyclic::check_numbers(&filter.step(model, &options, &seen(frame)));
                check_numbers(&mut filter);
            }
        }
    });
}

fn new_coupled(model: &MotionModel<'_>) -> CoupledFilter<2> {
    let mut filter = CoupledFilter::new(model, &seen(0), None, None).expect("it is built in");
    for frame in 1..9 {
        filter.step(model, &seen(frame));
    }
    filter
}

fn coupled(bytes: &[u8]) {
    with_model(|model| {
        let mut filter = new_coupled(model);
        if is_restored(KIND, &mut filter, bytes) {
            for frame in 0..STEPS {
                super::cyclic::check_numbers(&filter.step(model, &seen(frame)));
                check_numbers(&mut filter);
            }
        }
    });
}

fn swarm(model: &MotionModel<'_>) -> (ParticleTracker<2, PARTICLES>, Vec<f32>) {
    let mut factors = vec![0.0; factors_len(model)];
    fill_factors(model, &mut factors);
    let start = CycleStart::standard(model, seen(0).angles_rad(), Some(0.0), None).expect("it is built in");
    let tables = ParticleTables { factors: &factors, positions: &[] };
    (ParticleTracker::new(model, tables, ParticleOptions::default(), &start, 1), factors)
}

fn particles(bytes: &[u8]) {
    with_model(|model| {
        let (mut tracker, factors) = swarm(model);
        if is_restored(KIND, &mut tracker, bytes) {
            for frame in 0..STEPS {
                let tables = ParticleTables { factors: &factors, positions: &[] };
                super::cyclic::check_numbers(&tracker.step(model, tables, &seen(frame)));
                check_numbers(&mut tracker);
            }
        }
    });
}

fn new_tracker(model: &MotionModel<'_>) -> CoupledTracker<2> {
    let mut tracker = CoupledTracker::new(model, &seen(0), FirstPhase::default()).expect("it is built in");
    for frame in 1..9 {
        tracker.step(model, &seen(frame));
    }
    tracker
}

fn tracker(bytes: &[u8]) {
    with_model(|model| {
        let mut tracker = new_tracker(model);
        if is_restored(KIND, &mut tracker, bytes) {
            for frame in 0..STEPS {
                let answer = tracker.step(model, &seen(frame));
                super::cyclic::check_numbers(&answer.estimate);
                assert!(answer.cadence_per_min.is_finite(), "{answer:?}");
                check_numbers(&mut tracker);
            }
        }
    });
}

fn new_bank(model: &MotionModel<'_>) -> MotionBank<2, 2> {
    let mut bank = MotionBank::new(&[*model; 2]);
    (0..9).for_each(|frame: u8| bank.add(&[*model; 2], &seen(frame), &[f32::from(frame) / 60.0, 0.3]));
    bank
}

fn bank(bytes: &[u8]) {
    with_model(|model| {
        let mut bank = new_bank(model);
        if is_restored(KIND, &mut bank, bytes) {
            for frame in 0..STEPS {
                bank.add(&[*model; 2], &seen(frame), &[f32::from(frame) / 60.0, 0.3]);
                let sum = bank.probabilities().iter().sum::<f32>() + bank.none_probability();
                assert!((sum - 1.0).abs() < 1.0e-3 && bank.is_finite(), "probabilities sum to {sum}");
            }
        }
    });
}
