//! The elbow that fits a hand (arm paper, section 3.2, whose text is incomplete).
//!
//! ```
//! use sinew_core::correction::elbow::nearest_elbow;
//! use sinew_core::math::Vec3;
//!
//! let (shoulder_m, hand_m) = (Vec3::zeros(), Vec3::new(0.3, 0.3, 0.0));
//! let elbow_m = nearest_elbow(&shoulder_m, &hand_m, 0.30, 0.35, &Vec3::new(0.0, 0.3, 0.1));
//! assert!(
//!     ((elbow_m - shoulder_m).norm() - 0.30).abs() < 1e-4,
//!     "the upper arm keeps its length"
//! );
//! assert!(((hand_m - elbow_m).norm() - 0.35).abs() < 1e-4, "and so does the forearm");
//! ```

use crate::math::{Vec3, clamp, length, max, sqrt, unit};

/// The point nearest to `predicted_m` on the circle where an elbow can be, given shoulder and hand.
///
/// The circle is the intersection of two spheres: radius `upper_arm_m` around the shoulder and
/// `forearm_m` around the hand. Where they do not intersect (the hand is out of reach, or too
/// near), the elbow lies on the line of shoulder and hand.
///
/// ```
/// use sinew_core::correction::elbow::nearest_elbow;
/// use sinew_core::math::Vec3;
///
/// // The elbow was predicted too high; both lengths let it hang straight below the shoulder.
/// let (shoulder_m, predicted_m) = (Vec3::zeros(), Vec3::new(0.0, 0.2, 0.0));
/// let elbow_m =
///     nearest_elbow(&shoulder_m, &Vec3::new(0.35, 0.30, 0.0), 0.30, 0.35, &predicted_m);
/// assert!((elbow_m - Vec3::new(0.0, 0.30, 0.0)).norm() < 1e-5);
///
/// // A hand out of reach stretches the arm.
/// let elbow_m =
///     nearest_elbow(&shoulder_m, &Vec3::new(2.0, 0.0, 0.0), 0.30, 0.35, &predicted_m);
/// assert!((elbow_m - Vec3::new(0.30, 0.0, 0.0)).norm() < 1e-5);
/// ```
#[must_use]
pub fn nearest_elbow(shoulder_m: &Vec3, hand_m: &Vec3, upper_arm_m: f32, forearm_m: f32, predicted_m: &Vec3) -> Vec3 {
    let span = hand_m - shoulder_m;
    let Some(axis) = unit(span) else {
        let direction = unit(predicted_m - shoulder_m).unwrap_or(Vec3::y());
        return shoulder_m + direction * upper_arm_m;
    };
    let distance = length(&span);
    let along = (distance * distance + upper_arm_m * upper_arm_m - forearm_m * forearm_m) / (2.0 * distance);
    let along = clamp(along, -upper_arm_m, upper_arm_m);
    let radius = sqrt(max(upper_arm_m * upper_arm_m - along * along, 0.0));
    let centre = shoulder_m + axis * along;
    let offset = predicted_m - centre;
    let across = unit(offset - axis * offset.dot(&axis)).unwrap_or_else(|| any_perpendicular(&axis));
    centre + across * radius
}

/// A unit vector across `axis`, downwards where that is possible.
fn any_perpendicular(axis: &Vec3) -> Vec3 {
    let hanging = Vec3::y() - axis * axis.y;
    unit(hanging).filter(|_| length(&hanging) > 1.0e-3).unwrap_or(Vec3::x())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn near_point() -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(-0.6_f32..0.6).prop_map(|[x, y, z]| Vec3::new(x, y, z))
    }

    proptest! {
        #[test]
        fn the_elbow_fits_both_lengths_and_is_nearest(hand in near_point(), predicted in near_point(), turn in 0.0_f32..core::f32::consts::TAU) {
            let (upper, fore) = (0.3, 0.35);
            prop_assume!(hand.norm() > 0.06 && hand.norm() < 0.64);
            let elbow = nearest_elbow(&Vec3::zeros(), &hand, upper, fore, &predicted);
            prop_assert!((elbow.norm() - upper).abs() < 1.0e-3);
            prop_assert!(((elbow - hand).norm() - fore).abs() < 1.0e-3);
            let other = crate::math::axis_rotation(&hand.normalize(), turn) * elbow;
            prop_assert!((elbow - predicted).norm() <= (other - predicted).norm() + 1.0e-4);
        }
    }

    #[test]
    fn a_hand_out_of_reach_stretches_the_arm() {
        let elbow = nearest_elbow(&Vec3::zeros(), &(Vec3::x() * 2.0), 0.3, 0.35, &Vec3::y());
        assert!((elbow - Vec3::x() * 0.3).norm() < 1.0e-6);
        let folded = nearest_elbow(&Vec3::zeros(), &Vec3::zeros(), 0.3, 0.3, &Vec3::y());
        assert!((folded - Vec3::y() * 0.3).norm() < 1.0e-6);
    }

    #[test]
    fn an_elbow_without_history_hangs() {
        let elbow = nearest_elbow(&Vec3::zeros(), &(Vec3::x() * 0.5), 0.3, 0.35, &Vec3::zeros());
        assert!(elbow.y > 0.1 && elbow.z.abs() < 1.0e-6);
    }
}
