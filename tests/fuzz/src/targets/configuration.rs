//! Configurations, and trackers that have them.

use crate::Target;
use crate::numbers::Numbers;
use sinew::body::run::tuning_file;
use sinew::body::tracking::{BodyFilter, BodyModelKind};
use sinew::config::{Config, DEFAULT_FILE};
use sinew::frames::FrameView;
use sinew::track::{ArmSet, SideChoice};
use sinew_core::math::Vec3;
use sinew_core::observation::point_cloud::PointBlock;
use sinew_core::pik::processes::stick::StickSight;
use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::full_body::BODY_ANGLES;
use sinew_core::tracker::arm::example::hand_blob;

/// The configurations of `track arm` and of `track body`.
pub const TARGETS: &[Target] = &[
    Target { name: "arm_config", run: arm, seeds: || vec![DEFAULT_FILE.into(), few_keys().into()] },
    Target { name: "body_config", run: body, seeds: body_seeds },
];

/// The models of a body that differ in their steps.
const KINDS: [BodyModelKind; 5] = [
    BodyModelKind::EndEffector,
    BodyModelKind::Guided,
    BodyModelKind::Angular,
    BodyModelKind::Stick,
    BodyModelKind::PelvicLift,
];
/// Frames of each tracker.
const FRAMES: u64 = 3;
/// Particles of a body, and most of an arm: this is about the numbers, not about their sum.
const PARTICLES: usize = 12;

fn few_keys() -> &'static str {
    "[camera]\nhorizontal_field_of_view_deg = 60.0\n[body]\nheight_m = 1.8\n[tracker]\nparticles = 20\nvariant = \"pik\"\n\
    gate = false\n[tracker.hough]\nbins = 18\n[likelihood]\narea_fractions = [0.01, 0.1]\n[edges]\nmin_motion = 9.0\n"
}

fn arm(bytes: &[u8]) {
    let Ok(mut config) = Config::parse(&String::from_utf8_lossy(bytes)) else { return };
    config.tracker.particles = config.tracker.particles.min(PARTICLES);
    for side in [SideChoice::Left, SideChoice::Both] {
        let Ok(mut arms) = ArmSet::new(&config, (640, 480), side, 1) else { return };
        let view = FrameView { candidates: vec![hand_blob()], ..FrameView::default() };
        for frame in 0..FRAMES {
            for view in arms.step(66_667 * frame, Some(&view)) {
                let joints = view.estimate.joints;
                let all = [joints.shoulder_m, joints.elbow_m, joints.hand_m];
                assert!(all.iter().flatten().all(|coordinate| coordinate.is_finite()), "{joints:?}");
            }
        }
        let saved = arms.saved().expect("it can be saved");
        arms.restore(&saved).expect("it was saved");
    }
}

fn body_seeds() -> Vec<Vec<u8>> {
    let printed = tuning_file::printed().expect("defaults can be printed");
    vec![printed.into_bytes(), b"[root]\npersistence = 0.5\n[pace]\nrest_share = 1\n".to_vec(), Vec::new()]
}

fn body(bytes: &[u8]) {
    let Ok(mut tuning) = tuning_file::parse(&String::from_utf8_lossy(bytes)) else { return };
    let measures = BodyMeasures::of_height(1.7).expect("a usual height");
    let kind = KINDS[bytes.len() % KINDS.len()];
    // A file may ask for a hundred steps of a solver, each over a million blocks.
    tuning.end_effector.solver_steps = tuning.end_effector.solver_steps.min(4);
    tuning.guided.solver_steps = tuning.guided.solver_steps.min(4);
    let mut first = [0.0; BODY_ANGLES];
    first[2] = 3.0;
    let Ok(mut filter) = BodyFilter::new(kind, tuning, &measures, first, PARTICLES, 1) else { return };
    let blocks = filter.blocks(&mut points());
    steps(&mut filter, &blocks);
}

/// A plate of points where a body may be.
pub fn points() -> Vec<Vec3> {
    (0..60).map(|i| Vec3::new((i % 6) as f32 * 0.05, (i / 6) as f32 * 0.1 - 0.5, 2.9)).collect()
}

/// Steps of a body, whose answers are numbers.
pub fn steps(filter: &mut BodyFilter, blocks: &[PointBlock]) {
    for _ in 0..FRAMES {
        let estimate = filter.step(blocks, 1.0 / 15.0, StickSight::Unseen);
        assert!(estimate.angles_rad.iter().all(|angle| angle.is_finite()), "{estimate:?}");
        assert!(estimate.spread_m.iter().all(|spread_m| *spread_m >= 0.0), "{estimate:?}");
    }
}

/// A filter of a whole body for other targets.
pub fn body_filter(numbers: &mut Numbers<'_>) -> BodyFilter {
    let measures = BodyMeasures::of_height(1.7).expect("a usual height");
    let kind = KINDS[numbers.below(KINDS.len())];
    let mut first = [0.0; BODY_ANGLES];
    first[2] = 3.0;
    BodyFilter::new(kind, sinew::body::tracking::BodyTuning::default(), &measures, first, PARTICLES, 1)
        .expect("the defaults are legal")
}
