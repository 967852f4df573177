//! The first pose where only points are known: someone upright, who stands or walks and faces any
//! way, is fitted to them.

use super::tuning::PointTuning;
use super::turned_round::turned_round;
use crate::body::fitting::standing;
use crate::body::{BodyPart, BodySize};
use crate::error::Result;
use crate::wording::side_name;
use rayon::prelude::*;
use sinew_core::kinematics::inverse::{PoseDensity, Solve};
use sinew_core::math::{Vec3, wrap_angle};
use sinew_core::observation::point_cloud::PointBlock;
use sinew_core::observation::point_likelihood::PointLikelihood;
use sinew_core::pik::guided::GuidedDensity;
use sinew_core::pik::motion::BodyScene;
use sinew_core::skeleton::Side;
use sinew_core::skeleton::full_body::{BODY_ANGLE_NAMES, BODY_ANGLES, BODY_BONES, full_body};
use sinew_core::skeleton::tree::{FREE_ROOT_COORDINATES, SHIFTS};
use std::f32::consts::{FRAC_PI_2, TAU};

/// Points lie on the near skin, so the body's middle is as much behind theirs, metres.
const HALF_DEPTH_M: f32 = 0.1;
/// Where a body stands if there are no points at all, metres before the camera.
const NO_POINTS_Z_M: f32 = 3.0;
/// The middle of an upper body lies so much of the trunk above the pelvis.
const UPPER_MIDDLE_SHARE: f32 = 0.7;
/// Ways that a guess faces. Chosen: with four instead of eight a quarter more starts are wrong.
const HEADINGS: usize = 8;
/// Elevation and deviation of both shoulders, radians: arms that hang, a T and an A.
const ARMS_RAD: [[f32; 2]; 3] = [[0.0, 0.0], [1.5, -0.7], [0.7, -0.4]];
/// Flexion of the left and the right hip, radians: standing, and a stride with either leg ahead.
const LEGS_RAD: [[f32; 2]; 3] = [[0.0, 0.0], [0.45, -0.3], [-0.3, 0.45]];
/// From which distance on points count as outliers, stage by stage, metres: far ones pull first.
const STAGES_M: [f32; 3] = [0.8, 0.45, 0.25];
/// Steps of a stage from each guess. Chosen: eight find no more.
const SEARCH_STEPS: usize = 4;
/// Steps from the best of them.
const STEPS: usize = 25;
/// Log likelihood of a point, on the mean, by which a pose has to be likelier than one that faces
/// the other way. A mean over the points, since neighbours err alike.
/// Chosen: of 207 starts of twelve tuning clips a third of those below it face the wrong way after
/// half a second, a twentieth of those above (docs/measurements_scenes.md).
const MIN_FACING_MARGIN: f32 = 0.01;
/// Share of the points that no skin of an upper body explains, from which on legs may be in view.
/// Chosen: a tenth is as much as false matches make; legs are two fifths of a standing body.
const MOST_UNEXPLAINED: f32 = 0.1;
/// How far the root is from the guess, metres and radians, and how far the other angles.
const SHIFT_STD_M: f32 = 0.5;
const TURN_STD_RAD: f32 = 0.5;
const ANGLE_STD_RAD: f32 = 0.4;

/// A first pose, and how much likelier it is than one that faces the other way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstPose {
    /// Coordinates inside the limits.
    pub angles_rad: [f32; BODY_ANGLES],
    /// The same person facing the other way.
    pub opposite_rad: [f32; BODY_ANGLES],
    /// Log likelihood of a point, on the mean, over that of the opposite. Not below zero; zero
    /// without points.
    pub facing_margin: f32,
    /// Log likelihood of all points, or their log evidence where they are of several frames.
    pub log_evidence: f32,
    /// Share of the points that are farther from the skin than an outlier is.
    pub unexplained_share: f32,
}

impl FirstPose {
    /// Whether the points do not decide which of two opposite ways the person faces.
    #[must_use]
    pub fn is_facing_doubtful(&self) -> bool {
        self.facing_margin < MIN_FACING_MARGIN
    }

    /// How the person is turned, for a message.
    #[must_use]
    pub fn facing(&self) -> String {
        let heading_deg = wrap_angle(self.angles_rad[SHIFTS]).to_degrees();
        let side = if heading_deg < 0.0 { Side::Right } else { Side::Left };
        format!("turned by {:.0} degrees to their {} from facing the camera", heading_deg.abs(), side_name(side))
    }
}

/// The likeliest of the poses that are climbed to from guesses at the median of `points_m`: facing
/// eight ways, arms hanging, in a T or an A, legs standing or in a stride. Each is the mode of PIK
/// (12) times the likelihood of `blocks` of the same points, in stages of a narrowing robust
/// metric. The best of them and the same pose turned round end with the same steps, and the
/// likelier is the answer. It finds a person who stands or walks; who sits, bends down or lies
/// needs a first pose. An upper body whose legs are seen is looked for as a whole one.
///
/// # Errors
/// Measures that no body has.
pub fn pose_from_points(
    part: BodyPart,
    size: &BodySize,
    points: &PointTuning,
    points_m: &[Vec3],
    blocks: &[PointBlock],
) -> Result<FirstPose> {
    let pose = pose_of_part(part, size, points, points_m, blocks)?;
    if part == BodyPart::Upper && pose.unexplained_share > MOST_UNEXPLAINED {
        let whole = pose_of_part(BodyPart::Whole, size, points, points_m, blocks)?;
        if whole.unexplained_share < pose.unexplained_share {
            return Ok(whole);
        }
    }
    Ok(pose)
}

/// Share of the points that are farther from the skin of this pose than an outlier is; zero without
/// points.
pub(super) fn unexplained_share(
    scene: &BodyScene<BODY_BONES, BODY_ANGLES>,
    pose_rad: &[f32; BODY_ANGLES],
    points_m: &[Vec3],
) -> f32 {
    let surface = scene.surface(&scene.posture(pose_rad));
    let outlier_m = scene.likelihood.outlier_m;
    let away = points_m.iter().filter(|point_m| surface.skin_distance_m(point_m) > outlier_m).count();
    away as f32 / points_m.len().max(1) as f32
}

/// The pose of the part that is seen.
fn pose_of_part(
    part: BodyPart,
    size: &BodySize,
    points: &PointTuning,
    points_m: &[Vec3],
    blocks: &[PointBlock],
) -> Result<FirstPose> {
    let scene = BodyScene {
        skeleton: full_body(&size.measures)?,
        radii_m: part.fleshed(&size.radii_m),
        camera_m: Vec3::zeros(),
        likelihood: PointLikelihood { std_m: points.std_m, outlier_m: points.outlier_m },
        self_penetration: None,
    };
    let mut pelvis_m = middle(points_m).unwrap_or(Vec3::new(0.0, 0.0, NO_POINTS_Z_M));
    if part == BodyPart::Upper {
        pelvis_m.y += UPPER_MIDDLE_SHARE * size.measures.trunk_m;
    }
    let climbed_by = |guess: &[f32; BODY_ANGLES], stages_m: &[f32], steps: usize| {
        let pose = climb(&scene, blocks, guess, stages_m, steps);
        (pose, scene.likelihood.log_likelihood(&scene.surface(&scene.posture(&pose)), blocks))
    };
    let guesses = guesses(part, pelvis_m);
    let climbed: Vec<([f32; BODY_ANGLES], f32)> =
        guesses.par_iter().map(|guess| climbed_by(guess, &STAGES_M, SEARCH_STEPS)).collect();
    // The first of equals, which faces the camera.
    let best = climbed.iter().reduce(|best, next| if next.1 > best.1 { next } else { best });
    let best_rad = best.map_or_else(|| standing(pelvis_m), |(pose, _)| *pose);
    let turned_rad = turned_round(&scene.skeleton, &best_rad);
    let end = |pose: &[f32; BODY_ANGLES]| climbed_by(pose, &STAGES_M[2..], STEPS);
    let (best, turned) = rayon::join(|| end(&best_rad), || end(&turned_rad));
    let (likelier, other) = if turned.1 > best.1 { (turned, best) } else { (best, turned) };
    // The climb can end where the other has begun.
    let is_opposite = wrap_angle(other.0[SHIFTS] - likelier.0[SHIFTS]).abs() > FRAC_PI_2;
    let opposite_rad = if is_opposite { other.0 } else { turned_round(&scene.skeleton, &likelier.0) };
    Ok(FirstPose {
        angles_rad: likelier.0,
        opposite_rad,
        facing_margin: (likelier.1 - other.1) / points_m.len().max(1) as f32,
        log_evidence: likelier.1,
        unexplained_share: unexplained_share(&scene, &likelier.0, points_m),
    })
}

/// Upright poses with the pelvis at `pelvis_m`. Without legs nobody strides.
fn guesses(part: BodyPart, pelvis_m: Vec3) -> Vec<[f32; BODY_ANGLES]> {
    let legs = if part == BodyPart::Upper { &LEGS_RAD[..1] } else { &LEGS_RAD[..] };
    let mut guesses = Vec::new();
    for heading in 0..HEADINGS {
        let turn_rad = wrap_angle(TAU * heading as f32 / HEADINGS as f32);
        for [elevation, deviation] in ARMS_RAD {
            for &[left, right] in legs {
                let mut pose = standing(pelvis_m);
                pose[SHIFTS] = turn_rad;
                for (angle, name) in pose.iter_mut().zip(BODY_ANGLE_NAMES) {
                    match name {
                        "l_shoulder_elevation" | "r_shoulder_elevation" => *angle = elevation,
                        "l_shoulder_deviation" | "r_shoulder_deviation" => *angle = deviation,
                        "l_hip_flexion" => *angle = left,
                        "r_hip_flexion" => *angle = right,
                        _ => {}
                    }
                }
                guesses.push(pose);
            }
        }
    }
    guesses
}

/// The pose after so many steps in each stage.
fn climb(
    scene: &BodyScene<BODY_BONES, BODY_ANGLES>,
    blocks: &[PointBlock],
    guess: &[f32; BODY_ANGLES],
    stages_m: &[f32],
    steps: usize,
) -> [f32; BODY_ANGLES] {
    let mut scene = scene.clone();
    let mut pose = scene.skeleton.clamp(*guess);
    let mut stiffness = [1.0 / (ANGLE_STD_RAD * ANGLE_STD_RAD); BODY_ANGLES];
    stiffness[..SHIFTS].fill(1.0 / (SHIFT_STD_M * SHIFT_STD_M));
    stiffness[SHIFTS..FREE_ROOT_COORDINATES].fill(1.0 / (TURN_STD_RAD * TURN_STD_RAD));
    for &outlier_m in stages_m {
        scene.likelihood.outlier_m = outlier_m;
        let skeleton = &scene.skeleton;
        let prior = PoseDensity { skeleton, root_m: Vec3::zeros(), goals: &[], previous_rad: pose, stiffness, held: 0 };
        pose = GuidedDensity { prior, scene: &scene, blocks, stride: 1, reach: 1.0 }.mode(steps).angles_rad;
    }
    pose
}

/// Medians of the coordinates, moved behind the skin; `None` without points.
fn middle(points_m: &[Vec3]) -> Option<Vec3> {
    let mut place = Vec3::zeros();
    for axis in 0..3 {
        let mut values: Vec<f32> = points_m.iter().map(|point| point[axis]).collect();
        let at = values.len() / 2;
        (at < values.len()).then(|| place[axis] = *values.select_nth_unstable_by(at, f32::total_cmp).1)?;
    }
    place.z += HALF_DEPTH_M;
    Some(place)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::tracking::BodyTuning;
    use crate::cloud::blocks_of;
    use crate::stereo::{StereoOptions, StereoScene, stick_wave};
    use sinew_core::kinematics::forward::posture;
    use sinew_core::skeleton::BodyMeasures;

    /// Mean distance of the joints that are found from the true ones, metres, of a person who is
    /// turned by `turn_rad`.
    fn error_m(turn_rad: f32) -> f32 {
        let mut recording = stick_wave(1, 15.0, 1.0, 3.0).unwrap().recording;
        recording.joints_m.truncate(1);
        let (sin, cos) = turn_rad.sin_cos();
        for joint_m in recording.joints_m[0].iter_mut().flatten() {
            let (x, z) = (joint_m.x, joint_m.z - 3.0);
            (joint_m.x, joint_m.z) = (cos * x + sin * z, cos * z - sin * x + 3.0);
        }
        let scene = StereoScene::new(recording, StereoOptions::default()).unwrap();
        let tuning = BodyTuning::default().guided_points;
        let blocks = blocks_of(&mut scene.points_m(0), None);
        let pose = pose_from_points(BodyPart::Whole, &(*scene.measures()).into(), &tuning, &scene.points_m(0), &blocks)
            .unwrap()
            .angles_rad;
        let skeleton = full_body(scene.measures()).unwrap();
        assert_eq!(skeleton.clamp(pose), pose);
        let ends = posture(&skeleton, &Vec3::zeros(), &pose).ends;
        let off: Vec<f32> = ends.iter().zip(scene.joints_m(0)).map(|(a, b)| (a - b.unwrap()).norm()).collect();
        off.iter().sum::<f32>() / off.len() as f32
    }

    #[test]
    fn a_person_is_found_whichever_way_they_face() {
        for quarter in 0..4 {
            let found_m = error_m(TAU * quarter as f32 / 4.0);
            assert!(found_m < 0.15, "{} degrees: {found_m} m", 90 * quarter);
        }
    }

    #[test]
    fn facing_is_said_to_the_side_of_the_person() {
        let of = |turn_rad: f32| {
            let mut angles_rad = standing(Vec3::zeros());
            angles_rad[SHIFTS] = turn_rad;
            let (opposite_rad, facing_margin) = (angles_rad, 0.0);
            FirstPose { angles_rad, opposite_rad, facing_margin, log_evidence: 0.0, unexplained_share: 0.0 }.facing()
        };
        assert_eq!(of(0.5 * TAU / 2.0), "turned by 90 degrees to their left from facing the camera");
        assert_eq!(of(TAU - 0.1 * TAU), "turned by 36 degrees to their right from facing the camera");
    }

    #[test]
    fn no_points_and_one_point_are_starts_too() {
        let tuning = BodyTuning::default().guided_points;
        let measures = BodySize::from(BodyMeasures::of_height(1.75).unwrap());
        let pose = pose_from_points(BodyPart::Whole, &measures, &tuning, &[], &[]).unwrap();
        assert_eq!(pose.angles_rad[..3], [0.0, 0.0, NO_POINTS_Z_M]);
        assert!(pose.is_facing_doubtful(), "nothing shows where the person faces");
        let one = pose_from_points(BodyPart::Whole, &measures, &tuning, &[Vec3::new(1.0, 0.0, 4.0)], &[]).unwrap();
        assert_eq!(one.angles_rad[0], 1.0);
    }
}
