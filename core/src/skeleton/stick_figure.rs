//! A 2D stick figure: joints in a tree, each posed by the image angle of the line from its parent
//! (cyclic paper, section 2.1).
//!
//! Axes are the image's: x right, y down, in pixels. The angle of a joint is atan2(dy, dx) of the
//! vector parent -> joint. It is relative to the image and not to the parent's own direction. The
//! root has no angle: angle `i` belongs to joint `i + 1`. The tree is data, so figures with other
//! joints work alike; [`HUMAN`] is the one of the paper.
//!
//! ```
//! use sinew_core::skeleton::stick_figure::{HUMAN, HUMAN_ANGLES, HUMAN_JOINTS};
//!
//! let knee = HUMAN.angle_index("l_knee").expect("a person has knees");
//! // Everything hangs, but for the trunk, which is the first angle and points up.
//! let mut angles_rad = [1.5708; HUMAN_ANGLES];
//! angles_rad[0] = -1.5708;
//! let mut joints_px = [[0.0; 2]; HUMAN_JOINTS];
//! HUMAN.joint_positions([320.0, 240.0], &[50.0; HUMAN_ANGLES], &angles_rad, &mut joints_px);
//!
//! let joints_px = joints_px.map(Some);
//! let segment = HUMAN.segment(&joints_px, knee).expect("both of its ends are there");
//! assert!((segment.length_px - 50.0).abs() < 1e-3);
//! assert!((segment.angle_rad.expect("it has a length") - 1.5708).abs() < 1e-4);
//! ```

use crate::error::{ParameterError, Rule};
use crate::math::{atan2, sin_cos, sqrt, wrap_angle};
use core::f32::consts::PI;

/// Largest number of joints of a figure.
pub const MAX_JOINTS: usize = 64;
/// Joints of [`HUMAN`].
pub const HUMAN_JOINTS: usize = 14;
/// Angles of [`HUMAN`].
pub const HUMAN_ANGLES: usize = HUMAN_JOINTS - 1;

/// A point of the image, pixels: x right, y down.
///
/// ```
/// use sinew_core::skeleton::stick_figure::{HUMAN, HUMAN_JOINTS, ImagePoint};
///
/// // A recording of hips and neck only.
/// let mut joints_px: [Option<ImagePoint>; HUMAN_JOINTS] = [None; HUMAN_JOINTS];
/// joints_px[0] = Some([320.0, 240.0]);
/// joints_px[1] = Some([320.0, 140.0]);
/// assert_eq!(HUMAN.segment(&joints_px, 0).map(|trunk| trunk.length_px), Some(100.0));
/// assert_eq!(HUMAN.segment(&joints_px, 1), None, "no shoulder was seen");
/// ```
pub type ImagePoint = [f32; 2];

/// A joint of a stick figure.
///
/// ```
/// use sinew_core::skeleton::{StickFigure, StickJoint};
///
/// let joint = |name, parent, mirror| StickJoint { name, parent, mirror };
/// // Left and right refer to each other; a joint of the midline refers to itself.
/// let shoulders = [
///     joint("neck", None, 0),
///     joint("l_shoulder", Some(0), 2),
///     joint("r_shoulder", Some(0), 1),
/// ];
/// let figure = StickFigure::new(&shoulders)?;
/// let mut angles_rad = [Some(0.2), None];
/// figure.mirror(&mut angles_rad);
/// assert_eq!(angles_rad[0], None, "the right one was not seen");
/// assert!(
///     (angles_rad[1].expect("it was the left one") - (core::f32::consts::PI - 0.2)).abs()
///         < 1e-6
/// );
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StickJoint<'a> {
    /// Name, such as `l_elbow`.
    pub name: &'a str,
    /// Index of the joint that this one hangs on; `None` at the root.
    pub parent: Option<u8>,
    /// Index of the same joint of the other body side; the joint's own index where it lies on the
    /// midline.
    pub mirror: u8,
}

/// A tree of joints.
///
/// Invariants: joint 0 is the root and the only one; parents stand before their children; `mirror`
/// is its own inverse and maps parents to parents.
///
/// ```
/// use sinew_core::skeleton::{StickFigure, StickJoint};
///
/// // A finger: three joints in a row, all on the midline.
/// let joint = |name, parent, mirror| StickJoint { name, parent, mirror };
/// let joints =
///     [joint("knuckle", None, 0), joint("middle", Some(0), 1), joint("tip", Some(1), 2)];
/// let finger = StickFigure::new(&joints)?;
/// assert_eq!(finger.angle_index("tip"), Some(1));
/// let mut places_px = [[0.0; 2]; 3];
/// finger.joint_positions(
///     [100.0, 100.0],
///     &[30.0, 20.0],
///     &[0.0, core::f32::consts::FRAC_PI_2],
///     &mut places_px,
/// );
/// assert_eq!(places_px[1], [130.0, 100.0]);
/// assert!(
///     (places_px[2][1] - 120.0).abs() < 1e-4,
///     "angles are the image's, and y points down"
/// );
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StickFigure<'a> {
    joints: &'a [StickJoint<'a>],
}

const fn joint(name: &'static str, parent: u8, mirror: u8) -> StickJoint<'static> {
    StickJoint { name, parent: Some(parent), mirror }
}

/// The joints of [`HUMAN`], root first.
const HUMAN_TREE: [StickJoint<'static>; HUMAN_JOINTS] = [
    StickJoint { name: "hip_center", parent: None, mirror: 0 },
    joint("neck", 0, 1),
    joint("l_shoulder", 1, 5),
    joint("l_elbow", 2, 6),
    joint("l_wrist", 3, 7),
    joint("r_shoulder", 1, 2),
    joint("r_elbow", 5, 3),
    joint("r_wrist", 6, 4),
    joint("l_hip", 0, 11),
    joint("l_knee", 8, 12),
    joint("l_ankle", 9, 13),
    joint("r_hip", 0, 8),
    joint("r_knee", 11, 9),
    joint("r_ankle", 12, 10),
];

/// The figure of the cyclic paper: 14 joints, 13 angles, 11 rigid parts (figure 1).
pub const HUMAN: StickFigure<'static> = StickFigure { joints: &HUMAN_TREE };

impl<'a> StickFigure<'a> {
    /// Checks and borrows a tree.
    ///
    /// # Errors
    /// From 2 to [`MAX_JOINTS`] joints; the first and no other without a parent; parents before
    /// their children; `mirror` its own inverse, with the parents mirrored alike.
    pub fn new(joints: &'a [StickJoint<'a>]) -> Result<Self, ParameterError> {
        if joints.len() < 2 {
            return Err(ParameterError::new("joints", Rule::NotEmpty));
        }
        if joints.len() > MAX_JOINTS {
            return Err(ParameterError::new("joints", Rule::Capacity { capacity: MAX_JOINTS }));
        }
        let mirror_of = |index: usize| joints.get(index).map(|joint| usize::from(joint.mirror));
        for (index, joint) in joints.iter().enumerate() {
            let parent_stands_before = match joint.parent {
                None => index == 0,
                Some(parent) => usize::from(parent) < index,
            };
            if !parent_stands_before {
                let rule = Rule::Within { low: 0.0, high: index as f32 - 1.0 };
                return Err(ParameterError::new("joint.parent", rule));
            }
            let other = joints.get(usize::from(joint.mirror));
            let mirrored_parent = joint.parent.map(|parent| mirror_of(usize::from(parent)));
            let agrees = other.is_some_and(|other| {
                usize::from(other.mirror) == index && other.parent.map(|p| Some(usize::from(p))) == mirrored_parent
            });
            if !agrees {
                return Err(ParameterError::new("joint.mirror", Rule::SelfInverse));
            }
        }
        Ok(Self { joints })
    }

    /// The joints, root first.
    #[must_use]
    pub const fn joints(&self) -> &'a [StickJoint<'a>] {
        self.joints
    }

    /// Number of angles: one for each joint but the root.
    #[must_use]
    pub const fn angle_count(&self) -> usize {
        self.joints.len().saturating_sub(1)
    }

    /// Names of the angles, in their order: those of the joints after the root.
    pub fn angle_names(&self) -> impl ExactSizeIterator<Item = &'a str> + use<'a> {
        self.joints.get(1..).unwrap_or_default().iter().map(|joint| joint.name)
    }

    /// Index of the joint called `name`.
    #[must_use]
    pub fn joint_index(&self, name: &str) -> Option<usize> {
        self.joints.iter().position(|joint| joint.name == name)
    }

    /// Index of the angle of the joint called `name`; `None` for the root too.
    #[must_use]
    pub fn angle_index(&self, name: &str) -> Option<usize> {
        self.joint_index(name)?.checked_sub(1)
    }

    /// Writes where the joints lie, pixels, given the root, the length of each segment and the
    /// angle of each joint.
    ///
    /// `lengths_px` and `angles_rad` have an entry for each joint but the root. Joints for which an
    /// entry or a place in `joints_px` is missing are left out.
    pub fn joint_positions(
        &self,
        root_px: ImagePoint,
        lengths_px: &[f32],
        angles_rad: &[f32],
        joints_px: &mut [ImagePoint],
    ) {
        if let Some(first) = joints_px.first_mut() {
            *first = root_px;
        }
        let segments = self.joints.iter().enumerate().skip(1).zip(lengths_px.iter().zip(angles_rad));
        for ((index, joint), (&length_px, &angle_rad)) in segments {
            let parent = joint.parent.and_then(|parent| joints_px.get(usize::from(parent)).copied());
            if let (Some(parent), Some(place)) = (parent, joints_px.get_mut(index)) {
                let (sine, cosine) = sin_cos(angle_rad);
                *place = [parent[0] + length_px * cosine, parent[1] + length_px * sine];
            }
        }
    }

    /// Length in pixels and angle in (-pi, pi] of the segment that ends in joint `angle_index + 1`.
    ///
    /// `None` where either end is missing or not finite; no angle where both ends fall together.
    #[must_use]
    pub fn segment(&self, joints_px: &[Option<ImagePoint>], angle_index: usize) -> Option<Segment> {
        let joint = self.joints.get(angle_index.checked_add(1)?)?;
        let end = (*joints_px.get(angle_index + 1)?)?;
        let start = (*joints_px.get(usize::from(joint.parent?))?)?;
        let (dx, dy) = (end[0] - start[0], end[1] - start[1]);
        let length_px = sqrt(dx * dx + dy * dy);
        if !length_px.is_finite() {
            return None;
        }
        let angle_rad = (length_px > 0.0).then(|| wrap_angle(atan2(dy, dx)));
        Some(Segment { length_px, angle_rad })
    }

    /// Turns the pose into that of the mirror image: theta -> pi - theta, and the sides change
    /// places.
    ///
    /// A person who faces left is so turned into one who faces right. `None` (not seen) stays
    /// `None`. Twice is once back, up to rounding. Entries beyond the figure's angles are left
    /// alone.
    pub fn mirror(&self, angles_rad: &mut [Option<f32>]) {
        for (index, joint) in self.joints.iter().enumerate().skip(1) {
            let other = usize::from(joint.mirror);
            if other > index && other <= angles_rad.len() {
                angles_rad.swap(index - 1, other - 1);
            }
        }
        for angle in angles_rad.iter_mut().take(self.angle_count()).flatten() {
            *angle = wrap_angle(PI - *angle);
        }
    }
}

/// A segment as the image shows it.
///
/// ```
/// use sinew_core::skeleton::stick_figure::HUMAN;
///
/// let mut joints_px = [None; 14];
/// joints_px[0] = Some([100.0, 200.0]);
/// joints_px[1] = Some([130.0, 160.0]);
/// let trunk = HUMAN.segment(&joints_px, 0).expect("both of its ends were seen");
/// assert_eq!(trunk.length_px, 50.0);
/// assert!(
///     (trunk.angle_rad.expect("it has a length") + 0.9273).abs() < 1e-4,
///     "up and to the right"
/// );
/// // Where both ends fall together there is a length, zero, and no angle.
/// joints_px[1] = joints_px[0];
/// assert_eq!(HUMAN.segment(&joints_px, 0).and_then(|trunk| trunk.angle_rad), None);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Length, pixels.
    pub length_px: f32,
    /// Angle in (-pi, pi]; `None` where the length is zero.
    pub angle_rad: Option<f32>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_human_figure_keeps_the_rules_of_a_figure() {
        assert_eq!(StickFigure::new(&HUMAN_TREE), Ok(HUMAN));
        assert_eq!(HUMAN.angle_count(), 13);
        assert_eq!(HUMAN.angle_names().collect::<Vec<_>>()[..4], ["neck", "l_shoulder", "l_elbow", "l_wrist"]);
        assert_eq!(HUMAN.angle_index("r_ankle"), Some(12));
        assert_eq!(HUMAN.angle_index("hip_center"), None);
    }

    #[test]
    fn trees_that_are_none_are_refused() {
        let mut tree = HUMAN_TREE;
        tree[3].parent = Some(9);
        assert_eq!(StickFigure::new(&tree).unwrap_err().parameter, "joint.parent");
        tree = HUMAN_TREE;
        tree[2].parent = None;
        assert_eq!(StickFigure::new(&tree).unwrap_err().parameter, "joint.parent");
        tree = HUMAN_TREE;
        tree[2].mirror = 6;
        assert_eq!(StickFigure::new(&tree).unwrap_err().rule, Rule::SelfInverse);
        assert_eq!(StickFigure::new(&HUMAN_TREE[..1]).unwrap_err().rule, Rule::NotEmpty);
    }

    #[test]
    fn another_tree_is_only_other_data() {
        let chain = [
            StickJoint { name: "hip", parent: None, mirror: 0 },
            StickJoint { name: "knee", parent: Some(0), mirror: 1 },
            StickJoint { name: "ankle", parent: Some(1), mirror: 2 },
        ];
        let leg = StickFigure::new(&chain).unwrap();
        let mut joints = [[0.0; 2]; 3];
        leg.joint_positions([10.0, 20.0], &[5.0, 4.0], &[PI / 2.0, 0.0], &mut joints);
        assert!((joints[2][0] - 14.0).abs() < 1.0e-5 && (joints[2][1] - 25.0).abs() < 1.0e-5, "{joints:?}");
    }

    proptest! {
        #[test]
        fn the_angles_of_drawn_joints_are_those_they_were_drawn_from(
            angles in prop::array::uniform13(-3.1_f32..3.1),
            lengths in prop::array::uniform13(5.0_f32..80.0),
        ) {
            let mut joints = [[0.0; 2]; HUMAN_JOINTS];
            HUMAN.joint_positions([320.0, 240.0], &lengths, &angles, &mut joints);
            let seen = joints.map(Some);
            for i in 0..HUMAN_ANGLES {
                let segment = HUMAN.segment(&seen, i).unwrap();
                prop_assert!(wrap_angle(segment.angle_rad.unwrap() - angles[i]).abs() < 1.0e-4);
                prop_assert!((segment.length_px - lengths[i]).abs() < 1.0e-3);
            }
        }

        #[test]
        fn mirroring_draws_the_mirror_image_with_the_sides_swapped(angles in prop::array::uniform13(-3.1_f32..3.1)) {
            let lengths = [30.0; HUMAN_ANGLES];
            let mut mirrored = angles.map(Some);
            HUMAN.mirror(&mut mirrored);
            let (mut joints, mut image) = ([[0.0; 2]; HUMAN_JOINTS], [[0.0; 2]; HUMAN_JOINTS]);
            HUMAN.joint_positions([0.0; 2], &lengths, &angles, &mut joints);
            HUMAN.joint_positions([0.0; 2], &lengths, &mirrored.map(Option::unwrap), &mut image);
            for (joint, at) in HUMAN.joints().iter().zip(joints) {
                let other = image[usize::from(joint.mirror)];
                prop_assert!((other[0] + at[0]).abs() < 1.0e-3 && (other[1] - at[1]).abs() < 1.0e-3);
            }
        }
    }

    #[test]
    fn what_was_not_seen_has_no_segment() {
        let mut joints = [Some([1.0, 2.0]); HUMAN_JOINTS];
        assert_eq!(HUMAN.segment(&joints, 0).unwrap().angle_rad, None, "both ends fall together");
        joints[1] = None;
        assert_eq!(HUMAN.segment(&joints, 0), None);
        assert_eq!(HUMAN.segment(&joints, 1), None);
        joints[0] = Some([f32::NAN, 0.0]);
        assert_eq!(HUMAN.segment(&joints, 7), None);
        assert_eq!(HUMAN.segment(&joints, 99), None);
    }
}
