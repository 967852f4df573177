//! The skeleton at rest, as files of motion describe it.

use super::error::ExportError;
use sinew_core::math::Vec3;
use std::collections::BTreeSet;

/// A joint at rest.
#[derive(Debug, Clone, PartialEq)]
pub struct LayoutJoint {
    /// Its name: not empty, without blanks, like no other's.
    pub name: String,
    /// Index of the joint that it hangs from; `None` for the root only.
    pub parent: Option<usize>,
    /// Place relative to the parent's joint at rest, metres, y up.
    pub offset_m: Vec3,
    /// Of a joint without children, where its bone ends: relative to the joint at rest, metres. Of
    /// no use elsewhere. `None` is the joint itself.
    pub end_m: Option<Vec3>,
}

/// Joints of a skeleton, the root first and parents before their children: a tree.
#[derive(Debug, Clone, PartialEq)]
pub struct SkeletonLayout {
    joints: Vec<LayoutJoint>,
}

impl SkeletonLayout {
    /// Checks that `joints` are a tree with one root, the first; that names are words of their own;
    /// that numbers are finite.
    ///
    /// # Errors
    /// [`ExportError::Layout`] names the joint and the rule.
    pub fn new(joints: Vec<LayoutJoint>) -> Result<Self, ExportError> {
        if joints.is_empty() {
            let rule = "must hold at least the root".to_owned();
            return Err(ExportError::Parameter { parameter: "joints", rule });
        }
        let mut names = BTreeSet::new();
        for (index, joint) in joints.iter().enumerate() {
            let is_finite = |place: &Vec3| place.iter().all(|value| value.is_finite());
            let rule = if (index == 0) != joint.parent.is_none() {
                "has to hang from another one unless it is the first, which is the only root"
            } else if joint.parent.is_some_and(|parent| parent >= index) {
                "comes before its parent; list parents first"
            } else if joint.name.is_empty() || joint.name.contains(char::is_whitespace) {
                "needs a name without blanks"
            } else if !names.insert(joint.name.as_str()) {
                "has the name of an earlier one; give it a name of its own"
            } else if !is_finite(&joint.offset_m) || !joint.end_m.as_ref().is_none_or(is_finite) {
                "has a place that is not finite"
            } else {
                continue;
            };
            return Err(ExportError::Layout { joint: index, name: joint.name.clone(), rule });
        }
        Ok(Self { joints })
    }

    /// The joints.
    #[must_use]
    pub fn joints(&self) -> &[LayoutJoint] {
        &self.joints
    }

    /// Indices of all joints with their depth (0 for the root), each one followed by all that hangs
    /// from it; siblings keep their order.
    #[must_use]
    pub fn depth_first(&self) -> Vec<(usize, usize)> {
        let mut children = vec![Vec::new(); self.joints.len()];
        for (index, joint) in self.joints.iter().enumerate() {
            if let Some(parent) = joint.parent {
                children[parent].push(index);
            }
        }
        let mut order = Vec::with_capacity(self.joints.len());
        let mut open = vec![(0, 0)];
        while let Some((index, depth)) = open.pop() {
            order.push((index, depth));
            open.extend(children[index].iter().rev().map(|&child| (child, depth + 1)));
        }
        order
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joint(name: &str, parent: Option<usize>) -> LayoutJoint {
        LayoutJoint { name: name.to_owned(), parent, offset_m: Vec3::zeros(), end_m: None }
    }

    #[test]
    fn branches_follow_one_another() {
        let joints = [("a", None), ("b", Some(0)), ("c", Some(0)), ("d", Some(1)), ("e", Some(2)), ("f", Some(1))];
        let layout = SkeletonLayout::new(joints.map(|(name, parent)| joint(name, parent)).to_vec()).unwrap();
        assert_eq!(layout.depth_first(), [(0, 0), (1, 1), (3, 2), (5, 2), (2, 1), (4, 2)]);
    }

    #[test]
    fn what_is_no_tree_of_named_joints_is_refused() {
        let far = LayoutJoint { offset_m: Vec3::new(0.0, f32::INFINITY, 0.0), ..joint("b", Some(0)) };
        let cases = [
            (vec![], "`joints` must hold"),
            (vec![joint("a", Some(0))], "joint 0 of the skeleton (`a`) has to hang"),
            (vec![joint("a", None), joint("b", None)], "joint 1 of the skeleton (`b`) has to hang"),
            (vec![joint("a", None), joint("b", Some(1))], "(`b`) comes before its parent"),
            (vec![joint("a", None), joint("b c", Some(0))], "without blanks"),
            (vec![joint("", None)], "without blanks"),
            (vec![joint("a", None), joint("a", Some(0))], "the name of an earlier one"),
            (vec![joint("a", None), far], "not finite"),
        ];
        for (joints, wanted) in cases {
            let found = SkeletonLayout::new(joints).unwrap_err().to_string();
            assert!(found.contains(wanted), "{found} does not contain {wanted}");
        }
    }
}
