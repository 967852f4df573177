//! A whole body from 3D points of a stereo camera: somebody bends the right elbow, 3 m away.
//!
//!     cargo run --release -p sinew-core --example body_from_points

use sinew_core::error::ParameterError;
use sinew_core::math::Vec3;
use sinew_core::observation::point_cloud::{LeftOut, PointCloud};
use sinew_core::observation::point_likelihood::PointLikelihood;
use sinew_core::pik::goal::LinearExtrapolation;
use sinew_core::pik::guided::GuidedMotion;
use sinew_core::pik::motion::{BodyParticle, BodyScene};
use sinew_core::pik::processes::extrapolation::LinearGoals;
use sinew_core::pik::root::RootProcess;
use sinew_core::random::Stream;
use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::full_body::{BODY_ANGLES, BODY_BONES, FOREARMS, HEAD, body_radii_m, full_body};
use sinew_core::tracker::body::{BodyFrame, BodyTracker, DEFAULT_BODY_OPTIONS};

const PARTICLES: usize = 50;
const FRAMES: usize = 30;

/// Coordinate 2 is the root's distance, 16 and 19 are angles of the right shoulder and elbow.
fn true_pose(frame: usize) -> [f32; BODY_ANGLES] {
    let mut pose = [0.0; BODY_ANGLES];
    (pose[2], pose[16], pose[19]) = (3.0, 0.5, 0.5 + 0.04 * frame as f32);
    pose
}

/// Points on the half of the skin that the camera sees.
fn look(scene: &BodyScene<BODY_BONES, BODY_ANGLES>, frame: usize) -> PointCloud<50> {
    let surface = scene.surface(&scene.posture(&true_pose(frame)));
    let mut stream = Stream::new(7, frame as u64, 0);
    let mut points_m = Vec::new();
    for seen in surface.capsules.iter().cycle().take(800) {
        let axis_m = seen.capsule.start_m + seen.along_m * stream.uniform();
        let out = stream.normal3().normalize();
        let towards_camera = if out.dot(&axis_m) > 0.0 { -out } else { out };
        points_m.push(axis_m + towards_camera * seen.capsule.radius_m);
    }
    let mut cloud = PointCloud::new();
    assert_eq!(cloud.set(&mut points_m, &scene.camera_m), LeftOut::default(), "800 points fit into 50 blocks");
    cloud
}

fn main() -> Result<(), ParameterError> {
    let measures = BodyMeasures::of_height(1.75)?;
    let scene = BodyScene {
        skeleton: full_body(&measures)?,
        radii_m: body_radii_m(&measures),
        camera_m: Vec3::zeros(),
        likelihood: PointLikelihood { std_m: 0.15, outlier_m: 0.25 },
        self_penetration: None,
    };
    let process = LinearExtrapolation { persistence: 0.5, std_m_per_sqrt_s: 0.3 };
    let goals = LinearGoals::new(&[HEAD, FOREARMS[0], FOREARMS[1]], BODY_BONES, process, 0.05)?;
    let motion = GuidedMotion {
        process: &goals,
        root: RootProcess::FIXED,
        angle_std_rad_per_sqrt_s: [1.0; BODY_ANGLES],
        angle_persistence: 0.0,
        solver_steps: 2,
        pulling_blocks: 32,
        refining_steps: 2,
    };
    let first = BodyParticle::at(&scene.skeleton, true_pose(0));
    let memory = (vec![first; PARTICLES], vec![first; PARTICLES]);
    let mut tracker =
        BodyTracker::<BODY_BONES, BODY_ANGLES, PARTICLES, _>::new(&first, memory, DEFAULT_BODY_OPTIONS, 1)?;
    let mut error_m = 0.0;
    for frame in 1..FRAMES {
        let cloud = look(&scene, frame);
        let estimate = tracker.step(&scene, &motion, &BodyFrame { dt_s: 1.0 / 15.0, blocks: cloud.blocks() });
        let hand_m = scene.posture(&true_pose(frame)).ends[FOREARMS[1]];
        error_m += (estimate.ends_m[FOREARMS[1]] - hand_m).norm() / (FRAMES - 1) as f32;
    }
    println!("mean error of the right hand: {:.1} cm, with {PARTICLES} particles", 100.0 * error_m);
    assert!(error_m < 0.08, "{error_m} m");
    Ok(())
}
