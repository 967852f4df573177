//! The first pose where only points are known: upright, facing the camera, then fitted to the
//! points.

use super::tuning::PointTuning;
use crate::body::BodyPart;
use crate::error::Result;
use sinew_core::kinematics::inverse::{PoseDensity, Solve};
use sinew_core::math::Vec3;
use sinew_core::observation::point_cloud::PointBlock;
use sinew_core::observation::point_likelihood::PointLikelihood;
use sinew_core::pik::guided::GuidedDensity;
use sinew_core::pik::motion::BodyScene;
use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::full_body::{BODY_ANGLE_NAMES, BODY_ANGLES, full_body};
use sinew_core::skeleton::tree::{FREE_ROOT_COORDINATES, SHIFTS};

/// Points lie on the near skin, so the body's middle is as much behind theirs, metres.
const HALF_DEPTH_M: f32 = 0.1;
/// Where a body stands if there are no points at all, metres before the camera.
const NO_POINTS_Z_M: f32 = 3.0;
/// The middle of an upper body lies so much of the trunk above the pelvis.
const UPPER_MIDDLE_SHARE: f32 = 0.7;
/// Elbows and knees of the first guess: a straight one has a direction in which it cannot turn.
const BENT_RAD: f32 = 0.2;
/// From which distance on points count as outliers, stage by stage, metres: far ones pull first.
const STAGES_M: [f32; 3] = [0.8, 0.45, 0.25];
/// Steps of each stage.
const STEPS: usize = 25;
/// How far the root is from the guess, metres and radians, and how far the other angles.
const SHIFT_STD_M: f32 = 0.5;
const TURN_STD_RAD: f32 = 0.5;
const ANGLE_STD_RAD: f32 = 0.4;

/// An upright pose at the median of `points_m` that faces the camera, improved by the guided solver
/// on `blocks` of the same points. It is the mode of PIK (12) times the points' likelihood, in
/// stages of a narrowing robust metric. It finds a person who stands or sits and faces the camera;
/// who lies needs a first pose.
///
/// # Errors
/// Measures that no body has.
pub fn pose_from_points(
    part: BodyPart,
    measures: &BodyMeasures,
    points: &PointTuning,
    points_m: &[Vec3],
    blocks: &[PointBlock],
) -> Result<[f32; BODY_ANGLES]> {
    let mut scene = BodyScene {
        skeleton: full_body(measures)?,
        radii_m: part.radii_m(measures),
        camera_m: Vec3::zeros(),
        likelihood: PointLikelihood { std_m: points.std_m, outlier_m: points.outlier_m },
        self_penetration: None,
    };
    let mut pelvis_m = middle(points_m).unwrap_or(Vec3::new(0.0, 0.0, NO_POINTS_Z_M));
    if part == BodyPart::Upper {
        pelvis_m.y += UPPER_MIDDLE_SHARE * measures.trunk_m;
    }
    let mut pose = upright(pelvis_m);
    for outlier_m in STAGES_M {
        scene.likelihood.outlier_m = outlier_m;
        let mut stiffness = [1.0 / (ANGLE_STD_RAD * ANGLE_STD_RAD); BODY_ANGLES];
        stiffness[..SHIFTS].fill(1.0 / (SHIFT_STD_M * SHIFT_STD_M));
        stiffness[SHIFTS..FREE_ROOT_COORDINATES].fill(1.0 / (TURN_STD_RAD * TURN_STD_RAD));
        let prior = PoseDensity {
            skeleton: &scene.skeleton,
            root_m: Vec3::zeros(),
            goals: &[],
            previous_rad: scene.skeleton.clamp(pose),
            stiffness,
            held: 0,
        };
        pose = GuidedDensity { prior, scene: &scene, blocks, stride: 1, reach: 1.0 }.mode(STEPS).angles_rad;
    }
    Ok(scene.skeleton.clamp(pose))
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

fn upright(pelvis_m: Vec3) -> [f32; BODY_ANGLES] {
    let mut pose = [0.0; BODY_ANGLES];
    pose[..SHIFTS].copy_from_slice(pelvis_m.as_slice());
    for (angle, name) in pose.iter_mut().zip(BODY_ANGLE_NAMES) {
        if name.ends_with("elbow_flexion") || name.ends_with("knee_flexion") {
            *angle = BENT_RAD;
        }
    }
    pose
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::tracking::BodyTuning;
    use crate::cloud::blocks_of;
    use crate::stereo::{StereoOptions, StereoScene, stick_wave};
    use sinew_core::kinematics::forward::posture;

    #[test]
    fn a_person_before_the_camera_is_found() {
        let mut recording = stick_wave(1, 15.0, 1.0, 3.0).unwrap().recording;
        recording.joints_m.truncate(1);
        let scene = StereoScene::new(recording, StereoOptions::default()).unwrap();
        let tuning = BodyTuning::default().guided_points;
        let blocks = blocks_of(&mut scene.points_m(0), None);
        let pose = pose_from_points(BodyPart::Whole, scene.measures(), &tuning, &scene.points_m(0), &blocks).unwrap();
        let skeleton = full_body(scene.measures()).unwrap();
        assert_eq!(skeleton.clamp(pose), pose);
        let ends = posture(&skeleton, &Vec3::zeros(), &pose).ends;
        let off: Vec<f32> = ends.iter().zip(scene.joints_m(0)).map(|(a, b)| (a - b.unwrap()).norm()).collect();
        let mean = off.iter().sum::<f32>() / off.len() as f32;
        assert!(mean < 0.15, "mean {mean}: {off:?}");
    }

    #[test]
    fn no_points_and_one_point_are_starts_too() {
        let (measures, tuning) = (BodyMeasures::of_height(1.75).unwrap(), BodyTuning::default().guided_points);
        let pose = pose_from_points(BodyPart::Whole, &measures, &tuning, &[], &[]).unwrap();
        assert_eq!(pose[..3], [0.0, 0.0, NO_POINTS_Z_M]);
        let one = pose_from_points(BodyPart::Whole, &measures, &tuning, &[Vec3::new(1.0, 0.0, 4.0)], &[]).unwrap();
        assert_eq!(one[0], 1.0);
    }
}
