//! Rotations of bones, joint after joint.

use crate::math::{Vec3, transform, turn_columns};

/// Rotation of a bone against the world: its columns are the bone's own axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rotation {
    columns: [[f32; 3]; 3],
    /// Whether it is the identity, which need not be multiplied.
    is_none: bool,
}

impl Rotation {
    /// The world's own axes.
    pub(super) const NONE: Self = Self { columns: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], is_none: true };

    /// A vector that turns with the bone, in the world's axes.
    #[inline(always)]
    pub(super) fn turned(&self, vector: &Vec3) -> Vec3 {
        if self.is_none { *vector } else { transform(&self.columns, [vector.x, vector.y, vector.z]).into() }
    }

    /// This rotation followed by a turn about `axis`, a unit vector in the bone's axes, by the
    /// angle of `sine` and `cosine`.
    #[inline(always)]
    pub(super) fn then(&self, axis: &Vec3, sine_and_cosine: (f32, f32)) -> Self {
        let turn = turn_columns(axis, sine_and_cosine);
        let columns = if self.is_none { turn } else { turn.map(|column| transform(&self.columns, column)) };
        Self { columns, is_none: false }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{axis_rotation, sin_cos, unit};
    use proptest::prelude::*;

    proptest! {
        /// To the bit: results do not depend on the form of a rotation.
        #[test]
        fn a_rotation_is_the_product_of_its_turns(
            axes in prop::collection::vec(prop::array::uniform3(-1.0_f32..1.0), 1..5), angle_rad in -7.0_f32..7.0,
        ) {
            let (mut rotation, mut product) = (Rotation::NONE, None);
            for axis in axes {
                let axis = unit(Vec3::from(axis)).unwrap_or(Vec3::x());
                rotation = rotation.then(&axis, sin_cos(angle_rad));
                let turn = axis_rotation(&axis, angle_rad);
                let product = *product.insert(product.map_or(turn, |before: crate::math::Mat3| before * turn));
                prop_assert_eq!(rotation.turned(&axis), product * axis);
            }
        }
    }

    #[test]
    fn what_has_not_turned_stays() {
        assert_eq!(Rotation::NONE.turned(&Vec3::new(0.1, -0.2, 0.3)), Vec3::new(0.1, -0.2, 0.3));
    }
}
