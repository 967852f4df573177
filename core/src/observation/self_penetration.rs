//! Density of poses against self-penetration, optional; future work in the PIK paper.

use super::body_surface::BodySurface;
use super::capsule::Capsule;
use crate::error::{ParameterError, positive};
use crate::kinematics::forward::posture;
use crate::math::{Vec3, max};
use crate::skeleton::Skeleton;
use crate::skeleton::limbs::{Limbs, MAX_GROUPS, TRUNK_GROUP};

/// log p(theta) = -1/2 sum over pairs of bones (depth / std)^2, with the depth of two capsules
/// beyond that at rest.
///
/// Bones that share a joint are no pair: parent and child, and children of one parent.
///
/// ```
/// use sinew_core::kinematics::forward::posture;
/// use sinew_core::math::Vec3;
/// use sinew_core::observation::{
///     body_surface::BodySurface, self_penetration::SelfPenetration,
/// };
/// use sinew_core::skeleton::BodyMeasures;
/// use sinew_core::skeleton::full_body::{
///     BODY_ANGLE_NAMES, BODY_ANGLES, body_radii_m, full_body,
/// };
///
/// let measures = BodyMeasures::of_height(1.75)?;
/// let (skeleton, radii_m) = (full_body(&measures)?, body_radii_m(&measures));
/// let density = SelfPenetration::new(&skeleton, &radii_m, 0.02)?;
/// let log_density = |pose: &[f32; BODY_ANGLES]| {
///     density.log_density(&BodySurface::new(
///         &posture(&skeleton, &Vec3::zeros(), pose),
///         &radii_m,
///         -Vec3::z(),
///     ))
/// };
/// // A standing pose has no penalty, a leg through the other one has.
/// let mut pose = [0.0; BODY_ANGLES];
/// assert_eq!(log_density(&pose), 0.0);
/// let hip = BODY_ANGLE_NAMES
///     .iter()
///     .position(|name| *name == "l_hip_abduction")
///     .expect("it has this name");
/// pose[hip] = -0.5;
/// assert!(log_density(&pose) < -5.0);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SelfPenetration<const BONES: usize> {
    std_m: f32,
    /// Depth without penalty, metres; infinite for bones that are no pair.
    free_m: [[f32; BONES]; BONES],
}

impl<const BONES: usize> SelfPenetration<BONES> {
    /// The density of a body whose capsules may penetrate by about `std_m` metres.
    ///
    /// # Errors
    /// `std_m` has to be positive.
    pub fn new<const ANGLES: usize>(
        skeleton: &Skeleton<BONES, ANGLES>,
        radii_m: &[f32; BONES],
        std_m: f32,
    ) -> Result<Self, ParameterError> {
        let std_m = positive("self_penetration_std_m", std_m)?;
        let rest = posture(skeleton, &Vec3::zeros(), &skeleton.clamp([0.0; ANGLES]));
        let capsule =
            |bone: usize| Capsule { start_m: rest.joints[bone], end_m: rest.ends[bone], radius_m: radii_m[bone] };
        let mut free_m = [[f32::INFINITY; BONES]; BONES];
        for (a, bone) in skeleton.bones().iter().enumerate() {
            for (b, other) in skeleton.bones().iter().enumerate().take(a) {
                let is_parent = |parent: Option<u8>, bone: usize| parent.map(usize::from) == Some(bone);
                let meet = is_parent(bone.parent, b) || is_parent(other.parent, a) || bone.parent == other.parent;
                if !meet {
                    free_m[a][b] = max(capsule(a).depth_m(&capsule(b)), 0.0);
                }
            }
        }
        Ok(Self { std_m, free_m })
    }

    /// log density of the pose with this surface, up to its constant: zero without penetration.
    #[must_use]
    pub fn log_density(&self, surface: &BodySurface<BONES>) -> f32 {
        self.log_densities(surface, &Limbs::none())[TRUNK_GROUP]
    }

    /// The same in the trunk's place, then the part of it in which each limb has a share.
    #[must_use]
    pub fn log_densities(&self, surface: &BodySurface<BONES>, limbs: &Limbs<BONES>) -> [f32; MAX_GROUPS] {
        let mut sums = [0.0; MAX_GROUPS];
        for (index, one) in surface.capsules.iter().enumerate() {
            for other in surface.capsules.iter().take(index) {
                let free_m = self.free_m.get(one.bone).and_then(|row| row.get(other.bone)).copied();
                let Some(free_m) = free_m.filter(|free_m| free_m.is_finite()) else { continue };
                let depth_m = max(one.capsule.depth_m(&other.capsule) - free_m, 0.0);
                let (group, another) = (limbs.group(one.bone), limbs.group(other.bone));
                for (place, sum) in sums.iter_mut().enumerate() {
                    let has_share = place == TRUNK_GROUP || place == group || place == another;
                    *sum += if has_share { depth_m * depth_m } else { 0.0 };
                }
            }
        }
        sums.map(|sum| -sum / (2.0 * self.std_m * self.std_m))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skeleton::BodyMeasures;
    use crate::skeleton::full_body::{BODY_ANGLE_NAMES, BODY_ANGLES, BODY_BONES, body_radii_m, full_body};

    /// log density of a pose given by names and degrees.
    fn log_density(named: &[(&str, f32)]) -> f32 {
        let measures = BodyMeasures::of_height(1.75).unwrap();
        let (skeleton, radii) = (full_body(&measures).unwrap(), body_radii_m(&measures));
        let mut angles = [0.0; BODY_ANGLES];
        for (name, degrees) in named {
            angles[BODY_ANGLE_NAMES.iter().position(|other| other == name).unwrap()] = degrees.to_radians();
        }
        let there = posture(&skeleton, &Vec3::zeros(), &skeleton.clamp(angles));
        let surface = BodySurface::new(&there, &radii, Vec3::new(0.0, 0.0, -3.0));
        SelfPenetration::<BODY_BONES>::new(&skeleton, &radii, 0.02).unwrap().log_density(&surface)
    }

    #[test]
    fn poses_of_people_cost_nothing() {
        for pose in [
            &[][..],
            &[("l_shoulder_elevation", 90.0), ("r_shoulder_elevation", 90.0)],
            &[("l_hip_flexion", 90.0), ("l_knee_flexion", 90.0), ("r_hip_flexion", 40.0), ("r_knee_flexion", 60.0)],
            &[("l_elbow_flexion", 130.0), ("head_turn", 60.0), ("trunk_pitch", 50.0)],
        ] {
            assert_eq!(log_density(pose), 0.0, "{pose:?}");
        }
    }

    #[test]
    fn a_forearm_in_the_trunk_and_legs_through_one_another_cost() {
        // The upper arm hangs, turned inwards, the elbow bent: the forearm goes straight through
        // the trunk.
        let arm = [("l_shoulder_rotation", -90.0), ("l_elbow_flexion", 90.0)];
        let other_way = [("l_shoulder_rotation", 90.0), ("l_elbow_flexion", 90.0)];
        let inside = log_density(&arm).min(log_density(&other_way));
        assert!(inside < -5.0, "{inside}");
        assert!(log_density(&arm).max(log_density(&other_way)) > -0.5, "outwards is free");
        let legs = log_density(&[("l_hip_abduction", -25.0), ("r_hip_abduction", -25.0)]);
        assert!(legs < -5.0, "{legs}");
        let measures = BodyMeasures::of_height(1.75).unwrap();
        let (skeleton, radii) = (full_body(&measures).unwrap(), body_radii_m(&measures));
        let refused = SelfPenetration::<BODY_BONES>::new(&skeleton, &radii, 0.0).unwrap_err();
        assert_eq!(refused.parameter, "self_penetration_std_m");
    }
}
