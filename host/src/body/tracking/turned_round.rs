//! A pose turned round, with nearly the same silhouette.

use crate::body::fitting::standing;
use sinew_core::kinematics::forward::posture;
use sinew_core::kinematics::inverse::{Goal, PoseDensity, Solve};
use sinew_core::math::{Mat3, Vec3};
use sinew_core::skeleton::full_body::{
    BODY_ANGLES, BODY_BONES, BodySkeleton, COLLARS, FEET, FOREARMS, HIPS, SHANKS, THIGHS, UPPER_ARMS,
};
use sinew_core::skeleton::tree::SHIFTS;
use std::f32::consts::PI;

/// Inverse variance of a joint, 1 / m^2. Chosen: a centimetre.
const PRECISION: f32 = 1.0e4;
/// Inverse variance of a coordinate about the upright pose. Chosen: joints decide what they show.
const STIFFNESS: f32 = 0.1;
/// Most steps to the joints. Chosen: as many as a fit to recorded joints has.
const STEPS: usize = 60;

/// The pose that faces the other way, its left joints where the right ones are in `pose_rad` and
/// the right ones where the left ones are. Elbows and knees bend one way only, so they come near.
/// Toes point to the new front.
pub(super) fn turned_round(skeleton: &BodySkeleton, pose_rad: &[f32; BODY_ANGLES]) -> [f32; BODY_ANGLES] {
    let mut joints_m = posture(skeleton, &Vec3::zeros(), pose_rad).ends;
    for [left, right] in [COLLARS, UPPER_ARMS, FOREARMS, HIPS, THIGHS, SHANKS] {
        joints_m.swap(left, right);
    }
    let goals: Vec<Goal> = (0..BODY_BONES)
        .filter(|bone| !FEET.contains(bone))
        .map(|bone| Goal { bone, position_m: joints_m[bone], precision: Mat3::identity() * PRECISION })
        .collect();
    let mut from = standing(Vec3::from_column_slice(&pose_rad[..SHIFTS]));
    from[SHIFTS] = pose_rad[SHIFTS] + PI;
    let density = PoseDensity {
        skeleton,
        root_m: Vec3::zeros(),
        goals: &goals,
        previous_rad: skeleton.clamp(from),
        stiffness: [STIFFNESS; BODY_ANGLES],
        held: 0,
    };
    density.mode(STEPS).angles_rad
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_core::skeleton::BodyMeasures;
    use sinew_core::skeleton::full_body::{BODY_ANGLE_NAMES, full_body};

    /// Someone in a stride, one arm raised, turned by `heading_rad`.
    fn walker(heading_rad: f32) -> [f32; BODY_ANGLES] {
        let mut pose = standing(Vec3::new(0.2, 0.0, 3.0));
        for (name, angle) in [
            ("root_turn", heading_rad),
            ("l_hip_flexion", 0.4),
            ("r_hip_flexion", -0.3),
            ("l_shoulder_elevation", 1.2),
            ("l_shoulder_deviation", -0.6),
        ] {
            pose[BODY_ANGLE_NAMES.iter().position(|at| *at == name).unwrap()] = angle;
        }
        pose
    }

    #[test]
    fn joints_stay_and_the_front_is_behind() {
        let skeleton = full_body(&BodyMeasures::of_height(1.75).unwrap()).unwrap();
        for heading_rad in [0.0, 1.0, 3.0, -2.0] {
            let pose = walker(heading_rad);
            let turned = turned_round(&skeleton, &pose);
            assert_eq!(skeleton.clamp(turned), turned);
            let [was_m, is_m] = [pose, turned].map(|pose| posture(&skeleton, &Vec3::zeros(), &pose).ends);
            for [left, right] in [COLLARS, HIPS, THIGHS, SHANKS, UPPER_ARMS] {
                let off_m = (is_m[left] - was_m[right]).norm().max((is_m[right] - was_m[left]).norm());
                assert!(off_m < 0.1, "{heading_rad}: bone {left} is {off_m} m off");
            }
            for (foot, shank) in FEET.into_iter().zip(SHANKS) {
                let was_toe = was_m[foot] - was_m[shank];
                assert!(was_toe.dot(&(is_m[foot] - is_m[shank])) < 0.0, "{heading_rad}: toes point to the old front");
            }
        }
    }
}
