//! Where shoulders, elbows, wrists and hips are in a motion, by the names that skeletons usually
//! give them, and the torso's frame.

use super::error::MotionError;
use super::figure::{HIPS, SHOULDERS};
use super::joint_names::JointSources;
use super::recording::Motion;
use sinew_core::math::{Mat3, Vec3, unit};
use sinew_core::skeleton::Side as ArmSide;
use std::path::Path;

/// Names of one skeleton convention; `{}` stands for the side.
#[derive(Debug)]
struct Convention {
    /// How the left side is written.
    left: &'static str,
    /// How the right side is written.
    right: &'static str,
    shoulder: &'static str,
    elbow: &'static str,
    wrist: &'static str,
    hip: &'static str,
}

/// CMU and HDM05 (a joint is the end of the bone with its name), the usual BVH exporters, Bandai
/// Namco, older BVH, SMPL.
const CONVENTIONS: [Convention; 5] = [
    convention("l", "r", ["{}clavicle", "{}humerus", "{}radius", "{}hipjoint"]),
    convention("Left", "Right", ["{}Arm", "{}ForeArm", "{}Hand", "{}UpLeg"]),
    convention("L", "R", ["UpperArm_{}", "LowerArm_{}", "Hand_{}", "UpperLeg_{}"]),
    convention("Left", "Right", ["{}Shoulder", "{}Elbow", "{}Wrist", "{}Hip"]),
    convention("left", "right", ["{}_shoulder", "{}_elbow", "{}_wrist", "{}_hip"]),
];

const fn convention(left: &'static str, right: &'static str, names: [&'static str; 4]) -> Convention {
    let [shoulder, elbow, wrist, hip] = names;
    Convention { left, right, shoulder, elbow, wrist, hip }
}

impl Convention {
    fn joint(&self, motion: &Motion, pattern: &str, side: ArmSide) -> Option<usize> {
        let side = if side == ArmSide::Left { self.left } else { self.right };
        motion.joint(&pattern.replace("{}", side))
    }
}

/// Joint indices of one arm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Arm {
    /// Glenohumeral joint.
    pub shoulder: usize,
    /// Elbow.
    pub elbow: usize,
    /// Wrist.
    pub wrist: usize,
}

impl Arm {
    /// The arm of one `side`, or `None` if its three joints go by no name that is known.
    #[must_use]
    pub fn find(motion: &Motion, side: ArmSide) -> Option<Self> {
        let of_convention = CONVENTIONS.iter().find_map(|names| {
            Some(Self {
                shoulder: names.joint(motion, names.shoulder, side)?,
                elbow: names.joint(motion, names.elbow, side)?,
                wrist: names.joint(motion, names.wrist, side)?,
            })
        });
        of_convention.or_else(|| {
            let sources = JointSources::find(&motion.joints, true, Path::new("")).ok()?;
            let first = SHOULDERS[usize::from(side == ArmSide::Right)];
            let [shoulder, elbow, wrist] = [first, first + 1, first + 2].map(|joint| sources.point(joint));
            Some(Self { shoulder: shoulder?, elbow: elbow?, wrist: wrist? })
        })
    }
}

/// Joint indices that span the torso.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Torso {
    /// Left and right shoulder.
    pub shoulders: [usize; 2],
    /// Left and right hip.
    pub hips: [usize; 2],
}

impl Torso {
    /// The torso, or an error that names what is missing; `path` is for the message only.
    ///
    /// # Errors
    /// If shoulders and hips go by no name that is known.
    pub fn find(motion: &Motion, path: &Path) -> Result<Self, MotionError> {
        let sides = [ArmSide::Left, ArmSide::Right];
        let found = CONVENTIONS.iter().find_map(|names| {
            let pair = |pattern| {
                let [left, right] = sides.map(|side| names.joint(motion, pattern, side));
                Some([left?, right?])
            };
            Some(Self { shoulders: pair(names.shoulder)?, hips: pair(names.hip)? })
        });
        let found = found.or_else(|| {
            let sources = JointSources::find(&motion.joints, true, Path::new("")).ok()?;
            let pair = |joints: [usize; 2]| {
                let [left, right] = joints.map(|joint| sources.point(joint));
                Some([left?, right?])
            };
            Some(Self { shoulders: pair(SHOULDERS)?, hips: pair(HIPS)? })
        });
        found.ok_or_else(|| MotionError::NoJoint {
            path: path.to_path_buf(),
            wanted: "shoulders and hips (e.g. lclavicle, rclavicle, lhipjoint, rhipjoint, or LeftArm ... RightUpLeg)"
                .into(),
            joints: motion.joints.clone(),
        })
    }

    /// Torso frame of one frame's joint `positions`: rows left, up, front, so that the matrix turns
    /// a vector into torso axes. Up runs from the middle of the hips to the middle of the
    /// shoulders. Left runs from the right shoulder to the left one, orthogonal to up. `None` where
    /// these have no direction.
    #[must_use]
    pub fn axes(&self, positions: &[Vec3]) -> Option<Mat3> {
        let [left, right] = self.shoulders.map(|joint| positions[joint]);
        let [left_hip, right_hip] = self.hips.map(|joint| positions[joint]);
        let up = unit(left + right - left_hip - right_hip)?;
        let across = left - right;
        let left = unit(across - up * across.dot(&up))?;
        let front = left.cross(&up);
        Some(Mat3::from_rows(&[left.transpose(), up.transpose(), front.transpose()]))
    }
}
