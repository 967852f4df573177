//! The trackers of one arm and of two, with parameters and frames from bytes.

use crate::Target;
use crate::numbers::{Numbers, seeds};
use sinew_core::camera::{Camera, Pixel};
use sinew_core::saved_state::SavedState;
use sinew_core::skeleton::{ArmGeometry, Side};
use sinew_core::tracker::arm::example::{SHOULDERS_M, hand_blob, left_arm, right_arm};
use sinew_core::tracker::arm::{
    ArmEstimate, ArmFrame, ArmImage, ArmModel, ArmOptions, ArmPair, ArmTracker, PairFrame, Variant,
};
use sinew_core::vision::candidate::HandCandidate;
use sinew_core::vision::edges::EdgePixel;

/// One arm with its options, and two arms.
pub const TARGETS: &[Target] = &[
    Target { name: "arm", run: arm, seeds: || seeds(250) },
    Target { name: "arm_pair", run: pair, seeds: || seeds(200) },
];

/// Most frames of an execution.
const FRAMES: u64 = 8;
const FRAME_US: u64 = 66_667;

fn options(numbers: &mut Numbers<'_>) -> ArmOptions {
    let variant = Variant::ALL[numbers.below(Variant::ALL.len())];
    let mut options = ArmOptions { variant, particles: 1 + numbers.below(20), ..ArmOptions::default() };
    if let Some(gate) = &mut options.gate {
        numbers.change(&mut [
            &mut gate.std_m,
            &mut gate.growth_m_per_s,
            &mut gate.floor,
            &mut gate.missed_share,
            &mut gate.allotment_reach,
        ]);
    }
    if let Some(cue) = &mut options.area_cue {
        numbers.change(&mut [&mut cue.hand_area_m2, &mut cue.length_share, &mut cue.foreshortening, &mut cue.log_std]);
    }
    if let Some(memory) = &mut options.blob_memory {
        numbers.change(&mut [
            &mut memory.fall_time_s,
            &mut memory.rise_time_s,
            &mut memory.floor,
            &mut memory.rest_share,
            &mut memory.rest_time_s,
            &mut memory.moved_per_radius,
        ]);
    }
    numbers.change(&mut [
        &mut options.product_floor,
        &mut options.cluster_radius_per_focal,
        &mut options.velocity_persistence,
        &mut options.velocity_gain,
        &mut options.hand_std_m_per_sqrt_s,
        &mut options.elbow_std_m_per_sqrt_s,
        &mut options.ray_std_m_per_sqrt_s,
        &mut options.ray_std_per_path,
        &mut options.centre_std_per_focal,
        &mut options.reach_std_m,
        &mut options.reach_across_std_m,
        &mut options.limb_band_m,
        &mut options.orientation_memory_s,
        &mut options.teleport_share,
        &mut options.clutter_share,
        &mut options.lost_after_s,
        &mut options.sure_likelihood,
        &mut options.sure_share,
    ]);
    options.angle_std_rad_per_sqrt_s = options.angle_std_rad_per_sqrt_s.map(|std| numbers.number(std));
    options.depth_from_area = numbers.flag();
    options.joint_limits = !numbers.flag();
    options.solver_steps = 1 + numbers.below(8);
    options.hough.bins = numbers.below(80);
    if numbers.flag() {
        (options.gate, options.area_cue, options.blob_memory) = (None, None, None);
    }
    options
}

fn model(numbers: &mut Numbers<'_>) -> Option<ArmModel> {
    let focal_px = [numbers.number(550.0), numbers.number(550.0)];
    let centre = Pixel::new(numbers.number(320.0), numbers.number(240.0));
    let camera = Camera::new(focal_px[0], focal_px[1], centre).ok()?;
    let side = if numbers.flag() { Side::Right } else { Side::Left };
    let geometry = ArmGeometry::new(side, numbers.number(0.3), numbers.number(0.35)).ok()?;
    ArmModel::new(camera, (640, 480), geometry, options(numbers)).ok()
}

fn blob(numbers: &mut Numbers<'_>) -> HandCandidate {
    let clean = hand_blob();
    HandCandidate {
        centre: Pixel::new(numbers.number(clean.centre.u_px), numbers.number(clean.centre.v_px)),
        moments_px2: clean.moments_px2.map(|moment| numbers.number(moment)),
        area_px: numbers.number(clean.area_px),
        likelihood: numbers.number(clean.likelihood),
    }
}

/// What an image shows: up to three blobs and ten edges.
struct Seen {
    candidates: Vec<HandCandidate>,
    edges: Vec<EdgePixel>,
}

impl Seen {
    fn new(numbers: &mut Numbers<'_>) -> Self {
        let candidates = (0..[1, 0, 2, 3][numbers.below(4)]).map(|_| blob(numbers)).collect();
        let edge = |numbers: &mut Numbers<'_>| EdgePixel {
            u: u16::from(numbers.byte()) * 3,
            v: u16::from_le_bytes([numbers.byte(), numbers.byte() & 3]),
        };
        let edges = (0..numbers.below(10)).map(|_| edge(numbers)).collect();
        Self { candidates, edges }
    }

    fn image(&self) -> ArmImage<'_> {
        ArmImage { candidates: &self.candidates, edges: &self.edges }
    }
}

fn check(estimate: &ArmEstimate) {
    let joints = &estimate.joints;
    let places = [joints.shoulder_m, joints.elbow_m, joints.hand_m];
    assert!(places.iter().flatten().all(|coordinate| coordinate.is_finite()), "{estimate:?}");
    assert!(
        estimate.angles_rad.iter().chain([&estimate.log_evidence]).all(|number| number.is_finite()),
        "{estimate:?}"
    );
    assert!(estimate.hand_std_m >= 0.0 && estimate.hand_std_m.is_finite(), "{estimate:?}");
    assert!(estimate.effective_sample_size > 0.0, "{estimate:?}");
}

fn arm(bytes: &[u8]) {
    let mut numbers = Numbers::new(bytes);
    let Some(model) = model(&mut numbers) else { return };
    let Ok(mut tracker) = ArmTracker::<20>::new(&model, numbers.place(SHOULDERS_M[0]), numbers.long()) else { return };
    for frame in 0..FRAMES {
        let seen = Seen::new(&mut numbers);
        let frame = ArmFrame {
            timestamp_us: numbers.time_us(FRAME_US * frame),
            image: (numbers.below(8) != 7).then_some(seen.image()),
            shoulder_m: numbers.place(SHOULDERS_M[0]),
        };
        check(&tracker.step(&model, &frame));
        assert!(tracker.is_finite(), "the state after {frame:?}");
    }
}

fn pair(bytes: &[u8]) {
    let mut numbers = Numbers::new(bytes);
    let models = [left_arm(), right_arm()].map(|model| {
        let model = model.expect("it is built in");
        let options = ArmOptions { particles: 10, ..*model.options() };
        ArmModel::new(*model.camera(), (640, 480), *model.geometry(), options).expect("it is built in")
    });
    let shoulders_m = SHOULDERS_M.map(|shoulder_m| numbers.place(shoulder_m));
    let Ok(mut pair) = ArmPair::<20>::new([&models[0], &models[1]], shoulders_m, numbers.long()) else { return };
    for frame in 0..FRAMES {
        let seen = Seen::new(&mut numbers);
        let frame = PairFrame {
            timestamp_us: numbers.time_us(FRAME_US * frame),
            image: (numbers.below(8) != 7).then_some(seen.image()),
            shoulders_m: SHOULDERS_M.map(|shoulder_m| numbers.place(shoulder_m)),
        };
        pair.step([&models[0], &models[1]], &frame).iter().for_each(check);
        assert!(pair.is_finite(), "the state after {frame:?}");
    }
}
