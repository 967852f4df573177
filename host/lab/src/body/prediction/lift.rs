//! Figures 19 and 20 of the PIK paper: ten samples of a pelvic lift, and the precision of what they
//! are drawn from.

use crate::body::trial::SeenMotion;
use anyhow::{Context, Result};
use serde::Serialize;
use sinew::body::Placement;
use sinew::body::recording::DEFAULT_RATE_HZ;
use sinew::body::tracking::end_effectors::END_EFFECTORS;
use sinew::body::tracking::filter::WholeBodyParticle;
use sinew::body::tracking::{BodyFilter, BodyModelKind, BodyTuning};
use sinew::stereo::{StereoOptions, StereoScene, pelvic_lift};
use sinew_core::kinematics::forward::Posture;
use sinew_core::kinematics::inverse::{PoseDensity, PoseObjective, Solve};
use sinew_core::math::Vec3;
use sinew_core::pik::end_effector::narrow;
use sinew_core::pik::goal::{GoalPast, GoalProcess, Goals, MEMORY};
use sinew_core::pik::processes::pelvic_lift::FixedGoals;
use sinew_core::pik::processes::stick::StickSight;
use sinew_core::pik::proposal::LaplaceProposal;
use sinew_core::pik::root::RootProcess;
use sinew_core::random::Stream;
use sinew_core::skeleton::full_body::{
    BODY_ANGLES, BODY_BONES, BODY_JOINT_NAMES, FOREARMS, HEAD, PELVIS, SHANKS, THIGHS,
};
use std::ops::Range;

/// Samples that are drawn.
pub const SAMPLES: usize = 10;
/// The frame that is predicted: the pelvis is on its way up.
const FRAME: usize = 8;
/// Particles of the tracking up to there.
const PARTICLES: usize = 100;
/// Joints whose spread is reported.
const TOLD: [usize; 8] = [PELVIS, THIGHS[0], THIGHS[1], HEAD, FOREARMS[0], FOREARMS[1], SHANKS[0], SHANKS[1]];

/// Angles of one cluster of joints. Goals are behind each but the trunk, whose angles move head and
/// arms too.
pub const ANGLE_BLOCKS: [(&str, Range<usize>); 6] = [
    ("trunk", 6..9),
    ("head", 9..12),
    ("left arm", 12..16),
    ("right arm", 16..20),
    ("left leg", 20..25),
    ("right leg", 25..30),
];
/// Of these the first four move one goal of the upper body or more: the trunk with each other one.
const UPPER_BLOCKS: usize = 4;

/// Rows and columns of the precision: all angles but the root's.
pub type Precision = Vec<Vec<f64>>;

/// What the samples show.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LiftPrediction {
    /// Number of samples.
    pub samples: usize,
    /// Up and down standard deviation of the pelvis, metres.
    pub pelvis_up_std_m: f64,
    /// How far joints spread.
    pub joints: Vec<SampleSpread>,
    /// The precision of the importance distribution, mean over the samples.
    pub precision: BlockStructure,
}

/// How far the samples spread one joint.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SampleSpread {
    /// The joint.
    pub joint: &'static str,
    /// Root of the summed variances of its place, metres.
    pub spread_m: f64,
}

/// Mean sizes of the entries off the diagonal of a precision whose diagonal is scaled to one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct BlockStructure {
    /// Between angles of the same cluster.
    pub inside: f64,
    /// Between the trunk and head or an arm, which hang on it.
    pub trunk_with_upper: f64,
    /// Between any two clusters.
    pub between: f64,
    /// Between clusters that have no goal together: arms, head and legs among each other.
    pub apart: f64,
}

/// Ten samples, and what each was drawn from.
#[derive(Debug)]
pub struct LiftSamples {
    pub(super) radii_m: [f32; BODY_BONES],
    pub(super) postures: Vec<Posture<BODY_BONES, BODY_ANGLES>>,
    pub(super) precisions: Vec<Precision>,
}

/// Tracks the built-in lift to its ninth frame with the model of the pelvic lift. Then draws ten
/// samples of the next frame by PIK (22), PIK (38) and PIK (39). Each takes an ancestor by its
/// weight, the root, the goals and the mode of PIK (12). The pose comes from a Laplace expansion,
/// as wide as the models' `[draw]` says.
///
/// # Errors
/// Numbers of the model that break a rule.
pub fn draw(tuning: &BodyTuning, seed: u64) -> Result<(LiftPrediction, LiftSamples)> {
    let (filter, first_m, floor_y_m) = tracked(tuning, seed)?;
    let mut samples = LiftSamples { radii_m: filter.scene().radii_m, postures: Vec::new(), precisions: Vec::new() };
    for index in 0..SAMPLES {
        let ancestor = ancestor(&filter, (index as f32 + 0.5) / SAMPLES as f32);
        let mut stream = Stream::new(seed, FRAME as u64 + 1, index as u32);
        let (posture, precision) = sample(&filter, tuning, ancestor, (&first_m, floor_y_m), &mut stream)
            .context("a sample's precision cannot be factored")?;
        samples.postures.push(posture);
        samples.precisions.push(precision);
    }
    let spread = |bone: usize| SampleSpread {
        joint: BODY_JOINT_NAMES[bone],
        spread_m: variances(&samples.postures, bone).iter().sum::<f64>().sqrt(),
    };
    let prediction = LiftPrediction {
        samples: SAMPLES,
        pelvis_up_std_m: variances(&samples.postures, PELVIS)[1].sqrt(),
        joints: TOLD.map(spread).to_vec(),
        precision: block_structure(&samples.precisions),
    };
    Ok((prediction, samples))
}

/// The filter after the frame before the predicted one, the ends of the first pose, and the floor.
fn tracked(tuning: &BodyTuning, seed: u64) -> Result<(BodyFilter, [Vec3; BODY_BONES], f32)> {
    let placement = Placement::default();
    let mut recording = pelvic_lift(DEFAULT_RATE_HZ, placement.camera_height_m, placement.mean_distance_m)?;
    recording.joints_m.truncate(FRAME + 1);
    let seen = SeenMotion::of_scene(&StereoScene::new(recording, StereoOptions { seed, ..StereoOptions::default() })?)?;
    let (kind, floor_y_m) = (BodyModelKind::PelvicLift, placement.camera_height_m);
    let mut filter =
        BodyFilter::new(kind, *tuning, &seen.measures, seen.first_rad, PARTICLES, seed)?.above_floor(floor_y_m);
    let first_m = filter.scene().posture(&seen.first_rad).ends;
    for points_m in seen.clouds_m.iter().skip(1) {
        let blocks = filter.blocks(&mut points_m.clone());
        let _ = filter.step(&blocks, 1.0 / seen.rate_hz, StickSight::Unseen);
    }
    Ok((filter, first_m, floor_y_m))
}

/// The particle at which the sum of the weights passes `share`.
fn ancestor(filter: &BodyFilter, share: f32) -> &WholeBodyParticle {
    let (particles, weights) = filter.particles();
    let mut sum = 0.0;
    let passes = weights.iter().position(|weight| {
        sum += weight;
        sum >= share
    });
    &particles[passes.unwrap_or(particles.len() - 1)]
}

/// One sample's posture and the precision that it was drawn with; `None` where that is not positive
/// definite.
fn sample(
    filter: &BodyFilter,
    tuning: &BodyTuning,
    ancestor: &WholeBodyParticle,
    (first_m, floor_y_m): (&[Vec3; BODY_BONES], f32),
    stream: &mut Stream,
) -> Option<(Posture<BODY_BONES, BODY_ANGLES>, Precision)> {
    let (skeleton, dt_s) = (&filter.scene().skeleton, 1.0 / DEFAULT_RATE_HZ);
    let mut previous_rad = ancestor.angles_rad;
    let root = RootProcess::pelvic_lift(tuning.lift_std_m, tuning.lift_turn_std_rad, floor_y_m);
    root.draw(skeleton, &mut previous_rad, &[None; BODY_ANGLES], dt_s, stream);
    let past = GoalPast {
        reached_m: &ancestor.ends_m,
        velocity_m_per_s: &[Vec3::zeros(); BODY_BONES],
        noise_share: &[1.0; BODY_BONES],
        first_m,
        root_shift_m: Vec3::zeros(),
        dt_s,
        is_first: false,
    };
    let process = FixedGoals { end_effectors: &END_EFFECTORS, reach_std_m: tuning.lift_reach_std_m };
    let mut goals = Goals::new();
    process.draw(&past, &mut [0.0; MEMORY], stream, &mut goals);
    let held = skeleton.root_coordinates();
    let stiffness = tuning.end_effector.joint_std.per_angle().map(|std| 1.0 / (std * std * dt_s));
    let density = PoseDensity { skeleton, root_m: Vec3::zeros(), goals: &goals, previous_rad, stiffness, held };
    let mut mode = density.mode(tuning.end_effector.solver_steps);
    if !tuning.draw.corrects_weight {
        narrow(&mut mode, tuning.draw.share);
    }
    let drawn = LaplaceProposal::new(&mode)?.draw(skeleton.limits(), stream);
    let row = |i: usize| mode.hessian[i][held..].iter().map(|&entry| f64::from(entry)).collect();
    Some((density.posture(&drawn.angles_rad), (held..BODY_ANGLES).map(row).collect()))
}

/// Variances of the place of a bone's end along each axis, square metres.
fn variances(postures: &[Posture<BODY_BONES, BODY_ANGLES>], bone: usize) -> [f64; 3] {
    std::array::from_fn(|axis| {
        let places: Vec<f64> = postures.iter().map(|posture| f64::from(posture.ends[bone][axis])).collect();
        let mean = places.iter().sum::<f64>() / places.len() as f64;
        places.iter().map(|place| (place - mean) * (place - mean)).sum::<f64>() / (places.len() as f64 - 1.0)
    })
}

/// `precision` with its rows and columns scaled so that the diagonal is one.
#[must_use]
pub fn scaled(precision: &Precision) -> Precision {
    let root: Vec<f64> = precision.iter().enumerate().map(|(i, row)| row[i].sqrt()).collect();
    let row =
        |(i, row): (usize, &Vec<f64>)| row.iter().zip(&root).map(|(entry, other)| entry / (root[i] * other)).collect();
    precision.iter().enumerate().map(row).collect()
}

fn block_structure(precisions: &[Precision]) -> BlockStructure {
    let first = ANGLE_BLOCKS[0].1.start;
    let block_of = |row: usize| ANGLE_BLOCKS.iter().position(|(_, rows)| rows.contains(&(row + first)));
    let (mut sums, mut counts) = ([0.0; 3], [0.0; 3]);
    for precision in precisions.iter().map(scaled) {
        for (i, row) in precision.iter().enumerate() {
            for (j, entry) in row.iter().enumerate().take(i) {
                let kind = match (block_of(i), block_of(j)) {
                    (a, b) if a == b => 0,
                    (Some(a), Some(0)) if a < UPPER_BLOCKS => 1,
                    _ => 2,
                };
                sums[kind] += entry.abs();
                counts[kind] += 1.0;
            }
        }
    }
    let between = (sums[1] + sums[2]) / (counts[1] + counts[2]);
    let [inside, trunk_with_upper, apart] = std::array::from_fn(|kind| sums[kind] / counts[kind]);
    BlockStructure { inside, trunk_with_upper, between, apart }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_core::skeleton::full_body::BODY_ANGLE_NAMES;

    /// Seeds that are pooled: the variance of ten samples alone is known to a factor of two.
    const SEEDS: u64 = 6;

    /// The caption of figure 19: the pelvis varies up and down, the knees all ways, head, hands and
    /// feet little. And figure 20: blocks.
    #[test]
    fn samples_vary_where_nothing_is_known_and_their_precision_has_blocks() {
        let drawn: Vec<_> = (1..=SEEDS).map(|seed| draw(&BodyTuning::default(), seed).unwrap()).collect();
        let pooled = |squared: &dyn Fn(&LiftPrediction) -> f64| {
            (drawn.iter().map(|(lift, _)| squared(lift)).sum::<f64>() / SEEDS as f64).sqrt()
        };
        let of =
            |name: &str| pooled(&|lift| lift.joints.iter().find(|joint| joint.joint == name).unwrap().spread_m.powi(2));
        let up = pooled(&|lift| lift.pelvis_up_std_m.powi(2));
        assert!((0.06..0.15).contains(&up), "{up}");
        let sideways = ((of("pelvis").powi(2) - up.powi(2)) / 2.0).sqrt();
        assert!((2.0..4.0).contains(&(up / sideways)), "up {up} sideways {sideways}");
        let held = ["head", "l_wrist", "r_wrist", "l_ankle", "r_ankle"].map(of);
        let mean_held = held.iter().sum::<f64>() / 5.0;
        assert!((0.005..0.04).contains(&mean_held), "{held:?}");
        assert!(of("pelvis") > 1.8 * held.into_iter().fold(0.0, f64::max), "{} {held:?}", of("pelvis"));
        for knee in ["l_knee", "r_knee"] {
            assert!(of(knee) > 1.8 * mean_held && of(knee) < 0.3, "{knee} {} {held:?}", of(knee));
        }
        let (lift, samples) = &drawn[0];
        let BlockStructure { inside, trunk_with_upper, between, apart } = lift.precision;
        assert!((0.08..0.3).contains(&inside), "{inside}");
        assert!((0.04..0.2).contains(&trunk_with_upper), "{trunk_with_upper}");
        assert!((4.0..40.0).contains(&(inside / between)), "{inside} {between}");
        // Angles that move no goal together: exactly nothing.
        assert!(apart == 0.0, "{apart}");
        assert!(samples.precisions.iter().all(|precision| precision.len() == BODY_ANGLES - 6));
    }

    #[test]
    fn blocks_are_the_angles_of_their_joints() {
        for (name, range) in ANGLE_BLOCKS {
            let side = name.split(' ').next().unwrap().get(..1).unwrap();
            for angle in &BODY_ANGLE_NAMES[range] {
                let belongs = angle.starts_with(name) || angle.starts_with(&format!("{side}_"));
                assert!(belongs, "{angle} in {name}");
            }
        }
        assert_eq!(ANGLE_BLOCKS[5].1.end, BODY_ANGLES);
    }
}
