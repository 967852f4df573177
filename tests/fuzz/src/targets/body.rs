//! The tracker of a body, with parameters and frames from bytes.

use super::saved_states::{check_numbers, content, sealed};
use crate::Target;
use crate::numbers::{Numbers, seeds};
use sinew_core::math::Vec3;
use sinew_core::observation::point_cloud::{PointBlock, PointCloud};
use sinew_core::pik::example::{arm_points, arm_scene, bending_elbow, guided_arm, hand_goals, rod_points, rod_scene};
use sinew_core::pik::goal::LinearExtrapolation;
use sinew_core::pik::guided::GuidedMotion;
use sinew_core::pik::motion::{BodyMotion, BodyParticle, BodyScene};
use sinew_core::pik::processes::extrapolation::LinearGoals;
use sinew_core::pik::root::RootProcess;
use sinew_core::saved_state::{SavedState, StateKind, restore};
use sinew_core::tracker::body::{
    BodyFrame, BodyOptions, BodyTracker, DEFAULT_BODY_OPTIONS, RivalOptions, RootAlignment, SpeedScaledNoise,
};

/// An arm whose root is held, a rod whose root is free, and the saved state of each.
pub const TARGETS: &[Target] = &[
    Target { name: "body_held", run: held, seeds: || seeds(150) },
    Target { name: "body_free", run: free, seeds: || seeds(150) },
    Target { name: "saved_body", run: saved, seeds: || vec![saved_seed()] },
];

/// Most frames of an execution.
const FRAMES: usize = 4;
const DT_S: f32 = 1.0 / 15.0;
const PARTICLES: usize = 12;
const ROD_POSE: [f32; 6] = [0.1, 0.0, 3.0, 0.0, 0.0, 0.0];

type Tracker<const B: usize, const A: usize> = BodyTracker<B, A, PARTICLES, Vec<BodyParticle<B, A>>>;

fn options(numbers: &mut Numbers<'_>) -> BodyOptions {
    let mut pace = SpeedScaledNoise {
        rest_share: 0.4,
        full_speed_m_per_s: 1.3,
        max_scale_seen: 1.5,
        fade_s: 0.3,
        unseen_growth_s: 0.5,
        max_scale_unseen: 2.0,
    };
    numbers.change(&mut [
        &mut pace.rest_share,
        &mut pace.full_speed_m_per_s,
        &mut pace.max_scale_seen,
        &mut pace.fade_s,
        &mut pace.unseen_growth_s,
        &mut pace.max_scale_unseen,
    ]);
    let mut rival = RivalOptions { evidence_share: 0.2, switch_cost: 10.0 };
    numbers.change(&mut [&mut rival.evidence_share, &mut rival.switch_cost]);
    let mut options = BodyOptions {
        rival: numbers.flag().then_some(rival),
        jitter_std_errors: 1.0,
        jitter_std_m: 0.005,
        pace: numbers.flag().then_some(pace),
        acceleration_share: 0.5,
        limb_by_limb: numbers.flag(),
        ..DEFAULT_BODY_OPTIONS
    };
    numbers.change(&mut [&mut options.jitter_std_errors, &mut options.jitter_std_m, &mut options.acceleration_share]);
    options
}

fn alignment(numbers: &mut Numbers<'_>) -> RootAlignment {
    RootAlignment {
        steps: numbers.below(12),
        coarse_to_fine: numbers.flag(),
        shift_std_m_per_sqrt_s: numbers.number(1.0),
        turn_std_rad_per_sqrt_s: numbers.number(0.1),
        angle_std_rad_per_sqrt_s: numbers.number(1.0),
        pulling_blocks: numbers.below(40),
        fit_trunk: numbers.flag(),
    }
}

/// The blocks of a frame: clean ones, changed ones, or those that the border makes of any points.
fn blocks(numbers: &mut Numbers<'_>, clean: &[PointBlock], camera_m: &Vec3) -> Vec<PointBlock> {
    let mut blocks = clean.to_vec();
    match numbers.below(8) {
        0..=3 => {}
        4 => blocks.clear(),
        5 => {
            let all = blocks.iter().flat_map(|block| (0..16).map(|i| block.point_m(i)));
            let mut points_m: Vec<Vec3> = all.map(|point_m| numbers.place(point_m)).collect();
            let mut cloud = PointCloud::<3>::new();
            let _ = cloud.set(&mut points_m, camera_m);
            blocks = cloud.blocks().to_vec();
        }
        _ => {
            if let Some(block) = blocks.first_mut() {
                let index = numbers.below(16);
                for axis in [&mut block.x, &mut block.y, &mut block.z] {
                    axis[index] = numbers.number(axis[index]);
                }
                block.centre_m = numbers.place(block.centre_m);
                block.radius_m = numbers.number(block.radius_m);
                block.count = numbers.byte();
            }
        }
    }
    blocks
}

fn drive<const B: usize, const A: usize>(
    tracker: &mut Tracker<B, A>,
    scene: &BodyScene<B, A>,
    motion: &impl BodyMotion<B, A>,
    clean: &[PointBlock],
    numbers: &mut Numbers<'_>,
    check: impl Fn(&mut Tracker<B, A>),
) {
    for _ in 0..FRAMES {
        let blocks = blocks(numbers, clean, &scene.camera_m);
        let frame = BodyFrame { dt_s: numbers.number(DT_S), blocks: &blocks };
        let estimate = tracker.step(scene, motion, &frame);
        let ends = estimate.ends_m.iter().flat_map(|end_m| end_m.iter());
        let all = ends.chain(&estimate.angles_rad).chain([&estimate.log_evidence]);
        assert!(all.into_iter().all(|number| number.is_finite()), "{estimate:?} by {frame:?}");
        assert!(estimate.spread_m.iter().all(|m| *m >= 0.0 && m.is_finite()), "{estimate:?} by {frame:?}");
        check(tracker);
    }
}

/// A step keeps the ranges of the state.
fn in_ranges(tracker: &mut impl SavedState) {
    assert!(tracker.is_finite(), "the state");
}

fn tracker<const B: usize, const A: usize>(
    first: &BodyParticle<B, A>,
    options: BodyOptions,
    seed: u64,
) -> Option<Tracker<B, A>> {
    BodyTracker::new(first, (vec![*first; PARTICLES], vec![*first; PARTICLES]), options, seed).ok()
}

fn held(bytes: &[u8]) {
    let mut numbers = Numbers::new(bytes);
    let (scene, goals) = (arm_scene().expect("it is built in"), hand_goals().expect("it is built in"));
    let first = BodyParticle::at(&scene.skeleton, bending_elbow(1));
    let Some(mut tracker) = tracker(&first, options(&mut numbers), numbers.long()) else { return };
    let clean = arm_points(&scene, &bending_elbow(1)).blocks().to_vec();
    drive(&mut tracker, &scene, &guided_arm(&goals), &clean, &mut numbers, in_ranges);
}

fn moving_rod<'a>(goals: &'a LinearGoals, numbers: &mut Numbers<'_>) -> GuidedMotion<'a, LinearGoals, 6> {
    GuidedMotion {
        process: goals,
        root: RootProcess {
            persistence: numbers.number(0.5),
            std_per_sqrt_s: [0.3, 0.3, 0.3, 0.1, 0.1, 0.1].map(|std| numbers.number(std)),
            ..RootProcess::FIXED
        },
        angle_std_rad_per_sqrt_s: [1.0; 6].map(|std| numbers.number(std)),
        angle_persistence: numbers.number(0.0),
        solver_steps: 1 + numbers.below(3),
        pulling_blocks: numbers.below(5),
        refining_steps: numbers.below(3),
    }
}

fn rod_goals() -> LinearGoals {
    let process = LinearExtrapolation { persistence: 0.5, std_m_per_sqrt_s: 0.3 };
    LinearGoals::new(&[0], 1, process, 0.05).expect("it is built in")
}

fn free(bytes: &[u8]) {
    let mut numbers = Numbers::new(bytes);
    let (scene, goals) = (rod_scene().expect("it is built in"), rod_goals());
    let first = BodyParticle::at(&scene.skeleton, ROD_POSE);
    let alignment = (!numbers.flag()).then(|| alignment(&mut numbers));
    let options = BodyOptions { alignment, ..options(&mut numbers) };
    let Some(mut tracker) = tracker(&first, options, numbers.long()) else { return };
    let clean = rod_points(&scene, &ROD_POSE).blocks().to_vec();
    let motion = moving_rod(&goals, &mut numbers);
    drive(&mut tracker, &scene, &motion, &clean, &mut numbers, in_ranges);
}

fn new_rod(scene: &BodyScene<1, 6>) -> Tracker<1, 6> {
    tracker(&BodyParticle::at(&scene.skeleton, ROD_POSE), DEFAULT_BODY_OPTIONS, 1).expect("it is built in")
}

fn saved_seed() -> Vec<u8> {
    let scene = rod_scene().expect("it is built in");
    let mut tracker = new_rod(&scene);
    step_rod(&mut tracker, &scene);
    content(StateKind::Body, &mut tracker)
}

fn step_rod(tracker: &mut Tracker<1, 6>, scene: &BodyScene<1, 6>) {
    let (goals, clean) = (rod_goals(), rod_points(scene, &ROD_POSE));
    let mut numbers = Numbers::new(&[]);
    let motion = moving_rod(&goals, &mut numbers);
    // A state that is restored may lie at the edge of its ranges.
    drive(tracker, scene, &motion, clean.blocks(), &mut numbers, check_numbers);
}

fn saved(bytes: &[u8]) {
    let scene = rod_scene().expect("it is built in");
    let mut tracker = new_rod(&scene);
    if restore(StateKind::Body, 7, &mut tracker, &sealed(StateKind::Body, 7, bytes)).is_ok() {
        assert!(tracker.is_finite(), "a state out of its ranges was restored");
        step_rod(&mut tracker, &scene);
    }
}
