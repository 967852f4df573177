//! Importance weighting of the body's motion models against exact posteriors. The chain is so long
//! that its angles stay small: its ends are linear in them, and all densities are normal except for
//! the limits.

use nalgebra::{Matrix2, Vector2};
use sinew_core::kinematics::inverse::{Goal, PoseDensity, PoseObjective};
use sinew_core::math::{Mat3, Vec3};
use sinew_core::observation::point_cloud::{PointBlock, PointCloud};
use sinew_core::observation::point_likelihood::PointLikelihood;
use sinew_core::pik::end_effector::EndEffectorMotion;
use sinew_core::pik::goal::{GoalMemory, GoalPast, GoalProcess, Goals, MEMORY};
use sinew_core::pik::guided::GuidedMotion;
use sinew_core::pik::motion::{BodyMotion, BodyParticle, BodyScene, FramePast};
use sinew_core::pik::root::RootProcess;
use sinew_core::random::Stream;
use sinew_core::skeleton::{Bone, Joint, Limit, Skeleton};

/// Length of each of the two bones, metres.
const LENGTH_M: f32 = 20.0;
const DT_S: f32 = 0.25;
/// Standard deviations of an angle's change in a frame, of the reach, and of the goals about their
/// mean.
const ANGLE_STD_RAD: f32 = 0.01;
const REACH_STD_M: f32 = 0.2;
const GOAL_STD_M: f32 = 0.15;
/// The pose whose ends the goals lie about.
const GOAL_RAD: [f32; 2] = [0.012, 0.01];
const DRAWS: u32 = 60_000;
/// Largest distance of a mean or a second moment from the exact one, standard errors.
const MAX_STANDARD_ERRORS: f64 = 4.5;
/// Limits that nothing reaches; that cut off the mode in one angle; in both.
const NO_LIMIT: [[f32; 2]; 2] = [[-1.0, 1.0]; 2];
const ONE_LIMIT: [[f32; 2]; 2] = [[-0.02, 0.004], [-0.05, 0.05]];
const BOTH_LIMITS: [[f32; 2]; 2] = [[-0.02, 0.004], [-0.01, 0.008]];

/// Goals normal about two places.
struct Places {
    places_m: [Vec3; 2],
    std_m: f32,
}

impl GoalProcess<2> for Places {
    fn end_effectors(&self) -> &[usize] {
        &[0, 1]
    }

    fn draw(&self, _past: &GoalPast<'_, 2>, _memory: &mut GoalMemory, stream: &mut Stream, goals: &mut Goals) {
        for (bone, place_m) in self.places_m.iter().enumerate() {
            let position_m = place_m + stream.normal3() * self.std_m;
            let precision = Mat3::identity() / (REACH_STD_M * REACH_STD_M);
            goals.push(Goal { bone, position_m, precision }).expect("room for two");
        }
    }
}

fn scene(limits: [[f32; 2]; 2]) -> BodyScene<2, 2> {
    let bone = |parent| Bone { parent, joint: Joint::Hinge(Vec3::z()), offset_m: Vec3::x() * LENGTH_M };
    let limits = limits.map(|[low_rad, high_rad]| Limit { low_rad, high_rad });
    BodyScene {
        skeleton: Skeleton::new([bone(None), bone(Some(0))], limits).expect("a sound chain"),
        radii_m: [0.1; 2],
        camera_m: Vec3::new(0.0, 0.0, -5.0),
        likelihood: PointLikelihood { std_m: 0.15, outlier_m: 1.0 },
        self_penetration: None,
    }
}

/// Means and second moments: of the first angle, of both, of the second.
type Moments = [f64; 5];

/// The angles' monomials of first and second order.
fn monomials(angles_rad: [f32; 2]) -> Moments {
    let [a, b] = angles_rad.map(f64::from);
    [a, b, a * a, a * b, b * b]
}

fn moments(weighted: &[([f32; 2], f64)]) -> Moments {
    let total: f64 = weighted.iter().map(|(_, weight)| weight).sum();
    let mut values = [0.0; 5];
    for (angles, weight) in weighted {
        for (value, monomial) in values.iter_mut().zip(monomials(*angles)) {
            *value += weight * monomial / total;
        }
    }
    values
}

/// Draws of `motion` from the pose of rest with their weights, those of `blocks` included.
fn draw(scene: &BodyScene<2, 2>, motion: &impl BodyMotion<2, 2>, blocks: &[PointBlock]) -> Vec<([f32; 2], f64)> {
    let ancestor = BodyParticle::at(&scene.skeleton, [0.0; 2]);
    let past = FramePast {
        scene,
        blocks,
        angle_velocity_per_s: [0.0; 2],
        shared_change: [None; 2],
        velocity_m_per_s: &[Vec3::zeros(); 2],
        noise_share: &[1.0; 2],
        first_m: &ancestor.ends_m,
        dt_s: DT_S,
        is_first: true,
    };
    let one = |index| {
        let mut stream = Stream::new(1, 1, index);
        let proposed = motion.propose(&past, &ancestor, &mut [0.0; MEMORY], &mut stream);
        let log_points = scene.likelihood.log_likelihood(&scene.surface(&proposed.posture), blocks);
        (proposed.angles_rad, f64::from(proposed.log_ratio + log_points).exp())
    };
    (0..DRAWS).map(one).collect()
}

/// Moments of a density over the limits by a grid.
fn integrate(limits: [[f32; 2]; 2], steps: usize, density: impl Fn([f32; 2]) -> f64) -> Moments {
    let at = |angle: usize, index: usize| {
        let [low, high] = [limits[angle][0].max(-0.06), limits[angle][1].min(0.08)];
        low + (high - low) * (index as f32 + 0.5) / steps as f32
    };
    let place = |index: usize| [at(0, index / steps), at(1, index % steps)];
    let weighted: Vec<_> = (0..steps * steps).map(|index| (place(index), density(place(index)))).collect();
    moments(&weighted)
}

/// Each moment of `found`, which came of `weighted`, lies within [`MAX_STANDARD_ERRORS`] standard
/// errors of the exact one, on either side, and `slack` standard deviations.
fn assert_alike(weighted: &[([f32; 2], f64)], exact: &Moments, slack: f64) {
    let found = moments(weighted);
    let total: f64 = weighted.iter().map(|(_, weight)| weight).sum();
    for i in 0..5 {
        let square = |(angles, weight): &([f32; 2], f64)| {
            let off = monomials(*angles)[i] - found[i];
            [weight * off * off / total, (weight / total * off).powi(2)]
        };
        let [variance, squared_error] =
            weighted.iter().map(square).fold([0.0; 2], |sum, more| [sum[0] + more[0], sum[1] + more[1]]);
        let off = (found[i] - exact[i]).abs();
        let most = MAX_STANDARD_ERRORS * squared_error.sqrt() + slack * variance.sqrt();
        assert!(off < most, "moment {i}: {} instead of {}, {most} allowed", found[i], exact[i]);
    }
}

fn places(scene: &BodyScene<2, 2>, std_m: f32) -> Places {
    Places { places_m: scene.posture(&GOAL_RAD).ends, std_m }
}

fn end_effector(process: &Places) -> EndEffectorMotion<'_, Places, 2> {
    EndEffectorMotion {
        process,
        root: RootProcess::FIXED,
        angle_std_rad_per_sqrt_s: [ANGLE_STD_RAD / DT_S.sqrt(); 2],
        angle_persistence: 0.0,
        solver_steps: 20,
        by_gradient: false,
        corrects_weight: true,
        draw_share: 1.0,
    }
}

/// Eq. (12) for goals at the places themselves.
fn prior<'a>(scene: &'a BodyScene<2, 2>, goals: &'a Goals) -> PoseDensity<'a, 2, 2> {
    let stiffness = [1.0 / (ANGLE_STD_RAD * ANGLE_STD_RAD); 2];
    PoseDensity { skeleton: &scene.skeleton, root_m: Vec3::zeros(), goals, previous_rad: [0.0; 2], stiffness, held: 0 }
}

fn goals_at(places_m: &[Vec3; 2]) -> Goals {
    let precision = Mat3::identity() / (REACH_STD_M * REACH_STD_M);
    (0..2).map(|bone| Goal { bone, position_m: places_m[bone], precision }).collect()
}

/// Heights of both ends for small angles: J.
fn linear() -> Matrix2<f64> {
    Matrix2::new(1.0, 0.0, 2.0, 1.0) * f64::from(LENGTH_M)
}

/// J'J / reach^2 + lambda.
fn precision() -> Matrix2<f64> {
    let reach = f64::from(REACH_STD_M);
    linear().transpose() * linear() / (reach * reach) + Matrix2::identity() / f64::from(ANGLE_STD_RAD).powi(2)
}

/// The mode for goals at `heights_m`.
fn mode(heights_m: Vector2<f64>) -> Vector2<f64> {
    let reach = f64::from(REACH_STD_M);
    precision().try_inverse().expect("positive definite") * linear().transpose() * heights_m / (reach * reach)
}

fn goal_heights() -> Vector2<f64> {
    linear() * Vector2::new(f64::from(GOAL_RAD[0]), f64::from(GOAL_RAD[1]))
}

#[test]
fn without_limits_drawn_goals_give_the_normal_of_both_spreads_and_all_weights_are_alike() {
    let scene = scene(NO_LIMIT);
    let process = places(&scene, GOAL_STD_M);
    let weighted = draw(&scene, &end_effector(&process), &[]);
    // But for what a circle of 20 m leaves of a straight line.
    let off = weighted.iter().map(|(_, weight)| (weight - 1.0).abs()).sum::<f64>() / f64::from(DRAWS);
    assert!(off < 0.02, "{off}");
    let covariance = precision().try_inverse().expect("positive definite");
    let gain = covariance * linear().transpose() / f64::from(REACH_STD_M).powi(2);
    let covariance = covariance + gain * gain.transpose() * f64::from(GOAL_STD_M).powi(2);
    let mean = mode(goal_heights());
    let second = covariance + mean * mean.transpose();
    let values = [mean[0], mean[1], second[(0, 0)], second[(0, 1)], second[(1, 1)]];
    assert_alike(&weighted, &values, 0.005);
}

#[test]
fn with_active_limits_weighted_poses_are_those_of_the_density_cut_to_the_limits() {
    for limits in [ONE_LIMIT, BOTH_LIMITS] {
        let scene = scene(limits);
        let process = places(&scene, 0.0);
        let weighted = draw(&scene, &end_effector(&process), &[]);
        let goals = goals_at(&process.places_m);
        let prior = prior(&scene, &goals);
        let density = |angles| f64::from(prior.log_density(&angles, &prior.posture(&angles))).exp();
        let exact = integrate(limits, 500, density);
        assert_alike(&weighted, &exact, 0.005);
        // The draw alone is another density.
        let unpaid: Vec<_> = weighted.iter().map(|(angles, _)| (*angles, 1.0)).collect();
        let off = (moments(&unpaid)[1] - exact[1]).abs();
        assert!(off > 0.002, "{off}");
    }
}

/// The mass inside the limits is an estimate for each goal, so a small part of it stays: the slack.
#[test]
fn with_an_active_limit_drawn_goals_weigh_alike() {
    let scene = scene(ONE_LIMIT);
    let process = places(&scene, GOAL_STD_M);
    let weighted = draw(&scene, &end_effector(&process), &[]);
    let mut exact = [0.0; 5];
    let (count, spread) = (24, 3.5);
    let mut total = 0.0;
    for place in 0..count * count {
        let z = |index: usize| spread * (2.0 * (index as f64 + 0.5) / f64::from(count as u32) - 1.0);
        let z = Vector2::new(z(place / count), z(place % count));
        let share = (-0.5 * z.norm_squared()).exp();
        let centre = mode(goal_heights() + z * f64::from(GOAL_STD_M));
        let h = precision();
        let density = |angles: [f32; 2]| {
            let off = Vector2::from(angles.map(f64::from)) - centre;
            (-0.5 * off.dot(&(h * off))).exp()
        };
        for (value, part) in exact.iter_mut().zip(integrate(ONE_LIMIT, 60, density)) {
            *value += share * part;
        }
        total += share;
    }
    assert_alike(&weighted, &exact.map(|value| value / total), 0.05);
}

#[test]
fn guided_poses_are_those_of_prior_and_points_with_and_without_active_limits() {
    for limits in [NO_LIMIT, ONE_LIMIT, BOTH_LIMITS] {
        let scene = scene(limits);
        let process = places(&scene, 0.0);
        // Skin of both bones in another pose, seen from the camera.
        let there = scene.posture(&[0.02, -0.01]);
        let mut points: Vec<Vec3> = [(0, 0.9), (0, 0.7), (1, 0.4), (1, 0.95)]
            .map(|(bone, share)| there.joints[bone] + (there.ends[bone] - there.joints[bone]) * share - Vec3::z() * 0.1)
            .to_vec();
        let mut cloud = PointCloud::<4>::new();
        assert_eq!(cloud.set(&mut points, &scene.camera_m).over_capacity, 0);
        for blocks in [&[][..], cloud.blocks()] {
            let motion = GuidedMotion {
                process: &process,
                root: RootProcess::FIXED,
                angle_std_rad_per_sqrt_s: [ANGLE_STD_RAD / DT_S.sqrt(); 2],
                angle_persistence: 0.0,
                solver_steps: 20,
                pulling_blocks: 100,
                refining_steps: 0,
            };
            let weighted = draw(&scene, &motion, blocks);
            let goals = goals_at(&process.places_m);
            let prior = prior(&scene, &goals);
            let density = |angles| {
                let posture = prior.posture(&angles);
                let log_points = scene.likelihood.log_likelihood(&scene.surface(&posture), blocks);
                f64::from(prior.log_density(&angles, &posture) + log_points).exp()
            };
            let exact = integrate(limits, 300, density);
            assert_alike(&weighted, &exact, 0.005);
        }
    }
}
