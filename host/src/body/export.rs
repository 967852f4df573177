//! A tracked body for animation and biomechanics programs: BVH and TRC, y up.
//!
//! The files' axes are the camera's turned by half about x: x to the picture's right, y up, z
//! towards the camera.

use crate::body::BodyPart;
use crate::motion::export::{BvhFrame, ExportError, LayoutJoint, SkeletonLayout};
use sinew_core::math::{Mat3, Vec3, axis_rotation};
use sinew_core::skeleton::full_body::{
    BODY_ANGLES, BODY_BONES, BODY_JOINT_NAMES, BodySkeleton, COLLARS, FEET, FOREARMS, HEAD, HIPS, PELVIS, SHANKS,
    THIGHS, TRUNK, UPPER_ARMS,
};

/// Length of a hand that ends an arm's chain, metres; programs draw it.
const HAND_M: f32 = 0.08;
/// Height of the upper half of the head, metres.
const CROWN_M: f32 = 0.1;
/// Name of the joint that turns the trunk; it lies in the pelvis.
const TRUNK_JOINT: &str = "trunk";

/// A joint of the file: its name, its parent, the bones that lie between both, and the bone that it
/// turns.
struct Node {
    name: &'static str,
    parent: Option<usize>,
    between: Vec<usize>,
    turns: Option<usize>,
}

/// The joints of `part` by their names, and `trunk`: one joint turns all that hangs on it, and neck
/// and hips do not turn alike.
fn nodes(part: BodyPart) -> Vec<Node> {
    let joint = |bone: usize, parent, turns| Node { name: BODY_JOINT_NAMES[bone], parent, between: vec![bone], turns };
    let mut nodes = vec![
        Node { name: BODY_JOINT_NAMES[PELVIS], parent: None, between: Vec::new(), turns: Some(PELVIS) },
        Node { name: TRUNK_JOINT, parent: Some(0), between: Vec::new(), turns: Some(TRUNK) },
        joint(TRUNK, Some(1), Some(HEAD)),
        joint(HEAD, Some(2), None),
    ];
    for side in 0..2 {
        let first = nodes.len();
        nodes.push(Node {
            between: vec![TRUNK, COLLARS[side]],
            ..joint(COLLARS[side], Some(1), Some(UPPER_ARMS[side]))
        });
        nodes.push(joint(UPPER_ARMS[side], Some(first), Some(FOREARMS[side])));
        nodes.push(joint(FOREARMS[side], Some(first + 1), None));
    }
    for side in if part == BodyPart::Whole { 0..2 } else { 0..0 } {
        let first = nodes.len();
        nodes.push(joint(HIPS[side], Some(0), Some(THIGHS[side])));
        nodes.push(joint(THIGHS[side], Some(first), Some(SHANKS[side])));
        nodes.push(joint(SHANKS[side], Some(first + 1), Some(FEET[side])));
        nodes.push(joint(FEET[side], Some(first + 2), None));
    }
    nodes
}

/// A place or offset of the camera's axes with y up.
#[must_use]
pub fn upwards(place_m: &Vec3) -> Vec3 {
    Vec3::new(place_m.x, -place_m.y, -place_m.z)
}

/// The skeleton at rest: upright, facing +z, arms hanging.
///
/// # Errors
/// Offsets that are not finite.
pub fn body_layout(part: BodyPart, skeleton: &BodySkeleton) -> Result<SkeletonLayout, ExportError> {
    let offset_m = |bone: &usize| skeleton.bones()[*bone].offset_m;
    let end_m = |name: &str| match name {
        "head" => Some(Vec3::new(0.0, CROWN_M, 0.0)),
        "l_wrist" | "r_wrist" => Some(Vec3::new(0.0, -HAND_M, 0.0)),
        _ => None,
    };
    let joint = |node: Node| LayoutJoint {
        name: node.name.to_owned(),
        parent: node.parent,
        offset_m: upwards(&node.between.iter().map(offset_m).sum()),
        end_m: end_m(node.name),
    };
    SkeletonLayout::new(nodes(part).into_iter().map(joint).collect())
}

/// A pose of the body, for the layout of [`body_layout`].
#[must_use]
pub fn bvh_frame(part: BodyPart, skeleton: &BodySkeleton, angles_rad: &[f32; BODY_ANGLES]) -> BvhFrame {
    let rotations = local_rotations(skeleton, angles_rad);
    let turned = |node: Node| node.turns.map_or_else(Mat3::identity, |bone| rotation_upwards(&rotations[bone]));
    BvhFrame {
        root_position_m: upwards(&Vec3::new(angles_rad[0], angles_rad[1], angles_rad[2])),
        local_rotations: nodes(part).into_iter().map(turned).collect(),
    }
}

/// Rotation of each bone against its parent, camera axes at rest.
fn local_rotations(skeleton: &BodySkeleton, angles_rad: &[f32; BODY_ANGLES]) -> [Mat3; BODY_BONES] {
    let mut rotations = [Mat3::identity(); BODY_BONES];
    let mut coordinates = angles_rad.iter();
    for (rotation, bone) in rotations.iter_mut().zip(skeleton.bones()) {
        for (index, axis) in bone.joint.axes().iter().enumerate() {
            let value = coordinates.next().copied().unwrap_or(0.0);
            if index >= bone.joint.shift_count() {
                *rotation *= axis_rotation(axis, value);
            }
        }
    }
    rotations
}

fn rotation_upwards(rotation: &Mat3) -> Mat3 {
    let half_turn = Mat3::from_diagonal(&Vec3::new(1.0, -1.0, -1.0));
    half_turn * rotation * half_turn
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::bvh::parse;
    use crate::motion::export::write_bvh;
    use proptest::prelude::*;

    const WHOLE: BodyPart = BodyPart::Whole;

    use sinew_core::kinematics::forward::posture;
    use sinew_core::skeleton::BodyMeasures;
    use sinew_core::skeleton::full_body::full_body;
    use std::path::Path;

    proptest! {
        #[test]
        fn the_joints_of_the_file_are_those_of_the_pose(shares in prop::collection::vec(0.0_f32..=1.0, BODY_ANGLES)) {
            let mut measures = BodyMeasures::of_height(1.8).unwrap();
            measures.shoulder_m.z = 0.03;
            let skeleton = full_body(&measures).unwrap();
            let mut angles = [0.0; BODY_ANGLES];
            for (i, limit) in skeleton.limits().iter().enumerate() {
                let (low, high) = (limit.low_rad.max(-4.0), limit.high_rad.min(4.0));
                angles[i] = low + (high - low) * shares[i];
            }
            let mut bytes = Vec::new();
            write_bvh(&body_layout(WHOLE, &skeleton).unwrap(), &[bvh_frame(WHOLE, &skeleton, &angles)], 15.0, &mut bytes).unwrap();
            let motion = parse(&String::from_utf8(bytes).unwrap(), Path::new("track.bvh"), Some(0.01)).unwrap();
            let ends = posture(&skeleton, &Vec3::zeros(), &angles).ends;
            for (name, end) in BODY_JOINT_NAMES.iter().zip(&ends) {
                let found = motion.frame(0)[motion.joint(name).unwrap()];
                prop_assert!((found - upwards(end)).norm() < 1.0e-4, "{}: {} instead of {}", name, found, upwards(end));
            }
        }
    }
}
