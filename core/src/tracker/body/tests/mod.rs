//! The tracker as a whole, on a body that waves before a camera.

mod accuracy;
mod rival;
mod state;
mod unseen;
mod weighing;

use super::*;
use crate::kinematics::forward::posture;
use crate::math::Vec3;
use crate::observation::point_cloud::PointCloud;
use crate::observation::point_likelihood::PointLikelihood;
use crate::observation::self_penetration::SelfPenetration;
use crate::pik::angular::AngularMotion;
use crate::pik::end_effector::EndEffectorMotion;
use crate::pik::goal::LinearExtrapolation;
use crate::pik::guided::GuidedMotion;
use crate::pik::motion::{BodyMotion, BodyParticle, BodyScene};
use crate::pik::processes::extrapolation::LinearGoals;
use crate::pik::root::{NO_PLANES, RootProcess};
use crate::random::Stream;
use crate::saved_state::{StateError, StateKind, restore, save, saved_bytes};
use crate::skeleton::BodyMeasures;
use crate::skeleton::full_body::{
    BODY_ANGLES, BODY_BONES, COLLARS, FOREARMS, HEAD, SHANKS, TRUNK, UPPER_ARMS, body_radii_m, full_body,
};

type Scene = BodyScene<BODY_BONES, BODY_ANGLES>;
type Particle = BodyParticle<BODY_BONES, BODY_ANGLES>;
type Cloud = PointCloud<128>;
type Tracker = BodyTracker<BODY_BONES, BODY_ANGLES, 256, Vec<Particle>>;

/// Index of the trunk's tilt to the side.
const TRUNK_TILT: usize = 7;
const DT_S: f32 = 1.0 / 15.0;
const ROOT: RootProcess =
    RootProcess { persistence: 0.5, std_per_sqrt_s: [0.1, 0.1, 0.1, 0.2, 0.2, 0.2], shift_limits_m: NO_PLANES };
const ANGLE_STD: [f32; BODY_ANGLES] = [1.0; BODY_ANGLES];

fn scene() -> Scene {
    let measures = BodyMeasures::of_height(1.75).unwrap();
    Scene {
        skeleton: full_body(&measures).unwrap(),
        radii_m: body_radii_m(&measures),
        camera_m: Vec3::zeros(),
        likelihood: PointLikelihood { std_m: 0.15, outlier_m: 0.25 },
        self_penetration: None,
    }
}

/// A person 3 m away whose left arm waves.
fn truth(frame: usize) -> [f32; BODY_ANGLES] {
    let mut angles = [0.0; BODY_ANGLES];
    angles[2] = 3.0;
    let phase = 0.25 * frame as f32;
    angles[12] = 1.2 + 0.5 * phase.sin();
    angles[15] = 0.8 + 0.4 * phase.cos();
    angles
}

/// Points on the visible skin; none on bones that `hides` names.
fn cloud(scene: &Scene, frame: usize, hides: &[usize]) -> Cloud {
    cloud_of(scene, &truth(frame), frame, hides)
}

fn cloud_of(scene: &Scene, pose_rad: &[f32; BODY_ANGLES], frame: usize, hides: &[usize]) -> Cloud {
    let surface = scene.surface(&scene.posture(pose_rad));
    let mut stream = Stream::new(50, frame as u64, 0);
    let mut points = Vec::new();
    for seen in &surface.capsules {
        let count = (600.0 * seen.capsule.radius_m * (seen.along_m.norm() + seen.capsule.radius_m)) as usize * 5;
        for _ in 0..count {
            let axis = seen.capsule.start_m + seen.along_m * stream.uniform();
            let direction = stream.normal3().normalize();
            let direction = if direction.dot(&axis) > 0.0 { -direction } else { direction };
            if !hides.contains(&seen.bone) {
                points.push(axis + direction * seen.capsule.radius_m + stream.normal3() * 0.01);
            }
        }
    }
    let mut cloud = Cloud::new();
    let _ = cloud.set(&mut points, &Vec3::zeros());
    cloud
}

fn goals() -> LinearGoals {
    let process = LinearExtrapolation { persistence: 0.5, std_m_per_sqrt_s: 0.2 };
    LinearGoals::new(&[HEAD, FOREARMS[0], FOREARMS[1], SHANKS[0], SHANKS[1]], BODY_BONES, process, 0.05).unwrap()
}

fn end_effector(process: &LinearGoals) -> EndEffectorMotion<'_, LinearGoals, BODY_ANGLES> {
    EndEffectorMotion {
        process,
        root: ROOT,
        angle_std_rad_per_sqrt_s: ANGLE_STD,
        angle_persistence: 0.0,
        solver_steps: 2,
        by_gradient: false,
        corrects_weight: false,
        draw_share: 1.0,
    }
}

fn guided(process: &LinearGoals) -> GuidedMotion<'_, LinearGoals, BODY_ANGLES> {
    GuidedMotion {
        process,
        root: ROOT,
        angle_std_rad_per_sqrt_s: ANGLE_STD,
        angle_persistence: 0.0,
        solver_steps: 2,
        pulling_blocks: 32,
        refining_steps: 0,
    }
}

const ANGULAR: AngularMotion<BODY_ANGLES> =
    AngularMotion { root: ROOT, persistence: 0.5, angle_std_rad_per_sqrt_s: [0.6; BODY_ANGLES], own_velocity: false };

const PACE: SpeedScaledNoise = SpeedScaledNoise {
    rest_share: 0.4,
    full_speed_m_per_s: 1.3,
    max_scale_seen: 1.0,
    fade_s: 0.3,
    unseen_growth_s: 0.5,
    max_scale_unseen: 2.0,
};

const OPTIONS: BodyOptions = BodyOptions {
    least_effective_share: 0.14,
    limb_by_limb: false,
    alignment: Some(RootAlignment {
        steps: 2,
        coarse_to_fine: false,
        shift_std_m_per_sqrt_s: 0.3,
        turn_std_rad_per_sqrt_s: 0.6,
        angle_std_rad_per_sqrt_s: 1.0,
        pulling_blocks: 64,
        fit_trunk: true,
    }),
    jitter_std_errors: 0.0,
    jitter_std_m: 0.0,
    rival: None,
    pace: None,
    acceleration_share: 0.0,
};

const LIMB_BY_LIMB: BodyOptions = BodyOptions { least_effective_share: 0.2, limb_by_limb: true, ..OPTIONS };

fn tracker(scene: &Scene, count: usize, seed: u64) -> Tracker {
    tracker_of(scene, count, seed, OPTIONS)
}

fn tracker_of(scene: &Scene, count: usize, seed: u64, options: BodyOptions) -> Tracker {
    let first = Particle::at(&scene.skeleton, truth(0));
    Tracker::new(&first, (vec![first; count], vec![first; count]), options, seed).unwrap()
}
