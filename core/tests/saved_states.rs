//! States that were saved by this version of the layout, and what a change of it asks for.
//!
//! `tests/states/KIND_VERSION.bin` holds a state of each kind. Who changes a layout raises
//! `saved_state::VERSION`; `SINEW_REGENERATE=1` then writes the states of the new version beside
//! those of the older ones, and never over a state that is there.
#![cfg(feature = "walking-model")]

use sinew_core::checksum::Crc32;
use sinew_core::cyclic::AngleMeasurement;
use sinew_core::cyclic::model::walking::WALKING;
use sinew_core::saved_state::{SavedState, StateError, StateKind, StateVisitor, VERSION, restore, save, saved_bytes};
use sinew_core::tracker::arm::example::{SHOULDERS_M, hand_blob, left_arm};
use sinew_core::tracker::arm::{ArmFrame, ArmImage, ArmTracker};
use sinew_core::tracker::cyclic::{CoupledTracker, FirstPhase};
use std::fs;
use std::ops::RangeInclusive;
use std::path::PathBuf;

/// Model or options that the states are said to belong to.
const FINGERPRINT: u32 = 7;
/// Checksums of the layouts of `VERSION`: which numbers, in which order, within which ranges.
const CYCLIC_LAYOUT: u32 = 2_806_404_174;
const ARM_LAYOUT: u32 = 2_418_859_162;

/// A walker after a second and a half.
fn walker() -> CoupledTracker<13> {
    let model = WALKING.model().unwrap();
    let seen = |frame: u16| {
        let pose_rad = model.mean_pose_rad::<13>(model.point(f32::from(frame) * model.mean_cycle_velocity()));
        AngleMeasurement::new(&pose_rad.map(Some), 0.1).unwrap()
    };
    let mut tracker = CoupledTracker::new(&model, &seen(0), FirstPhase::default()).unwrap();
    for frame in 1..=90 {
        tracker.step(&model, &seen(frame));
    }
    tracker
}

/// An arm after five frames.
fn arm() -> ArmTracker<50> {
    let (model, shoulder_m) = (left_arm().unwrap(), SHOULDERS_M[0]);
    let mut tracker = ArmTracker::new(&model, shoulder_m, 1).unwrap();
    for frame in 0..5 {
        let image = Some(ArmImage { candidates: &[hand_blob()], edges: &[] });
        tracker.step(&model, &ArmFrame { timestamp_us: frame * 66_667, image, shoulder_m });
    }
    tracker
}

fn path(name: &str, version: u16) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("tests/states/{name}_{version}.bin"))
}

/// Restores the state of this version, saves it again, and refuses those of older versions.
fn check(name: &str, kind: StateKind, state: &mut impl SavedState) {
    let mut bytes = vec![0; saved_bytes(state)];
    save(kind, FINGERPRINT, state, &mut bytes).unwrap();
    if std::env::var_os("SINEW_REGENERATE").is_some() && !path(name, VERSION).exists() {
        fs::create_dir_all(path(name, VERSION).parent().unwrap()).unwrap();
        fs::write(path(name, VERSION), &bytes).unwrap();
    }
    let golden = fs::read(path(name, VERSION)).expect("SINEW_REGENERATE=1 writes the states of a new version");
    assert_eq!(restore(kind, FINGERPRINT, state, &golden), Ok(()), "{name}: the layout changed; raise VERSION");
    bytes.resize(saved_bytes(state), 0);
    save(kind, FINGERPRINT, state, &mut bytes).unwrap();
    assert_eq!(bytes, golden, "{name}: the layout changed; raise VERSION");
    for version in 0..VERSION {
        if let Ok(older) = fs::read(path(name, version)) {
            assert_eq!(restore(kind, FINGERPRINT, state, &older), Err(StateError::Version), "{name} {version}");
        }
    }
}

#[test]
fn a_cyclic_state_of_this_version_is_read() {
    check("cyclic", StateKind::Cyclic, &mut walker());
}

#[test]
fn an_arm_s_state_of_this_version_is_read() {
    check("arm", StateKind::Arm, &mut arm());
}

/// Sums up what the numbers of a state are, not their values.
struct Layout(Crc32);

impl Layout {
    fn add(&mut self, words: &[u32]) {
        self.0 = words.iter().fold(self.0, |sum, word| sum.and_word(*word));
    }
}

impl StateVisitor for Layout {
    fn word(&mut self, _: &mut u32) {
        self.add(&[1]);
    }

    fn refuse(&mut self) {}

    fn real(&mut self, _: &mut f32, range: &RangeInclusive<f32>) {
        self.add(&[2, range.start().to_bits(), range.end().to_bits()]);
    }

    fn integer(&mut self, _: &mut i32) {
        self.add(&[3]);
    }

    fn flag(&mut self, _: &mut bool) {
        self.add(&[4]);
    }

    fn index(&mut self, _: &mut usize, most: usize) {
        self.add(&[5, most as u32]);
    }
}

/// Two numbers that change places read the same state in another way.
#[test]
fn the_layouts_are_those_of_the_version() {
    let layout = |state: &mut dyn FnMut(&mut Layout)| {
        let mut layout = Layout(Crc32::new());
        state(&mut layout);
        layout.0.value()
    };
    let found = (layout(&mut |sum| walker().visit(sum)), layout(&mut |sum| arm().visit(sum)));
    assert_eq!(
        (VERSION, found),
        (8, (CYCLIC_LAYOUT, ARM_LAYOUT)),
        "a layout changed: raise `saved_state::VERSION`, and write it and the new checksums here"
    );
}
