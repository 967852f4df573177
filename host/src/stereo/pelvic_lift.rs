//! Built-in motion `pelvic-lift`: a person who lies on the back lifts the pelvis six times; feet,
//! hands and head stay.

use super::animated::{AnimatedBody, FIRM, goal};
use crate::body::BodyRecording;
use crate::error::Result;
use sinew_core::kinematics::inverse::Goal;
use sinew_core::math::{Mat3, Vec3, axis_rotation, sin_cos};
use sinew_core::skeleton::full_body::{BODY_RADII_M, FEET, FOREARMS, HEAD, PELVIS, SHANKS, THIGHS, TRUNK};
use std::f32::consts::{FRAC_PI_2, TAU};

/// How often the pelvis goes up and down.
pub const REPETITIONS: usize = 6;
/// Seconds of one repetition.
const PERIOD_S: f32 = 2.2;
/// How far the pelvis goes up, metres.
const LIFT_M: f32 = 0.24;
/// The head points to the picture's left and away from the camera: seen from the side and a little
/// from the feet. Radians from the line of sight.
const DIRECTION_RAD: f32 = 1.1;
/// Ankles from the pelvis towards the feet, and apart from the middle, metres.
const ANKLES_M: [f32; 2] = [0.42, 0.12];
/// Wrists from the pelvis towards the head, and apart from the middle, metres: the arms are nearly
/// straight.
const WRISTS_M: [f32; 2] = [-0.04, 0.28];
/// Knees apart from the middle, metres.
const KNEES_M: f32 = 0.11;
/// Inverse variance of goals that give way where they have to, 1 / m^2: the neck, and the knees'
/// distance from the middle.
const SOFT: f32 = 1.0e5;
/// Frames in which the solver settles before the motion begins.
const SETTLING: usize = 20;

/// Draws the motion at `rate_hz`; the floor is `camera_height_m` below the camera.
///
/// # Errors
/// None for the person that is built in.
pub fn pelvic_lift(rate_hz: f32, camera_height_m: f32, distance_m: f32) -> Result<BodyRecording> {
    let mut body = lying(camera_height_m, distance_m)?;
    let places = Places::new(&body, camera_height_m, distance_m);
    for _ in 0..SETTLING {
        body.reach(&places.goals(0.0));
    }
    // What was reached lies still, whatever the first guess was.
    let places = places.as_reached(&body);
    let frames = (REPETITIONS as f32 * PERIOD_S * rate_hz).round().max(1.0) as usize;
    let joints_m = (0..frames)
        .map(|frame| {
            let turns = frame as f32 / (rate_hz * PERIOD_S);
            let share = 0.5 - 0.5 * sin_cos(TAU * (turns - turns.floor())).1;
            body.reach(&places.goals(share * LIFT_M));
            body.joints()
        })
        .collect();
    Ok(BodyRecording { rate_hz, joints_m })
}

/// A first guess: on the back, knees bent, arms beside the body.
fn lying(camera_height_m: f32, distance_m: f32) -> Result<AnimatedBody> {
    let mut body = AnimatedBody::new(&[
        ("root_y", camera_height_m - BODY_RADII_M[TRUNK]),
        ("root_z", distance_m),
        ("root_turn", DIRECTION_RAD),
        ("root_pitch", -FRAC_PI_2),
        ("l_hip_flexion", 0.9),
        ("r_hip_flexion", 0.9),
        ("l_knee_flexion", 1.8),
        ("r_knee_flexion", 1.8),
        ("l_shoulder_elevation", 0.3),
        ("r_shoulder_elevation", 0.3),
        ("l_shoulder_rotation", 1.2),
        ("r_shoulder_rotation", 1.2),
        ("l_elbow_flexion", 0.2),
        ("r_elbow_flexion", 0.2),
    ])?;
    for tilt_or_turn in ["root_tilt", "root_turn", "trunk_tilt", "trunk_turn", "head_tilt", "head_turn"] {
        body.stiffen(tilt_or_turn, 1.0e5);
    }
    Ok(body)
}

/// Where the joints lie that do not move, metres.
struct Places {
    fixed: [(usize, Vec3); 7],
    knees: [Vec3; 2],
    neck: Vec3,
    pelvis: Vec3,
}

impl Places {
    fn new(body: &AnimatedBody, floor_m: f32, distance_m: f32) -> Self {
        let turn = axis_rotation(&-Vec3::y(), DIRECTION_RAD);
        // Before the turn the head points away from the camera: the person's left is to the
        // picture's right.
        let place = |left: f32, above_floor: f32, headward: f32| {
            turn * Vec3::new(left, 0.0, headward) + Vec3::new(0.0, floor_m - above_floor, distance_m)
        };
        let measures = &body.measures;
        let (sole, trunk) = (BODY_RADII_M[FEET[0]], BODY_RADII_M[TRUNK]);
        let mut fixed = [(HEAD, place(0.0, BODY_RADII_M[HEAD] + 0.01, measures.trunk_m + measures.head_m)); 7];
        for (side, sign) in [1.0, -1.0].into_iter().enumerate() {
            let [feetward, apart] = ANKLES_M;
            let ankle_above = sole - measures.foot_m.y;
            fixed[1 + side] = (SHANKS[side], place(sign * apart, ankle_above, -feetward));
            fixed[3 + side] = (FEET[side], place(sign * apart, sole, -feetward - measures.foot_m.z));
            fixed[5 + side] = (FOREARMS[side], place(sign * WRISTS_M[1], BODY_RADII_M[FOREARMS[0]], WRISTS_M[0]));
        }
        let knees = [1.0, -1.0].map(|sign| place(sign * KNEES_M, 0.0, 0.0));
        Self { fixed, knees, neck: place(0.0, trunk, measures.trunk_m), pelvis: place(0.0, trunk, 0.0) }
    }

    fn as_reached(&self, body: &AnimatedBody) -> Self {
        let ends = body.ends();
        Self {
            fixed: self.fixed.map(|(bone, _)| (bone, ends[bone])),
            knees: self.knees,
            neck: ends[TRUNK],
            pelvis: ends[PELVIS],
        }
    }

    /// Goals with the pelvis `lift_m` higher: only its height is asked for, and the neck gives way
    /// where it has to.
    fn goals(&self, lift_m: f32) -> Vec<Goal> {
        let mut goals: Vec<Goal> = self.fixed.iter().map(|&(bone, place)| goal(bone, place, FIRM)).collect();
        let height_only = Mat3::from_diagonal(&Vec3::new(1.0, FIRM, 1.0));
        let position_m = self.pelvis - Vec3::y() * lift_m;
        goals.push(Goal { bone: PELVIS, position_m, precision: height_only });
        goals.push(goal(TRUNK, self.neck, SOFT));
        let sideways = axis_rotation(&-Vec3::y(), DIRECTION_RAD) * Vec3::x();
        let precision = sideways * sideways.transpose() * SOFT;
        goals.extend([0, 1].map(|side| Goal { bone: THIGHS[side], position_m: self.knees[side], precision }));
        goals
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pelvis_goes_up_and_down_six_times_over_what_lies_still() {
        let recording = pelvic_lift(15.0, 1.0, 3.0).unwrap();
        assert_eq!(recording.joints_m.len(), 198);
        let first = recording.joints_m[0];
        let height_m = |frame: usize| first[PELVIS].unwrap().y - recording.joints_m[frame][PELVIS].unwrap().y;
        let (mut ups, mut highest_m) = (0, 0.0_f32);
        for frame in 1..recording.joints_m.len() {
            highest_m = highest_m.max(height_m(frame));
            ups += usize::from(height_m(frame - 1) < 0.12 && height_m(frame) >= 0.12);
            for bone in [[HEAD; 2], FEET, SHANKS, FOREARMS].concat() {
                let moved_m = (recording.joints_m[frame][bone].unwrap() - first[bone].unwrap()).norm();
                assert!(moved_m < 0.01, "frame {frame} bone {bone}: {moved_m}");
            }
            for (bone, joint) in recording.joints_m[frame].iter().flatten().enumerate() {
                assert!(joint.y < 1.0, "bone {bone} below the floor: {joint}");
            }
        }
        assert_eq!(ups, REPETITIONS);
        assert!((highest_m - LIFT_M).abs() < 0.01, "{highest_m}");
        for side in 0..2 {
            let bone = THIGHS[side];
            let moved_m = (recording.joints_m[16][bone].unwrap() - first[bone].unwrap()).norm();
            assert!((0.02..0.3).contains(&moved_m), "knee {side}: {moved_m}");
        }
        let lying = first[TRUNK].unwrap() - first[PELVIS].unwrap();
        assert!(lying.y.abs() < 0.1 && lying.x.abs() > 0.3, "{lying}");
        assert!(first[SHANKS[0]].unwrap().y > 0.85, "feet stand on the floor");
    }
}
