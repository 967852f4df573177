//! Small bodies, points and pasts, for examples and tests.
//!
//! ```
//! use sinew_core::pik::example::{arm_past, arm_points, arm_scene, bending_elbow, guided_arm, hand_goals};
//! use sinew_core::pik::goal::MEMORY;
//! use sinew_core::pik::motion::{BodyMotion, BodyParticle};
//! use sinew_core::random::Stream;
//!
//! let (scene, goals) = (arm_scene()?, hand_goals()?);
//! let ancestor = BodyParticle::at(&scene.skeleton, bending_elbow(0));
//! let cloud = arm_points(&scene, &bending_elbow(1));
//! let past = arm_past(&scene, &ancestor, cloud.blocks());
//! let moved = guided_arm(&goals).propose(&past, &ancestor, &mut [0.0; MEMORY], &mut Stream::new(1, 0, 0));
//! assert_eq!(moved.posture, scene.posture(&moved.angles_rad));
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

use super::goal::{GoalPast, LinearExtrapolation};
use super::guided::GuidedMotion;
use super::motion::{BodyParticle, BodyScene, FramePast};
use super::processes::extrapolation::LinearGoals;
use super::root::RootProcess;
use crate::error::ParameterError;
use crate::kinematics::inverse::{Goal, PoseDensity};
use crate::math::{Mat3, Vec3};
use crate::observation::point_cloud::{PointBlock, PointCloud};
use crate::observation::point_likelihood::PointLikelihood;
use crate::skeleton::arm::{ARM_ANGLES, ARM_BONES, FOREARM};
use crate::skeleton::{ArmGeometry, Bone, Joint, Limit, Side, Skeleton};

/// Velocities and shares of noise of bones that stand still.
struct Still<const BONES: usize>;

impl<const BONES: usize> Still<BONES> {
    const VELOCITY_M_PER_S: [Vec3; BONES] = [Vec3::new(0.0, 0.0, 0.0); BONES];
    const NOISE_SHARE: [f32; BONES] = [1.0; BONES];
}

/// A left arm at the origin, two metres away from its camera.
///
/// # Errors
/// None.
pub fn arm_scene() -> Result<BodyScene<ARM_BONES, ARM_ANGLES>, ParameterError> {
    Ok(BodyScene {
        skeleton: ArmGeometry::new(Side::Left, 0.30, 0.35)?.skeleton()?,
        radii_m: [0.05, 0.04],
        camera_m: Vec3::new(0.0, 0.0, -2.0),
        likelihood: PointLikelihood { std_m: 0.05, outlier_m: 0.15 },
        self_penetration: None,
    })
}

/// The pose of an arm whose elbow bends by 0.05 rad a frame, from 1 rad.
#[must_use]
pub fn bending_elbow(frame: usize) -> [f32; ARM_ANGLES] {
    [0.5, 0.1, 0.1, 1.0 + 0.05 * frame as f32]
}

/// Thirty-two points on the visible skin of an arm in a pose.
#[must_use]
pub fn arm_points(scene: &BodyScene<ARM_BONES, ARM_ANGLES>, pose: &[f32; ARM_ANGLES]) -> PointCloud<2> {
    let surface = scene.surface(&scene.posture(pose));
    let mut points_m = core::array::from_fn::<Vec3, 32, _>(|i| {
        let bone = &surface.capsules[i % 2].capsule;
        let place_m = bone.start_m + (bone.end_m - bone.start_m) * (i as f32 / 32.0);
        bone.nearest_visible(&scene.camera_m, &(place_m - Vec3::z()))
    });
    let mut cloud = PointCloud::new();
    let _ = cloud.set(&mut points_m, &scene.camera_m);
    cloud
}

/// A first frame, 0.1 s after `ancestor`, of an arm that stood still; `blocks` are its points.
#[must_use]
pub fn arm_past<'a>(
    scene: &'a BodyScene<ARM_BONES, ARM_ANGLES>,
    ancestor: &'a BodyParticle<ARM_BONES, ARM_ANGLES>,
    blocks: &'a [PointBlock],
) -> FramePast<'a, ARM_BONES, ARM_ANGLES> {
    FramePast {
        scene,
        blocks,
        angle_velocity_per_s: [0.0; ARM_ANGLES],
        shared_change: [None; ARM_ANGLES],
        velocity_m_per_s: &Still::<ARM_BONES>::VELOCITY_M_PER_S,
        noise_share: &Still::<ARM_BONES>::NOISE_SHARE,
        first_m: &ancestor.ends_m,
        dt_s: 0.1,
        is_first: true,
    }
}

/// The past of goals in a first frame, 0.1 s after bones whose ends stood still at `reached_m`,
/// metres.
#[must_use]
pub fn goal_past<const BONES: usize>(reached_m: &[Vec3; BONES]) -> GoalPast<'_, BONES> {
    GoalPast {
        reached_m,
        velocity_m_per_s: &Still::<BONES>::VELOCITY_M_PER_S,
        noise_share: &Still::<BONES>::NOISE_SHARE,
        first_m: reached_m,
        root_shift_m: Vec3::zeros(),
        dt_s: 0.1,
        is_first: true,
    }
}

/// A linear process of the hand's goal.
///
/// # Errors
/// None.
pub fn hand_goals() -> Result<LinearGoals, ParameterError> {
    LinearGoals::new(&[FOREARM], ARM_BONES, LinearExtrapolation { persistence: 0.5, std_m_per_sqrt_s: 0.3 }, 0.05)
}

/// An arm's guided motion with these goals.
#[must_use]
pub const fn guided_arm(goals: &LinearGoals) -> GuidedMotion<'_, LinearGoals, ARM_ANGLES> {
    GuidedMotion {
        process: goals,
        root: RootProcess::FIXED,
        angle_std_rad_per_sqrt_s: [1.0; ARM_ANGLES],
        angle_persistence: 0.0,
        solver_steps: 3,
        pulling_blocks: 2,
        refining_steps: 0,
    }
}

/// A goal for the hand of a right arm, known to 2 cm.
#[must_use]
pub fn hand_goal() -> [Goal; 1] {
    [Goal { bone: FOREARM, position_m: Vec3::new(-0.3, 0.3, -0.2), precision: Mat3::identity() * 2500.0 }]
}

/// A right arm.
///
/// # Errors
/// None.
pub fn right_arm() -> Result<Skeleton<ARM_BONES, ARM_ANGLES>, ParameterError> {
    ArmGeometry::new(Side::Right, 0.30, 0.35)?.skeleton()
}

/// The density of poses of [`right_arm`] near one pose, of which the hand reaches for `goals`.
#[must_use]
pub fn reaching_arm<'a>(
    skeleton: &'a Skeleton<ARM_BONES, ARM_ANGLES>,
    goals: &'a [Goal],
) -> PoseDensity<'a, ARM_BONES, ARM_ANGLES> {
    let previous_rad = [0.6, 0.1, 0.1, 0.9];
    PoseDensity { skeleton, root_m: Vec3::zeros(), goals, previous_rad, stiffness: [50.0; ARM_ANGLES], held: 0 }
}

/// A rod of 0.6 m that moves freely, in camera axes.
///
/// # Errors
/// None.
pub fn rod_scene() -> Result<BodyScene<1, 6>, ParameterError> {
    let (x, y, z) = (Vec3::x(), Vec3::y(), Vec3::z());
    let rod = Bone { parent: None, joint: Joint::Free([x, y, z, y, z, x]), offset_m: y * 0.6 };
    Ok(BodyScene {
        skeleton: Skeleton::new([rod], [Limit { low_rad: -10.0, high_rad: 10.0 }; 6])?,
        radii_m: [0.1],
        camera_m: Vec3::zeros(),
        likelihood: PointLikelihood { std_m: 0.05, outlier_m: 0.25 },
        self_penetration: None,
    })
}

/// Forty-eight points on the visible skin of the rod in a pose.
#[must_use]
pub fn rod_points(scene: &BodyScene<1, 6>, pose: &[f32; 6]) -> PointCloud<3> {
    let skin = scene.surface(&scene.posture(pose)).capsules[0].capsule;
    let mut points_m = core::array::from_fn::<Vec3, 48, _>(|i| {
        let place_m = skin.start_m + (skin.end_m - skin.start_m) * (i as f32 / 47.0);
        skin.nearest_visible(&scene.camera_m, &(place_m + [Vec3::x(), -Vec3::x(), -Vec3::z()][i % 3]))
    });
    let mut cloud = PointCloud::new();
    let _ = cloud.set(&mut points_m, &scene.camera_m);
    cloud
}
