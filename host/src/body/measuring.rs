//! How long a recorded person's segments are: medians over the frames, left and right averaged.

use super::joints::{BodyJoints, median};
use super::recording::BodyRecording;
use crate::error::{Context, Result};
use sinew_core::math::{Vec3, unit};
use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::body_measures::REFERENCE_HEIGHT_M;
use sinew_core::skeleton::full_body::{COLLARS, FEET, FOREARMS, HEAD, HIPS, PELVIS, SHANKS, THIGHS, TRUNK, UPPER_ARMS};

/// A knee that is bent less than this gives no axis: the sine.
const MIN_KNEE_SINE: f32 = 0.3;

/// Left, up and front of a part of the body.
struct Frame([Vec3; 3]);

impl Frame {
    /// Up is exact, left is made square to it.
    fn new(up: Vec3, across: Vec3) -> Option<Self> {
        let up = unit(up)?;
        let left = unit(across - up * across.dot(&up))?;
        Some(Self([left, up, left.cross(&up)]))
    }

    /// (outward, up, front) of `offset` on the side 0 (left) or 1 (right).
    fn outward(&self, offset: Vec3, side: usize) -> Vec3 {
        let [left, up, front] = &self.0;
        let sign = if side == 0 { 1.0 } else { -1.0 };
        Vec3::new(sign * offset.dot(left), offset.dot(up), offset.dot(front))
    }
}

/// Measures of the recorded person.
///
/// Shoulders are measured in the trunk's frame: up from the middle of the hips to the neck, left
/// from the right to the left shoulder. Hips are measured along the line through them, since their
/// middle is the pelvis. A foot has its length, and the share of it that points outwards along the
/// axis of a bent knee. It also has its median slope against the shank. The slope becomes the zero
/// of the ankle. The girth is that of the stature that trunk and legs are a part of.
///
/// # Errors
/// A segment that no frame shows.
pub fn measure(recording: &BodyRecording) -> Result<BodyMeasures> {
    let frames = &recording.joints_m;
    let standard = BodyMeasures::of_height(REFERENCE_HEIGHT_M)?;
    let trunk_m = length_m(frames, &[(PELVIS, TRUNK)])?;
    let pairs = |from: [usize; 2], to: [usize; 2]| [(from[0], to[0]), (from[1], to[1])];
    let (thigh_m, shank_m) = (length_m(frames, &pairs(HIPS, THIGHS))?, length_m(frames, &pairs(THIGHS, SHANKS))?);
    let half_hips_m = 0.5 * length_m(frames, &[(HIPS[0], HIPS[1])])?;
    let height = (trunk_m + thigh_m + shank_m) / (standard.trunk_m + standard.thigh_m + standard.shank_m);
    let shoulder_m = median3(frames, |joints, side| {
        let [left, right] = COLLARS.map(|bone| joints[bone]);
        let frame = Frame::new(joints[TRUNK]? - joints[PELVIS]?, left? - right?)?;
        Some(frame.outward(joints[COLLARS[side]]? - joints[TRUNK]?, side))
    });
    Ok(BodyMeasures {
        trunk_m,
        head_m: length_m(frames, &[(TRUNK, HEAD)])?,
        shoulder_m: shoulder_m.context("neck, pelvis and both shoulders are in no frame together")?,
        upper_arm_m: length_m(frames, &pairs(COLLARS, UPPER_ARMS))?,
        forearm_m: length_m(frames, &pairs(UPPER_ARMS, FOREARMS))?,
        hip_m: Vec3::new(half_hips_m, 0.0, 0.0),
        thigh_m,
        shank_m,
        foot_m: foot_m(frames)?,
        girth: height,
    }
    .checked()?)
}

/// Median of a segment's length over frames, mean over the sides.
fn length_m(frames: &[BodyJoints], segments: &[(usize, usize)]) -> Result<f32> {
    let mut sum = 0.0;
    for &(from, to) in segments {
        let lengths = frames.iter().filter_map(|joints| Some((joints[to]? - joints[from]?).norm())).collect();
        let names = sinew_core::skeleton::full_body::BODY_JOINT_NAMES;
        sum += median(lengths).with_context(|| format!("no frame shows both {} and {}", names[from], names[to]))?;
    }
    Ok(sum / segments.len() as f32)
}

/// Medians of the three components of what `of` gives for each frame and side.
fn median3(frames: &[BodyJoints], of: impl Fn(&BodyJoints, usize) -> Option<Vec3>) -> Option<Vec3> {
    let mut sum = Vec3::zeros();
    for side in 0..2 {
        let all: Vec<Vec3> = frames.iter().filter_map(|joints| of(joints, side)).collect();
        for axis in 0..3 {
            sum[axis] += 0.5 * median(all.iter().map(|offset| offset[axis]).collect())?;
        }
    }
    Some(sum)
}

fn foot_m(frames: &[BodyJoints]) -> Result<Vec3> {
    let length_m = length_m(frames, &[(SHANKS[0], FEET[0]), (SHANKS[1], FEET[1])])?;
    let outward = median3(frames, |joints, side| {
        let (knee, ankle) = (joints[THIGHS[side]]?, joints[SHANKS[side]]?);
        let (thigh, shank) = (unit(knee - joints[HIPS[side]]?)?, unit(ankle - knee)?);
        let axis = thigh.cross(&shank);
        let frame = Frame::new(-shank, axis)?;
        (axis.norm() > MIN_KNEE_SINE).then(|| Some(frame.outward(joints[FEET[side]]? - ankle, side)))?
    });
    let outward_m = outward.map_or(0.0, |offset| offset.x.clamp(-0.5 * length_m, 0.5 * length_m));
    let sagittal_m = (length_m * length_m - outward_m * outward_m).sqrt();
    // Along the shank alone: that needs no knee to be bent.
    let upward = median3(frames, |joints, side| {
        let ankle = joints[SHANKS[side]]?;
        Some(Vec3::repeat((joints[FEET[side]]? - ankle).dot(&unit(joints[THIGHS[side]]? - ankle)?)))
    });
    let up_m = upward.map_or(0.0, |up| up.x.clamp(-sagittal_m, sagittal_m));
    Ok(Vec3::new(outward_m, up_m, (sagittal_m * sagittal_m - up_m * up_m).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_core::kinematics::forward::posture;
    use sinew_core::random::Stream;
    use sinew_core::skeleton::full_body::{BODY_ANGLES, full_body};

    #[test]
    fn a_skeletons_own_measures_come_back() {
        let mut wanted = BodyMeasures::of_height(1.68).unwrap();
        wanted.shoulder_m = Vec3::new(0.19, -0.03, -0.02);
        wanted.foot_m.x = 0.02;
        let skeleton = full_body(&wanted).unwrap();
        let mut stream = Stream::new(4, 0, 0);
        let joints_m = (0..41)
            .map(|_| {
                let mut angles = [0.0; BODY_ANGLES];
                for (angle, limit) in angles.iter_mut().zip(skeleton.limits()).skip(3) {
                    *angle = limit.clamp(stream.normal() * 0.7);
                }
                // The median of the ankles is their zero.
                (angles[24], angles[29]) = (0.0, 0.0);
                posture(&skeleton, &Vec3::new(0.0, 0.0, 3.0), &angles).ends.map(Some)
            })
            .collect();
        let found = measure(&BodyRecording { rate_hz: 15.0, joints_m }).unwrap();
        let near = |a: f32, b: f32| (a - b).abs() < 2.0e-4;
        assert!(near(found.trunk_m, wanted.trunk_m) && near(found.head_m, wanted.head_m));
        assert!(near(found.upper_arm_m, wanted.upper_arm_m) && near(found.forearm_m, wanted.forearm_m));
        assert!(near(found.thigh_m, wanted.thigh_m) && near(found.shank_m, wanted.shank_m));
        assert!((found.shoulder_m - wanted.shoulder_m).norm() < 1.0e-3, "{}", found.shoulder_m);
        assert!((found.hip_m - wanted.hip_m).norm() < 1.0e-3 && (found.foot_m - wanted.foot_m).norm() < 2.0e-3);
        assert!(near(found.girth, wanted.girth));
    }

    #[test]
    fn what_no_frame_shows_is_named() {
        let joints_m = vec![[None; sinew_core::skeleton::full_body::BODY_BONES]; 2];
        let message = measure(&BodyRecording { rate_hz: 15.0, joints_m }).unwrap_err().to_string();
        assert!(message.contains("pelvis and neck"), "{message}");
    }
}
