//! The pose of a skeleton whose joints come nearest to recorded ones.

use super::joints::BodyJoints;
use super::recording::BodyRecording;
use sinew_core::kinematics::forward::posture;
use sinew_core::kinematics::inverse::{Goal, PoseDensity, Solve};
use sinew_core::math::{Mat3, Vec3};
use sinew_core::skeleton::full_body::{BODY_ANGLES, BODY_BONES, BodySkeleton, PELVIS, TRUNK};
use std::f32::consts::FRAC_PI_2;

/// Coordinates that the first fit turns by quarters: about the vertical, and forward (someone who
/// lies).
const ROOT_TURN: usize = 3;
const ROOT_PITCH: usize = 5;
/// Inverse variance of a joint, 1 / m^2: one centimetre.
const PRECISION: f32 = 1.0e4;
/// Inverse variance of a coordinate around the start: what the joints do not show stays there.
const STIFFNESS: f32 = 0.1;
/// Steps of one climb.
const STEPS: usize = 60;
/// A fit that leaves a joint farther away than this is tried again from elsewhere, metres.
const SUSPICIOUS_M: f32 = 0.06;

/// A pose and how near its joints come to the recorded ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedPose {
    /// Coordinates inside the limits, in the order of `BODY_ANGLE_NAMES`.
    pub angles: [f32; BODY_ANGLES],
    /// Distance of each joint from the recorded one, metres; `None` where none was recorded.
    pub residual_m: [Option<f32>; BODY_BONES],
}

impl FittedPose {
    /// A pose beside recorded joints.
    #[must_use]
    pub fn of(skeleton: &BodySkeleton, joints: &BodyJoints, angles: [f32; BODY_ANGLES]) -> Self {
        let ends = posture(skeleton, &Vec3::zeros(), &angles).ends;
        Self { angles, residual_m: std::array::from_fn(|bone| Some((joints[bone]? - ends[bone]).norm())) }
    }

    /// Largest distance of a joint, metres; zero without joints.
    #[must_use]
    pub fn worst_m(&self) -> f32 {
        self.residual_m.iter().flatten().fold(0.0, |worst, distance| worst.max(*distance))
    }

    /// Mean distance of the joints, metres; zero without joints.
    #[must_use]
    pub fn mean_m(&self) -> f32 {
        let count = self.residual_m.iter().flatten().count();
        self.residual_m.iter().flatten().sum::<f32>() / count.max(1) as f32
    }
}

/// The pose whose joints are nearest to `joints` (least sum of squares), inside the limits.
///
/// Climbs from `start`. Where there is none, or that ends far away, it also climbs from a person at
/// the recorded pelvis. That person stands and looks to four sides, or lies. What the joints do not
/// show (an outstretched arm's turn) stays near the start.
#[must_use]
pub fn fit_pose(skeleton: &BodySkeleton, joints: &BodyJoints, start: Option<&[f32; BODY_ANGLES]>) -> FittedPose {
    let goals: Vec<Goal> = joints
        .iter()
        .enumerate()
        .filter_map(|(bone, place)| Some(Goal { bone, position_m: (*place)?, precision: Mat3::identity() * PRECISION }))
        .collect();
    let climb = |from: &[f32; BODY_ANGLES]| {
        let density = PoseDensity {
            skeleton,
            root_m: Vec3::zeros(),
            goals: &goals,
            previous_rad: skeleton.clamp(*from),
            stiffness: [STIFFNESS; BODY_ANGLES],
            held: 0,
        };
        FittedPose::of(skeleton, joints, density.mode(STEPS).angles_rad)
    };
    let first = start.map(climb);
    if let Some(fit) = first
        && fit.worst_m() < SUSPICIOUS_M
    {
        return fit;
    }
    let place = joints[PELVIS].or(joints[TRUNK]).or(joints.iter().copied().flatten().next()).unwrap_or_default();
    let mut best = first;
    for turn in 0..4 {
        for pitch in [0.0, -FRAC_PI_2, FRAC_PI_2] {
            let mut from = standing(place);
            (from[ROOT_TURN], from[ROOT_PITCH]) = (turn as f32 * FRAC_PI_2, pitch);
            let fit = climb(&from);
            // Several times better, or the fit would jump between poses that serve alike.
            if best.is_none_or(|best| squares(&fit) < 0.7 * squares(&best)) {
                best = Some(fit);
            }
        }
    }
    best.unwrap_or_else(|| FittedPose::of(skeleton, joints, standing(place)))
}

/// The fits of all frames, each from the one before.
#[must_use]
pub fn fit_recording(skeleton: &BodySkeleton, recording: &BodyRecording) -> Vec<FittedPose> {
    let mut fits: Vec<FittedPose> = Vec::with_capacity(recording.joints_m.len());
    for joints in &recording.joints_m {
        let fit = fit_pose(skeleton, joints, fits.last().map(|fit| &fit.angles));
        fits.push(fit);
    }
    fits
}

/// A person who stands with the pelvis at `place`, elbows and knees a little bent: there no
/// direction of turning is lost.
pub(crate) fn standing(place: Vec3) -> [f32; BODY_ANGLES] {
    const BENT_RAD: f32 = 0.2;
    let mut angles = [0.0; BODY_ANGLES];
    angles[..3].copy_from_slice(place.as_slice());
    for (angle, name) in angles.iter_mut().zip(sinew_core::skeleton::full_body::BODY_ANGLE_NAMES) {
        if name.ends_with("elbow_flexion") || name.ends_with("knee_flexion") {
            *angle = BENT_RAD;
        }
    }
    angles
}

fn squares(fit: &FittedPose) -> f32 {
    fit.residual_m.iter().flatten().map(|distance| distance * distance).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use sinew_core::skeleton::BodyMeasures;
    use sinew_core::skeleton::full_body::full_body;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]

        #[test]
        fn a_pose_of_the_skeleton_itself_is_found(
            shares in prop::collection::vec(0.25_f32..0.75, BODY_ANGLES), turn in -3.0_f32..3.0,
        ) {
            let skeleton = full_body(&BodyMeasures::of_height(1.75).unwrap()).unwrap();
            let mut angles = [0.0; BODY_ANGLES];
            for (i, limit) in skeleton.limits().iter().enumerate().skip(6) {
                // Half of the way to each limit from rest or from the middle.
                angles[i] = limit.low_rad + (limit.high_rad - limit.low_rad) * shares[i];
            }
            (angles[2], angles[ROOT_TURN]) = (3.0, turn);
            let joints = posture(&skeleton, &Vec3::zeros(), &angles).ends.map(Some);
            let fit = fit_pose(&skeleton, &joints, None);
            prop_assert!(fit.worst_m() < 0.01, "worst {}", fit.worst_m());
            prop_assert_eq!(skeleton.clamp(fit.angles), fit.angles);
            let again = fit_pose(&skeleton, &joints, Some(&fit.angles));
            prop_assert!(again.worst_m() < 0.01);
        }
    }

    #[test]
    fn joints_that_are_missing_have_no_residual() {
        let skeleton = full_body(&BodyMeasures::of_height(1.75).unwrap()).unwrap();
        let mut joints = posture(&skeleton, &Vec3::new(0.0, 0.0, 3.0), &[0.0; BODY_ANGLES]).ends.map(Some);
        joints[5] = None;
        let fit = fit_pose(&skeleton, &joints, None);
        assert!(fit.residual_m[5].is_none() && fit.residual_m[4].is_some_and(|distance| distance < 0.01));
        assert_eq!(fit_pose(&skeleton, &[None; BODY_BONES], None).worst_m(), 0.0);
    }
}
