//! Figure 2 of the PIK paper: a hundred poses by noise of every angle, and by goals.

use anyhow::Result;
use serde::Serialize;
use sinew::body::tracking::end_effectors::END_EFFECTORS;
use sinew::body::tracking::filter::WholeBodyParticle;
use sinew_core::math::Vec3;
use sinew_core::observation::point_likelihood::PointLikelihood;
use sinew_core::pik::angular::AngularMotion;
use sinew_core::pik::end_effector::EndEffectorMotion;
use sinew_core::pik::goal::LinearExtrapolation;
use sinew_core::pik::motion::{BodyMotion, BodyParticle, BodyScene};
use sinew_core::pik::processes::extrapolation::LinearGoals;
use sinew_core::pik::root::RootProcess;
use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::full_body::{
    BODY_ANGLES, BODY_BONES, BODY_JOINT_NAMES, FOREARMS, HEAD, SHANKS, THIGHS, TRUNK, UPPER_ARMS, body_radii_m,
    full_body,
};
use sinew_core::tracker::body::{BodyFrame, BodyTracker, DEFAULT_BODY_OPTIONS};

/// Poses of each model.
pub const POSES: usize = 100;
/// Concentration of the noise of each angle; also the stiffness lambda of the model with goals.
pub const KAPPA: f32 = 500.0;
/// How closely each of the goals (head, wrists, ankles, where they are in the first pose) is
/// reached, metres.
pub const REACH_STD_M: f32 = 0.005;
/// Maximum number of steps of the solver.
const SOLVER_STEPS: usize = 4;
/// Joints whose spread is reported, down each chain.
const TOLD: [usize; 8] = [TRUNK, HEAD, UPPER_ARMS[0], FOREARMS[0], UPPER_ARMS[1], FOREARMS[1], THIGHS[0], SHANKS[0]];

type Scene = BodyScene<BODY_BONES, BODY_ANGLES>;

/// How far one joint is spread.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct JointSpread {
    /// The joint.
    pub joint: &'static str,
    /// Standard deviation of its place (root of the summed variances) under noise of the angles,
    /// metres.
    pub angular_m: f64,
    /// The same where head, wrists and ankles have goals, metres.
    pub end_effector_m: f64,
}

/// How far joints spread.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ChainSpread {
    /// Poses of each model.
    pub poses: usize,
    /// Concentration of each angle's noise, and the stiffness of the model with goals.
    pub kappa: f32,
    /// How closely goals are reached, metres.
    pub reach_std_m: f32,
    /// Neck and head; elbow and wrist of both arms; the left knee and ankle.
    pub joints: Vec<JointSpread>,
}

/// Poses of both models.
#[derive(Debug)]
pub struct ChainPoses {
    pub(super) scene: Scene,
    pub(super) angular: Vec<WholeBodyParticle>,
    pub(super) end_effector: Vec<WholeBodyParticle>,
}

/// Draws [`POSES`] poses around `first_rad` from each model; the root stays.
///
/// # Errors
/// Measures that no body has.
pub fn draw(measures: &BodyMeasures, first_rad: [f32; BODY_ANGLES], seed: u64) -> Result<(ChainSpread, ChainPoses)> {
    let scene = Scene {
        skeleton: full_body(measures)?,
        radii_m: body_radii_m(measures),
        camera_m: Vec3::zeros(),
        likelihood: PointLikelihood { std_m: 1.0, outlier_m: 1.0 },
        self_penetration: None,
    };
    let angle_std_rad_per_sqrt_s = [1.0 / KAPPA.sqrt(); BODY_ANGLES];
    let root = RootProcess::FIXED;
    let stays = LinearExtrapolation { persistence: 0.0, std_m_per_sqrt_s: 0.0 };
    let goals = LinearGoals::new(&END_EFFECTORS, BODY_BONES, stays, REACH_STD_M)?;
    let angular = AngularMotion { root, persistence: 0.0, angle_std_rad_per_sqrt_s, own_velocity: false };
    let by_goals = EndEffectorMotion {
        process: &goals,
        root,
        angle_std_rad_per_sqrt_s,
        angle_persistence: 0.0,
        solver_steps: SOLVER_STEPS,
        by_gradient: false,
        corrects_weight: false,
        draw_share: 1.0,
    };
    let (angular, angular_m) = poses(&scene, &angular, first_rad, seed)?;
    let (end_effector, end_effector_m) = poses(&scene, &by_goals, first_rad, seed)?;
    let joint = |bone: usize| JointSpread {
        joint: BODY_JOINT_NAMES[bone],
        angular_m: f64::from(angular_m[bone]),
        end_effector_m: f64::from(end_effector_m[bone]),
    };
    let joints = TOLD.map(joint).to_vec();
    let spread = ChainSpread { poses: POSES, kappa: KAPPA, reach_std_m: REACH_STD_M, joints };
    Ok((spread, ChainPoses { scene, angular, end_effector }))
}

/// Poses drawn by `motion`, and the spread of each bone's end, metres: a frame of a second without
/// points.
fn poses(
    scene: &Scene,
    motion: &impl BodyMotion<BODY_BONES, BODY_ANGLES>,
    first_rad: [f32; BODY_ANGLES],
    seed: u64,
) -> Result<(Vec<WholeBodyParticle>, [f32; BODY_BONES])> {
    let first = BodyParticle::at(&scene.skeleton, first_rad);
    let set = vec![first; POSES];
    let mut tracker =
        BodyTracker::<BODY_BONES, BODY_ANGLES, POSES, _>::new(&first, (set.clone(), set), DEFAULT_BODY_OPTIONS, seed)?;
    let estimate = tracker.step(scene, motion, &BodyFrame { dt_s: 1.0, blocks: &[] });
    Ok((tracker.particles().to_vec(), estimate.spread_m))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Arms out to the sides and a little forward, elbows and knees bent: no limit is near.
    fn standing() -> [f32; BODY_ANGLES] {
        let mut angles = [0.0; BODY_ANGLES];
        angles[2] = 3.0;
        for (index, angle) in [
            (12, 1.2),
            (13, 0.2),
            (15, 0.9),
            (16, 1.2),
            (17, 0.2),
            (19, 0.9),
            (20, 0.3),
            (25, 0.3),
            (23, 0.6),
            (28, 0.6),
        ] {
            angles[index] = angle;
        }
        angles
    }

    /// The caption of PIK figure 2, as numbers. Under noise of the angles the spread of the joints
    /// grows along every chain. With goals the ends spread no more than the middle.
    #[test]
    fn spread_grows_down_the_chains_under_angular_noise_and_not_under_goals() {
        let measures = BodyMeasures::of_height(1.75).unwrap();
        let (spread, chains) = draw(&measures, standing(), 1).unwrap();
        assert_eq!((chains.angular.len(), chains.end_effector.len()), (POSES, POSES));
        let of = |name: &str| spread.joints.iter().find(|joint| joint.joint == name).copied().unwrap();
        for [middle, end] in [["neck", "head"], ["l_elbow", "l_wrist"], ["r_elbow", "r_wrist"], ["l_knee", "l_ankle"]] {
            let (middle, end) = (of(middle), of(end));
            let grows = end.angular_m / middle.angular_m;
            let shrinks = end.end_effector_m / middle.end_effector_m;
            assert!((1.2..2.5).contains(&grows), "{}: {grows}", end.joint);
            assert!((0.4..1.1).contains(&shrinks), "{}: {shrinks}", end.joint);
        }
    }

    /// Three angles turn the neck about the pelvis, one of them (turning) not at all: two standard
    /// deviations of 1/sqrt(kappa) times the trunk's length.
    #[test]
    fn the_necks_spread_is_that_of_two_angles() {
        let measures = BodyMeasures::of_height(1.75).unwrap();
        let (spread, _) = draw(&measures, standing(), 2).unwrap();
        let wanted_m = f64::from(measures.trunk_m) * (2.0 / f64::from(KAPPA)).sqrt();
        let ratio = spread.joints[0].angular_m / wanted_m;
        // A standard deviation of 200 normals is good to 5 %.
        assert!((0.85..1.15).contains(&ratio), "{ratio}");
    }
}
