//! The 17 ends of a body's bones in recordings of many makers. They are the stick figure's 14
//! joints, the middle of the head, and the balls of the feet.
//!
//! The pelvis is the middle of the hips. What a recording lacks of head and toes is put where human
//! proportions have it.

use crate::motion::MotionError;
use crate::motion::joint_names::{self as figure, JointSources, SpatialJoints, middle, named_points};
use crate::motion::markers::MarkerMotion;
use sinew_core::math::{Vec3, unit};
use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::full_body::{
    BODY_BONES, COLLARS, FEET, FOREARMS, HEAD, HIPS, PELVIS, SHANKS, THIGHS, TRUNK, UPPER_ARMS,
};
use std::path::Path;

/// Ends of a body's bones in one frame, in the order of
/// `sinew_core::skeleton::full_body::BODY_JOINT_NAMES`, metres.
pub type BodyJoints = [Option<Vec3>; BODY_BONES];

/// Names of a point of the head: four of a head band, CMU and HDM05, BVH exporters, keypoints.
const HEADS: &[&str] = &["lfhd+rfhd+lbhd+rbhd", "upperneck", "head", "lear+rear", "lfhd+rfhd", "nose"];
/// Names of the ball of a foot, where the toes begin; in CMU and HDM05 it is the end of the bone
/// `lfoot`.
const BALLS: &[&str] =
    &["{L}toebase", "toes{l}", "{L}toes", "{L}toe", "{l}toebase", "{l}toe", "{l}bigtoe", "{l}foot", "{l}toes"];

/// Distance of the middle of the head from the base of the neck, body heights. Recordings have a
/// point of the head that is nearer or farther (the joint below the skull, the crown). It gives the
/// direction only.
const HEAD_HEIGHTS: [f32; 2] = [0.085, 0.135];

/// Which points of a file make up each end.
#[derive(Debug, Clone, PartialEq)]
pub struct BodySources {
    figure: JointSources,
    head: Option<Vec<usize>>,
    balls: [Option<Vec<usize>>; 2],
}

impl BodySources {
    /// Finds the ends among `names`; `path` is for the message.
    ///
    /// # Errors
    /// Lists limb joints that go by no name that is known, and the names that are there.
    pub fn find(names: &[String], path: &Path) -> Result<Self, MotionError> {
        Ok(Self {
            figure: JointSources::find(names, false, path)?,
            head: named_points(names, HEADS, true),
            balls: [true, false].map(|left| named_points(names, BALLS, left)),
        })
    }

    /// The ends in all frames of `motion`, axes as in the file.
    #[must_use]
    pub fn of_motion(&self, motion: &MarkerMotion) -> Vec<BodyJoints> {
        let figure = self.figure.of_motion(motion);
        let mut frames: Vec<BodyJoints> =
            figure.iter().zip(&motion.positions_m).map(|(f, p)| self.ends(f, p)).collect();
        let height_m = median(frames.iter().filter_map(standing_height_m).collect());
        if let Some(measures) = height_m.and_then(|height_m| BodyMeasures::of_height(height_m).ok()) {
            complete_heads(&mut frames, height_m.unwrap_or(0.0), measures.head_m);
            for joints in &mut frames {
                complete_feet(joints, &measures);
            }
        }
        frames
    }

    fn ends(&self, figure: &SpatialJoints, positions_m: &[Option<Vec3>]) -> BodyJoints {
        let mut ends: BodyJoints = [None; BODY_BONES];
        let point = |points: &Option<Vec<usize>>| middle(points.as_ref()?.iter().map(|&point| positions_m[point]));
        for side in 0..2 {
            let (shoulder, hip) = (figure::SHOULDERS[side], figure::HIPS[side]);
            for (along, bone) in [COLLARS[side], UPPER_ARMS[side], FOREARMS[side]].into_iter().enumerate() {
                ends[bone] = figure[shoulder + along];
            }
            for (along, bone) in [HIPS[side], THIGHS[side], SHANKS[side]].into_iter().enumerate() {
                ends[bone] = figure[hip + along];
            }
            ends[FEET[side]] = point(&self.balls[side]);
        }
        let hips = middle(HIPS.map(|hip| ends[hip]).into_iter());
        ends[PELVIS] = hips.or(figure[figure::HIP_CENTER]);
        ends[TRUNK] = figure[figure::NECK];
        ends[HEAD] = point(&self.head);
        ends
    }
}

/// Stature from trunk, thighs and shanks of one frame, whatever the pose.
fn standing_height_m(joints: &BodyJoints) -> Option<f32> {
    let length = |a: usize, b: usize| Some((joints[a]? - joints[b]?).norm());
    let mut legs = 0.0;
    for side in 0..2 {
        legs += 0.5 * (length(HIPS[side], THIGHS[side])? + length(THIGHS[side], SHANKS[side])?);
    }
    let of_one_metre = BodyMeasures::of_height(1.0).ok()?;
    Some((length(PELVIS, TRUNK)? + legs) / (of_one_metre.trunk_m + of_one_metre.thigh_m + of_one_metre.shank_m))
}

/// Puts heads at a head's distance from the neck where the recorded point is another one, and on
/// the trunk's extension where there is none.
fn complete_heads(frames: &mut [BodyJoints], height_m: f32, head_m: f32) {
    let recorded = frames.iter().filter_map(|joints| Some((joints[HEAD]? - joints[TRUNK]?).norm())).collect();
    let scale = median(recorded).map(|length_m: f32| {
        let is_middle = length_m > HEAD_HEIGHTS[0] * height_m && length_m < HEAD_HEIGHTS[1] * height_m;
        if is_middle { 1.0 } else { head_m / length_m.max(1.0e-3) }
    });
    for joints in frames {
        let Some(neck) = joints[TRUNK] else { continue };
        joints[HEAD] = match (scale, joints[HEAD]) {
            (Some(scale), Some(head)) => Some(neck + (head - neck) * scale),
            (Some(_), None) => None,
            (None, _) => joints[PELVIS].and_then(|pelvis| unit(neck - pelvis)).map(|up| neck + up * head_m),
        };
    }
}

/// Puts the ball of a foot that is missing where a foot of the standard proportions has it.
fn complete_feet(joints: &mut BodyJoints, measures: &BodyMeasures) {
    for side in 0..2 {
        joints[FEET[side]] = joints[FEET[side]].or_else(|| standard_ball(joints, side, measures));
    }
}

/// The ball of a foot that stands square to its shank and points to where the hips face.
fn standard_ball(joints: &BodyJoints, side: usize, measures: &BodyMeasures) -> Option<Vec3> {
    let (knee, ankle) = (joints[THIGHS[side]]?, joints[SHANKS[side]]?);
    let up = unit(knee - ankle)?;
    let front = unit((joints[HIPS[0]]? - joints[HIPS[1]]?).cross(&up))?;
    Some(ankle + up * measures.foot_m.y + front * measures.foot_m.z)
}

/// The middle value; the mean of both middle ones where their number is even. Infinite and missing
/// values have to be left out.
pub(super) fn median(mut values: Vec<f32>) -> Option<f32> {
    values.sort_by(f32::total_cmp);
    let half = values.len() / 2;
    let upper = *values.get(half)?;
    Some(if values.len() % 2 == 1 { upper } else { 0.5 * (upper + values[half - 1]) })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A person who looks along z: left is x, up is y, as in a BVH file.
    fn standing(extra: &[(&str, [f32; 3])]) -> MarkerMotion {
        let points: Vec<(&str, [f32; 3])> = [
            ("LeftArm", [0.2, 1.4, 0.0]),
            ("LeftForeArm", [0.2, 1.1, 0.0]),
            ("LeftHand", [0.2, 0.85, 0.0]),
            ("RightArm", [-0.2, 1.4, 0.0]),
            ("RightForeArm", [-0.2, 1.1, 0.0]),
            ("RightHand", [-0.2, 0.85, 0.0]),
            ("LeftUpLeg", [0.09, 0.92, 0.0]),
            ("LeftLeg", [0.09, 0.5, 0.0]),
            ("LeftFoot", [0.09, 0.07, 0.0]),
            ("RightUpLeg", [-0.09, 0.92, 0.0]),
            ("RightLeg", [-0.09, 0.5, 0.0]),
            ("RightFoot", [-0.09, 0.07, 0.0]),
            ("Neck", [0.0, 1.45, 0.0]),
            ("Hips", [0.0, 1.0, 0.0]),
        ]
        .into_iter()
        .chain(extra.iter().copied())
        .collect();
        MarkerMotion {
            frames_per_second: 30.0,
            names: points.iter().map(|(name, _)| (*name).to_owned()).collect(),
            positions_m: vec![points.iter().map(|(_, at)| Some(Vec3::from(*at))).collect()],
            ..MarkerMotion::default()
        }
    }

    fn ends(motion: &MarkerMotion) -> BodyJoints {
        BodySources::find(&motion.names, Path::new("m")).unwrap().of_motion(motion)[0]
    }

    #[test]
    fn head_and_toes_that_are_missing_lie_where_people_have_them() {
        let joints = ends(&standing(&[]));
        assert_eq!(joints[PELVIS].unwrap(), Vec3::new(0.0, 0.92, 0.0), "the middle of the hips");
        let head = joints[HEAD].unwrap();
        assert!(head.x.abs() < 1.0e-6 && (1.6..1.68).contains(&head.y), "{head}");
        for (side, x) in [(0, 0.09), (1, -0.09)] {
            let toe = joints[FEET[side]].unwrap();
            assert!((toe.x - x).abs() < 1.0e-6 && (0.0..0.04).contains(&toe.y) && toe.z > 0.14, "{toe}");
        }
    }

    #[test]
    fn a_joint_below_the_skull_gives_the_heads_direction_only() {
        let joints = ends(&standing(&[("Head", [0.0, 1.45, 0.06]), ("LeftToeBase", [0.1, 0.02, 0.13])]));
        let head = joints[HEAD].unwrap();
        assert!((head.y - 1.45).abs() < 1.0e-5 && (0.16..0.22).contains(&head.z), "{head}");
        assert_eq!(joints[FEET[0]].unwrap(), Vec3::new(0.1, 0.02, 0.13));
        let recorded = ends(&standing(&[("Head", [0.0, 1.63, 0.02])]))[HEAD].unwrap();
        assert_eq!(recorded, Vec3::new(0.0, 1.63, 0.02));
    }

    #[test]
    fn a_missing_point_leaves_its_joint_out() {
        let mut motion = standing(&[]);
        motion.positions_m[0][1] = None;
        let joints = ends(&motion);
        assert!(joints[UPPER_ARMS[0]].is_none() && joints[FOREARMS[0]].is_some());
        assert_eq!(median(vec![3.0, 1.0, 2.0, 4.0]), Some(2.5));
        assert_eq!(median(Vec::new()), None);
    }
}
