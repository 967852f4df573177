//! The mean of many rotations, and its three angles (PIK (30), for ball joints).

use crate::math::{Mat3, Vec3, abs, asin, atan2, clamp, times};

/// Steps of the polar decomposition; it converges quadratically.
const POLAR_STEPS: usize = 12;
/// A sum of unit rotations whose determinant is less than this has no useful mean.
/// Chosen: above the rounding of `f32`, far below the determinant of any cluster.
const MIN_DETERMINANT: f32 = 1.0e-4;

/// The rotation nearest to `sum`, the weighted sum of rotation matrices: the mean that makes the
/// sum of squared chords least. `None` where the rotations point all ways.
///
/// ```
/// use sinew_core::math::{Mat3, Vec3, axis_rotation};
/// use sinew_core::tracker::body::mean_rotation;
///
/// let turn = |angle_rad| axis_rotation(&Vec3::z(), angle_rad);
/// let mean = mean_rotation(&(turn(0.2) * 0.5 + turn(0.6) * 0.5)).expect("they point one way");
/// assert!((mean - turn(0.4)).norm() < 1e-4);
/// assert_eq!(mean_rotation(&Mat3::zeros()), None, "no way at all");
/// ```
#[must_use]
pub fn mean_rotation(sum: &Mat3) -> Option<Mat3> {
    let mut x = *sum;
    if !(x.determinant() > MIN_DETERMINANT) {
        return None;
    }
    for _ in 0..POLAR_STEPS {
        x = (x + inverse_transpose(&x)?) * 0.5;
    }
    (abs(x.determinant() - 1.0) < 1.0e-3).then_some(x)
}

fn inverse_transpose(m: &Mat3) -> Option<Mat3> {
    let [a, b, c] = m.data.0.map(Vec3::from);
    let determinant = a.dot(&b.cross(&c));
    let cofactors = [b.cross(&c), c.cross(&a), a.cross(&b)].map(|column| [column.x, column.y, column.z]);
    (determinant > 1.0e-9).then(|| Mat3::from(cofactors) / determinant)
}

/// Angles with R = R(axis 0) R(axis 1) R(axis 2); the axes are square to one another. The middle
/// one lies in [-pi/2, pi/2].
///
/// ```
/// use sinew_core::math::{Vec3, axis_rotation};
/// use sinew_core::tracker::body::angles_of_rotation;
///
/// let axes = [Vec3::y(), Vec3::z(), Vec3::x()];
/// let rotation = axis_rotation(&axes[0], 2.0) * axis_rotation(&axes[1], -0.5) * axis_rotation(&axes[2], 0.3);
/// let found = angles_of_rotation(&rotation, &axes);
/// assert!(found.iter().zip([2.0, -0.5, 0.3]).all(|(angle, wanted)| (angle - wanted).abs() < 1e-4), "{found:?}");
/// ```
#[must_use]
pub fn angles_of_rotation(rotation: &Mat3, axes: &[Vec3; 3]) -> [f32; 3] {
    let hand = if axes[0].dot(&axes[1].cross(&axes[2])) < 0.0 { -1.0 } else { 1.0 };
    let entry = |row: usize, column: usize| axes[row].dot(&times(rotation, &axes[column]));
    let middle = asin(clamp(entry(0, 2), -1.0, 1.0));
    [hand * atan2(-entry(1, 2), entry(2, 2)), hand * middle, hand * atan2(-entry(0, 1), entry(0, 0))]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::axis_rotation;
    use crate::random::Stream;
    use proptest::prelude::*;

    fn turned(axes: &[Vec3; 3], angles: &[f32; 3]) -> Mat3 {
        axis_rotation(&axes[0], angles[0]) * axis_rotation(&axes[1], angles[1]) * axis_rotation(&axes[2], angles[2])
    }

    proptest! {
        #[test]
        fn angles_come_back(first in -3.0_f32..3.0, middle in -1.4_f32..1.4, last in -3.0_f32..3.0, left in any::<bool>()) {
            let axes = if left { [Vec3::x(), Vec3::z(), Vec3::y()] } else { [Vec3::y(), Vec3::z(), Vec3::x()] };
            let found = angles_of_rotation(&turned(&axes, &[first, middle, last]), &axes);
            for (a, b) in found.into_iter().zip([first, middle, last]) {
                prop_assert!((a - b).abs() < 2.0e-4, "{:?}", found);
            }
        }
    }

    #[test]
    fn the_mean_of_rotations_about_a_place_is_that_place() {
        let centre = turned(&[Vec3::x(), Vec3::y(), Vec3::z()], &[2.9, 0.4, -3.0]);
        let mut stream = Stream::new(2, 0, 0);
        let mut sum = Mat3::zeros();
        for _ in 0..4000 {
            let axis = stream.normal3();
            let angle = 0.3 * axis.norm();
            sum += centre * axis_rotation(&axis.normalize(), angle) / 4000.0;
        }
        let off = mean_rotation(&sum).unwrap().transpose() * centre;
        assert!((off - Mat3::identity()).norm() < 0.02, "{off}");
        assert_eq!(mean_rotation(&Mat3::zeros()), None);
    }
}
