//! Jacobian of a bone's end by each angle: axis x (end-effector - joint), figure 5 of the PIK
//! paper.

use super::forward::Posture;
use crate::math::Vec3;
use crate::skeleton::Skeleton;

/// Derivative of the end of `bone` with respect to `angle`, metres per radian.
///
/// ```
/// use sinew_core::kinematics::forward::posture;
/// use sinew_core::kinematics::jacobian::column;
/// use sinew_core::math::Vec3;
/// use sinew_core::skeleton::arm::{FOREARM, UPPER_ARM};
/// use sinew_core::skeleton::{ArmGeometry, Side};
///
/// let arm = ArmGeometry::new(Side::Right, 0.30, 0.35)?.skeleton()?;
/// let pose = posture(&arm, &Vec3::zeros(), &[0.4, 0.2, 0.1, 1.0]);
/// // Angle 3 is the elbow: it swings the hand on a circle as wide as the forearm, and leaves the
/// // elbow where it is.
/// assert!((column(&arm, &pose, FOREARM, 3).norm() - 0.35).abs() < 1e-5);
/// assert_eq!(column(&arm, &pose, UPPER_ARM, 3), Vec3::zeros());
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[inline]
#[must_use]
pub fn column<const BONES: usize, const ANGLES: usize>(
    skeleton: &Skeleton<BONES, ANGLES>,
    posture: &Posture<BONES, ANGLES>,
    bone: usize,
    angle: usize,
) -> Vec3 {
    if !skeleton.angle_moves(angle, bone) {
        return Vec3::zeros();
    }
    moving_column(skeleton, posture, bone, angle)
}

/// As [`column`], for an angle that is known to move the bone.
#[inline]
#[must_use]
pub(super) fn moving_column<const BONES: usize, const ANGLES: usize>(
    skeleton: &Skeleton<BONES, ANGLES>,
    posture: &Posture<BONES, ANGLES>,
    bone: usize,
    angle: usize,
) -> Vec3 {
    if skeleton.is_shift(angle) {
        return posture.axes.get(angle).copied().unwrap_or_default();
    }
    match (posture.axes.get(angle), posture.ends.get(bone), posture.joints.get(skeleton.bone_of_angle(angle))) {
        (Some(axis), Some(end), Some(joint)) => axis.cross(&(end - joint)),
        _ => Vec3::zeros(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::forward::posture;
    use crate::skeleton::{ArmGeometry, Side};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_jacobian_is_the_slope_of_forward_kinematics(
            angles in prop::array::uniform4(-1.5_f32..1.5), bone in 0_usize..2, angle in 0_usize..4,
        ) {
            let skeleton = ArmGeometry::new(Side::Right, 0.3, 0.35).unwrap().skeleton().unwrap();
            let step = 0.01;
            let (mut below, mut above) = (angles, angles);
            below[angle] -= step;
            above[angle] += step;
            let root = Vec3::new(0.1, 0.2, 1.0);
            let slope = (posture(&skeleton, &root, &above).ends[bone] - posture(&skeleton, &root, &below).ends[bone])
                / (2.0 * step);
            let exact = column(&skeleton, &posture(&skeleton, &root, &angles), bone, angle);
            prop_assert!((slope - exact).norm() < 1.0e-4, "{} instead of {}", slope, exact);
        }
    }
}
