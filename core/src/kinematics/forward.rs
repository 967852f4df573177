//! Forward kinematics, PIK (1).
//!
//! ```
//! use sinew_core::kinematics::forward::posture;
//! use sinew_core::math::Vec3;
//! use sinew_core::skeleton::arm::FOREARM;
//! use sinew_core::skeleton::{ArmGeometry, Side};
//!
//! // With all angles zero an arm hangs straight down.
//! let arm = ArmGeometry::new(Side::Right, 0.30, 0.35)?;
//! let shoulder_m = Vec3::new(-0.2, 0.0, 1.0);
//! let hanging = posture(&arm.skeleton()?, &shoulder_m, &[0.0; 4]);
//! assert!((hanging.ends[FOREARM] - (shoulder_m + Vec3::new(0.0, 0.65, 0.0))).norm() < 1e-5);
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

use super::rotation::Rotation;
use crate::math::{Vec3, sin_cos_each};
use crate::skeleton::Skeleton;

/// Where all bones of a skeleton are in one pose.
///
/// ```
/// use sinew_core::kinematics::forward::posture;
/// use sinew_core::math::Vec3;
/// use sinew_core::skeleton::arm::{FOREARM, UPPER_ARM};
/// use sinew_core::skeleton::{ArmGeometry, Side};
///
/// let arm = ArmGeometry::new(Side::Left, 0.30, 0.35)?;
/// let pose = posture(&arm.skeleton()?, &Vec3::new(0.2, -0.1, 1.2), &[0.6, 0.2, 0.1, 1.2]);
/// assert_eq!(pose.joints[FOREARM], pose.ends[UPPER_ARM], "the forearm begins at the elbow");
/// assert!(((pose.ends[FOREARM] - pose.joints[FOREARM]).norm() - 0.35).abs() < 1e-5);
/// // The elbow is a hinge across the forearm.
/// assert!(pose.axes[3].dot(&(pose.ends[FOREARM] - pose.joints[FOREARM])).abs() < 1e-5);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Posture<const BONES: usize, const ANGLES: usize> {
    /// Joint at which each bone starts, metres.
    pub joints: [Vec3; BONES],
    /// End of each bone, metres: the end-effectors.
    pub ends: [Vec3; BONES],
    /// Unit axis about which each angle turns in this pose.
    pub axes: [Vec3; ANGLES],
}

/// The posture of `skeleton` at `root_m` with `angles_rad`.
///
/// ```
/// use core::f32::consts::FRAC_PI_2;
/// use sinew_core::kinematics::forward::posture;
/// use sinew_core::math::Vec3;
/// use sinew_core::skeleton::{Bone, Joint, Limit, Skeleton};
///
/// // Two links of a metre that lie along x at rest, hinged in the plane of the image.
/// let link = |parent| Bone { parent, joint: Joint::Hinge(Vec3::z()), offset_m: Vec3::x() };
/// let chain =
///     Skeleton::new([link(None), link(Some(0))], [Limit::from_degrees(-180.0, 180.0); 2])?;
/// // A quarter turn and back again: an L.
/// let bent = posture(&chain, &Vec3::new(5.0, 0.0, 0.0), &[FRAC_PI_2, -FRAC_PI_2]);
/// assert!((bent.ends[0] - Vec3::new(5.0, 1.0, 0.0)).norm() < 1e-6);
/// assert!((bent.ends[1] - Vec3::new(6.0, 1.0, 0.0)).norm() < 1e-6);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[inline]
#[must_use]
pub fn posture<const BONES: usize, const ANGLES: usize>(
    skeleton: &Skeleton<BONES, ANGLES>,
    root_m: &Vec3,
    angles_rad: &[f32; ANGLES],
) -> Posture<BONES, ANGLES> {
    let mut result = Posture::folded();
    result.turn(skeleton, root_m, angles_rad);
    result
}

impl<const BONES: usize, const ANGLES: usize> Posture<BONES, ANGLES> {
    /// Room for a posture, all of it at the origin.
    pub(super) const fn folded() -> Self {
        const ORIGIN: Vec3 = Vec3::new(0.0, 0.0, 0.0);
        Self { joints: [ORIGIN; BONES], ends: [ORIGIN; BONES], axes: [ORIGIN; ANGLES] }
    }

    /// Becomes the posture of `skeleton` at `root_m` with `angles_rad`, in place.
    #[inline(never)]
    pub(super) fn turn(&mut self, skeleton: &Skeleton<BONES, ANGLES>, root_m: &Vec3, angles_rad: &[f32; ANGLES]) {
        let (sines, cosines) = sin_cos_each(angles_rad);
        let mut rotations = [Rotation::NONE; BONES];
        let mut angle = 0;
        for (index, bone) in skeleton.bones().iter().enumerate() {
            let parent = bone.parent.map(usize::from).filter(|&parent| parent < BONES);
            let (mut rotation, mut joint) =
                parent.map_or((Rotation::NONE, *root_m), |parent| (rotations[parent], self.ends[parent]));
            for axis in bone.joint.axes() {
                if angle >= ANGLES {
                    break;
                }
                if skeleton.is_shift(angle) {
                    self.axes[angle] = *axis;
                    joint += axis * angles_rad[angle];
                } else {
                    self.axes[angle] = rotation.turned(axis);
                    rotation = rotation.then(axis, (sines[angle], cosines[angle]));
                }
                angle += 1;
            }
            rotations[index] = rotation;
            self.joints[index] = joint;
            self.ends[index] = joint + rotation.turned(&bone.offset_m);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skeleton::{Bone, Joint, Limit};
    use core::f32::consts::FRAC_PI_2;

    #[test]
    fn a_planar_two_link_chain_lands_where_trigonometry_says() {
        let hinge = |parent| Bone { parent, joint: Joint::Hinge(Vec3::z()), offset_m: Vec3::x() };
        let limits = [Limit::from_degrees(-180.0, 180.0); 2];
        let chain = Skeleton::<2, 2>::new([hinge(None), hinge(Some(0))], limits).unwrap();
        let there = posture(&chain, &Vec3::new(5.0, 0.0, 0.0), &[FRAC_PI_2, -FRAC_PI_2]);
        assert!((there.ends[0] - Vec3::new(5.0, 1.0, 0.0)).norm() < 1.0e-6);
        assert!((there.ends[1] - Vec3::new(6.0, 1.0, 0.0)).norm() < 1.0e-6);
        assert_eq!(there.joints[1], there.ends[0]);
    }
}
