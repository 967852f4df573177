//! Points that a user named for joints.

use crate::motion::figure::{HIP_CENTER, HIPS, NECK, SHOULDERS};

/// What stands before a joint's name in the points that a file of names adds.
pub const PREFIX: &str = "sinew-names:";
/// Joints that can be named, and their places among those of the stick figure.
const JOINTS: [(&str, usize); 14] = [
    ("hips", HIP_CENTER),
    ("neck", NECK),
    ("left_shoulder", SHOULDERS[0]),
    ("left_elbow", SHOULDERS[0] + 1),
    ("left_wrist", SHOULDERS[0] + 2),
    ("right_shoulder", SHOULDERS[1]),
    ("right_elbow", SHOULDERS[1] + 1),
    ("right_wrist", SHOULDERS[1] + 2),
    ("left_hip", HIPS[0]),
    ("left_knee", HIPS[0] + 1),
    ("left_ankle", HIPS[0] + 2),
    ("right_hip", HIPS[1]),
    ("right_knee", HIPS[1] + 1),
    ("right_ankle", HIPS[1] + 2),
];
/// Points of the feet that can be named: heel and toe, left and right.
const FEET: [[&str; 2]; 2] = [["left_heel", "left_toe"], ["right_heel", "right_toe"]];

/// Where the points that a user named are among those of a motion.
#[derive(Debug)]
pub struct GivenNames<'a> {
    names: &'a [String],
}

impl<'a> GivenNames<'a> {
    /// Looks at the names of a motion's points.
    pub fn in_motion(names: &'a [String]) -> Self {
        Self { names }
    }

    /// The names that are the file's own; empty in place of the others.
    pub fn own(&self) -> Vec<String> {
        let own = |name: &String| if name.starts_with(PREFIX) { String::new() } else { name.clone() };
        self.names.iter().map(own).collect()
    }

    fn point(&self, joint: &str) -> Option<usize> {
        self.names.iter().position(|name| name.strip_prefix(PREFIX) == Some(joint))
    }

    /// Joints of the stick figure and the points that were named for them.
    pub fn joints(&self) -> impl Iterator<Item = (usize, usize)> {
        JOINTS.iter().filter_map(|(name, joint)| Some((*joint, self.point(name)?)))
    }

    /// Heel and toe of one foot.
    pub fn foot(&self, left: bool) -> [Option<usize>; 2] {
        FEET[usize::from(!left)].map(|name| self.point(name))
    }
}

/// All joints that can be named.
pub fn joint_names() -> impl Iterator<Item = &'static str> {
    JOINTS.iter().map(|(name, _)| *name).chain(FEET.into_iter().flatten())
}
