//! Least squares of residuals on bones: sums bone by bone, then the information about the angles.
//!
//! Take a residual along a unit normal n at a place h of a bone. With the bone's rigid motion (v,
//! omega) it changes by n'(v + omega x h) = [n; h x n]'[v; omega]. So all residuals of a bone are
//! one 6x6 information matrix and one 6-vector. Those of a subtree are the sum of its bones', and
//! an angle's column is its twist. The work for a point does not depend on how many angles move it
//! (the composite rigid body method of dynamics, R. Featherstone, 1987, for least squares).

use super::forward::Posture;
use crate::math::Vec3;
use crate::numeric::rolled::HAS_VECTORS;
use crate::skeleton::Skeleton;

/// Shifts and turns of a rigid body.
const TWIST: usize = 6;

/// Width of a row: its twist, its residual, and a zero that makes it whole vectors.
const ROW: usize = 8;

/// Information about one bone's rigid motion: rows of the sum of w [n; h x n] [n; h x n; r; 0]'.
type RigidInformation = [[f32; ROW]; TWIST];

/// Information about the motion of all bones of a pose.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyInformation<const BONES: usize> {
    of_bone: [RigidInformation; BONES],
    /// Places are taken relative to this one, which avoids cancellation, metres.
    about_m: Vec3,
}

impl<const BONES: usize> BodyInformation<BONES> {
    /// No information, about the origin.
    #[must_use]
    pub const fn empty() -> Self {
        Self { of_bone: [[[0.0; ROW]; TWIST]; BONES], about_m: Vec3::new(0.0, 0.0, 0.0) }
    }

    /// Becomes no information, about the root of `posture`.
    pub fn clear<const ANGLES: usize>(&mut self, posture: &Posture<BONES, ANGLES>) {
        self.of_bone.as_flattened_mut().as_flattened_mut().fill(0.0);
        self.about_m = posture.joints.first().copied().unwrap_or_default();
    }

    /// Adds a residual: the place `place_m` of `bone` should move by `residual_m` along the unit
    /// vector `normal`; `weight` is the inverse variance, 1 / m^2.
    #[inline]
    pub fn add(&mut self, bone: usize, place_m: &Vec3, normal: &Vec3, residual_m: f32, weight: f32) {
        let Some(information) = self.of_bone.get_mut(bone) else { return };
        let moment = (place_m - self.about_m).cross(normal);
        let row = [normal.x, normal.y, normal.z, moment.x, moment.y, moment.z, residual_m, 0.0];
        for (i, sums) in information.iter_mut().enumerate() {
            let weighted = weight * row[i];
            // The upper half is mirrored, so that it need not be summed.
            for (sum, entry) in sums.iter_mut().zip(row).take(if HAS_VECTORS { ROW } else { i + 1 }) {
                *sum += weighted * entry;
            }
            if !HAS_VECTORS {
                sums[TWIST] += weighted * residual_m;
            }
        }
    }

    /// Adds the sums to the gradient of a log density and to minus its second derivative,
    /// coordinate by coordinate.
    pub fn add_to<const ANGLES: usize>(
        &mut self,
        skeleton: &Skeleton<BONES, ANGLES>,
        posture: &Posture<BONES, ANGLES>,
        gradient: &mut [f32; ANGLES],
        hessian: &mut [[f32; ANGLES]; ANGLES],
    ) {
        self.sum_subtrees(skeleton);
        let mut twists = [[0.0; TWIST]; ANGLES];
        for j in 0..ANGLES {
            let bone = skeleton.bone_of_angle(j);
            twists[j] = self.twist(skeleton, posture, j, bone);
            let Some(below) = self.of_bone.get(bone) else { continue };
            let (mut push, mut of_row) = ([0.0; ROW], [0.0; ANGLES]);
            for (sums, twist) in below.iter().zip(twists[j]) {
                for (push, sum) in push.iter_mut().zip(sums) {
                    *push += sum * twist;
                }
            }
            gradient[j] += push[TWIST];
            for (i, (twist, row)) in twists.iter().zip(hessian.iter_mut()).enumerate().take(j + 1) {
                if skeleton.angle_moves(i, bone) {
                    let sum = twist.iter().zip(push).fold(0.0, |sum, (twist, push)| sum + twist * push);
                    row[j] += sum;
                    of_row[i] = sum;
                }
            }
            for (entry, sum) in hessian[j].iter_mut().zip(of_row).take(j) {
                *entry += sum;
            }
        }
    }

    /// Adds each bone's sums to its parent's, leaves first, and mirrors their lower halves.
    fn sum_subtrees<const ANGLES: usize>(&mut self, skeleton: &Skeleton<BONES, ANGLES>) {
        for bone in (0..BONES).rev() {
            let Some(parent) = skeleton.bones()[bone].parent.map(usize::from).filter(|&parent| parent < bone) else {
                continue;
            };
            let own = self.of_bone[bone];
            let Some(sum) = self.of_bone.get_mut(parent) else { continue };
            for (sum, own) in sum.as_flattened_mut().iter_mut().zip(own.as_flattened()) {
                *sum += own;
            }
        }
        for sums in &mut self.of_bone {
            for i in 0..TWIST {
                for j in 0..i {
                    sums[j][i] = sums[i][j];
                }
            }
        }
    }

    /// How the bone of a coordinate moves with it: (shift of the reference place, turn).
    fn twist<const ANGLES: usize>(
        &self,
        skeleton: &Skeleton<BONES, ANGLES>,
        posture: &Posture<BONES, ANGLES>,
        coordinate: usize,
        bone: usize,
    ) -> [f32; TWIST] {
        let axis = posture.axes[coordinate];
        if skeleton.is_shift(coordinate) {
            return [axis.x, axis.y, axis.z, 0.0, 0.0, 0.0];
        }
        let joint_m = posture.joints.get(bone).copied().unwrap_or(self.about_m);
        let shift = (joint_m - self.about_m).cross(&axis);
        [shift.x, shift.y, shift.z, axis.x, axis.y, axis.z]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::forward::posture;
    use crate::kinematics::jacobian::column;
    use crate::math::unit;
    use crate::random::Stream;
    use crate::skeleton::BodyMeasures;
    use crate::skeleton::full_body::{BODY_ANGLES, BODY_BONES, full_body};

    #[test]
    fn sums_by_bone_are_the_sums_by_point() {
        let skeleton = full_body(&BodyMeasures::of_height(1.7).unwrap()).unwrap();
        let mut stream = Stream::new(3, 0, 0);
        let mut angles = [0.0; BODY_ANGLES];
        angles.iter_mut().for_each(|angle| *angle = 0.5 * stream.normal());
        angles[2] = 3.0;
        let angles = skeleton.clamp(angles);
        let there = posture(&skeleton, &Vec3::zeros(), &angles);
        let mut information = BodyInformation::empty();
        information.clear(&there);
        let (mut gradient, mut hessian) = ([0.0_f64; BODY_ANGLES], [[0.0_f64; BODY_ANGLES]; BODY_ANGLES]);
        for point in 0..300 {
            let bone = point % BODY_BONES;
            let normal = unit(stream.normal3()).unwrap();
            let (residual, weight) = (0.1 * stream.normal(), 40.0);
            // At the end, where the plain Jacobian is known.
            information.add(bone, &there.ends[bone], &normal, residual, weight);
            let slopes =
                core::array::from_fn::<f32, BODY_ANGLES, _>(|i| normal.dot(&column(&skeleton, &there, bone, i)));
            for i in 0..BODY_ANGLES {
                gradient[i] += f64::from(weight * residual * slopes[i]);
                for j in 0..BODY_ANGLES {
                    hessian[i][j] += f64::from(weight) * f64::from(slopes[i]) * f64::from(slopes[j]);
                }
            }
        }
        let (mut found_gradient, mut found_hessian) = ([0.0; BODY_ANGLES], [[0.0; BODY_ANGLES]; BODY_ANGLES]);
        information.add_to(&skeleton, &there, &mut found_gradient, &mut found_hessian);
        for i in 0..BODY_ANGLES {
            assert!((f64::from(found_gradient[i]) - gradient[i]).abs() < 1.0e-2, "gradient {i}");
            for j in 0..BODY_ANGLES {
                let scale = 1.0 + (hessian[i][i] * hessian[j][j]).sqrt();
                assert!((f64::from(found_hessian[i][j]) - hessian[i][j]).abs() < 1.0e-4 * scale, "hessian {i} {j}");
            }
        }
    }
}
