//! Rotations as three angles about z, x and y.

use sinew_core::math::{Mat3, abs, atan2, sqrt};

/// Cosine of the middle angle below which the first angle is set to zero: there it and the last
/// turn about one axis.
const GIMBAL_COS: f32 = 1.0e-6;

/// Angles (z, x, y), radians, with `rotation` = Rz Rx Ry; the middle one is within +-pi/2. Exact to
/// rounding everywhere.
///
/// The first angle brings the matrix to Rx Ry, in which both others stand alone. So the last angle
/// compensates the first one's error, which is large near a middle angle of +-pi/2.
#[must_use]
pub fn zxy_rad(rotation: &Mat3) -> [f32; 3] {
    // `0.0 -` leaves no negative zero, which would be written as -0.
    let (minus_sin_cos, cos_cos) = (rotation[(0, 1)], rotation[(1, 1)]);
    let cos_x = sqrt(minus_sin_cos * minus_sin_cos + cos_cos * cos_cos);
    let (sin_z, cos_z) =
        if abs(cos_x) < GIMBAL_COS { (0.0, 1.0) } else { ((0.0 - minus_sin_cos) / cos_x, cos_cos / cos_x) };
    let cos_y = cos_z * rotation[(0, 0)] + sin_z * rotation[(1, 0)];
    let sin_y = cos_z * rotation[(0, 2)] + sin_z * rotation[(1, 2)];
    [atan2(sin_z, cos_z), atan2(rotation[(2, 1)], cos_x), atan2(sin_y, cos_y)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::{FRAC_PI_2, PI};
    use proptest::prelude::*;
    use sinew_core::math::{Vec3, axis_rotation};

    fn about_zxy([z, x, y]: [f32; 3]) -> Mat3 {
        axis_rotation(&Vec3::z(), z) * axis_rotation(&Vec3::x(), x) * axis_rotation(&Vec3::y(), y)
    }

    proptest! {
        #[test]
        fn the_angles_make_the_rotation_again(
            z in -PI..PI,
            x in prop_oneof![-PI..PI, FRAC_PI_2 - 0.001..FRAC_PI_2 + 0.001, Just(FRAC_PI_2), Just(-FRAC_PI_2)],
            y in -PI..PI,
        ) {
            let rotation = about_zxy([z, x, y]);
            let angles = zxy_rad(&rotation);
            prop_assert!(angles[1].abs() <= FRAC_PI_2 + 1.0e-6);
            prop_assert!((about_zxy(angles) - rotation).abs().max() < 3.0e-6, "{angles:?}");
        }
    }

    #[test]
    fn angles_within_the_range_come_back_themselves() {
        let wanted = [0.3, -1.2, 2.5];
        let found = zxy_rad(&about_zxy(wanted));
        assert!(found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1.0e-6), "{found:?}");
    }
}
