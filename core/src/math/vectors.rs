//! Vectors and 3x3 matrices. Products here have the bits of nalgebra's, in which the compiler keeps
//! a check at level `z` that a panic stands behind.

use super::elementary::{sin_cos, sqrt};

/// Three-component vector of metres (or a unit direction).
///
/// ```
/// use sinew_core::math::Vec3;
///
/// // Camera axes: x to the right, y down, z away from the camera.
/// let (elbow_m, hand_m) = (Vec3::new(0.2, 0.1, 1.0), Vec3::new(0.2, 0.4, 1.0));
/// assert_eq!((hand_m - elbow_m).normalize(), Vec3::y(), "the forearm hangs");
/// ```
pub type Vec3 = nalgebra::Vector3<f32>;
/// 3x3 matrix, in this crate a rotation unless said otherwise.
///
/// ```
/// use core::f32::consts::FRAC_PI_2;
/// use sinew_core::math::{Mat3, Vec3, axis_rotation};
///
/// // Two quarter turns one after the other, the right one first.
/// let turned: Mat3 =
///     axis_rotation(&Vec3::z(), FRAC_PI_2) * axis_rotation(&Vec3::x(), FRAC_PI_2);
/// assert!((turned * Vec3::y() - Vec3::z()).norm() < 1e-6);
/// assert!((turned * turned.transpose() - Mat3::identity()).norm() < 1e-6);
/// ```
pub type Mat3 = nalgebra::Matrix3<f32>;

/// Unit vector along `v`, or `None` where `v` is too short (or not finite) to have a direction.
///
/// ```
/// use sinew_core::math::{Vec3, unit};
///
/// assert_eq!(unit(Vec3::new(0.0, -2.0, 0.0)), Some(-Vec3::y()));
/// assert_eq!(unit(Vec3::zeros()), None);
/// ```
#[inline]
#[must_use]
pub fn unit(v: Vec3) -> Option<Vec3> {
    let length = sqrt(v.dot(&v));
    if length > 1.0e-12 && length.is_finite() { Some(v / length) } else { None }
}

/// Euclidean length of `v`.
///
/// ```
/// use sinew_core::math::{Vec3, length};
///
/// let (shoulder_m, elbow_m) = (Vec3::new(0.0, 0.0, 2.0), Vec3::new(0.1, 0.2, 2.2));
/// assert!((length(&(elbow_m - shoulder_m)) - 0.3).abs() < 1e-6, "an upper arm of 30 cm");
/// ```
#[inline]
#[must_use]
pub fn length(v: &Vec3) -> f32 {
    sqrt(v.dot(v))
}

/// Rotation by `angle_rad` about the unit vector `axis` (right-handed), Rodrigues' formula.
///
/// ```
/// use sinew_core::math::{Vec3, axis_rotation};
///
/// // The thumb of the right hand along the axis, the fingers curl from x to y.
/// let turned = axis_rotation(&Vec3::z(), 90.0_f32.to_radians()) * Vec3::x();
/// assert!((turned - Vec3::y()).norm() < 1e-6);
/// ```
#[inline]
#[must_use]
pub fn axis_rotation(axis: &Vec3, angle_rad: f32) -> Mat3 {
    turn_columns(axis, sin_cos(angle_rad)).into()
}

/// `matrix` times `vector`.
#[inline(always)]
pub(crate) fn times(matrix: &Mat3, vector: &Vec3) -> Vec3 {
    transform(&matrix.data.0, [vector.x, vector.y, vector.z]).into()
}

/// `left` times `right`.
#[inline(always)]
pub(crate) fn product(left: &Mat3, right: &Mat3) -> Mat3 {
    right.data.0.map(|column| transform(&left.data.0, column)).into()
}

/// A matrix, by its columns, times a vector.
#[inline(always)]
pub(crate) fn transform([first, second, third]: &[[f32; 3]; 3], [x, y, z]: [f32; 3]) -> [f32; 3] {
    core::array::from_fn(|i| third[i] * z + (second[i] * y + first[i] * x))
}

/// The columns of [`axis_rotation`], from sine and cosine of the angle.
#[inline(always)]
pub(crate) fn turn_columns(axis: &Vec3, (sine, cosine): (f32, f32)) -> [[f32; 3]; 3] {
    let (x, y, z) = (axis.x, axis.y, axis.z);
    let rest = 1.0 - cosine;
    [
        [rest * x * x + cosine, rest * x * y + sine * z, rest * x * z - sine * y],
        [rest * x * y - sine * z, rest * y * y + cosine, rest * y * z + sine * x],
        [rest * x * z + sine * y, rest * y * z - sine * x, rest * z * z + cosine],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rotation_keeps_its_axis_and_turns_right_handed() {
        let turned = axis_rotation(&Vec3::z(), core::f32::consts::FRAC_PI_2) * Vec3::x();
        assert!((turned - Vec3::y()).norm() < 1.0e-6);
    }
}
