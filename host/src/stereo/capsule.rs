//! Rays from the camera's centre against the capsules of a body.

use sinew_core::math::{Vec3, sqrt, unit};

/// Everything within `radius_m` of the segment between two points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capsule {
    /// Number of the bone.
    pub bone: usize,
    /// Where the bone begins, metres.
    pub start_m: Vec3,
    /// Where the bone ends, metres.
    pub end_m: Vec3,
    /// Radius, metres.
    pub radius_m: f32,
}

/// Squared sine between bone and ray below which the ray enters by a cap, if at all.
const ALONG_SQUARED: f32 = 1.0e-10;

impl Capsule {
    /// Where the ray from the origin along `direction` enters: the factor of `direction`; `None`
    /// where it misses, or begins inside.
    ///
    /// A capsule is the union of two balls and of a cylinder whose flat ends lie inside the balls.
    /// So the first entry of the three is that of the capsule.
    #[must_use]
    pub fn entry(&self, direction: &Vec3) -> Option<f32> {
        let mut nearest = f32::INFINITY;
        for cap_m in [&self.start_m, &self.end_m] {
            nearest = nearest.min(enters_ball(cap_m, direction, self.radius_m).unwrap_or(nearest));
        }
        nearest = nearest.min(self.enters_side(direction).unwrap_or(nearest));
        (nearest > 0.0 && nearest < f32::INFINITY).then_some(nearest)
    }

    fn enters_side(&self, direction: &Vec3) -> Option<f32> {
        let along = self.end_m - self.start_m;
        let axis = unit(along)?;
        let across = direction - axis * axis.dot(direction);
        if across.norm_squared() < ALONG_SQUARED * direction.norm_squared() {
            return None;
        }
        let foot = self.start_m - axis * axis.dot(&self.start_m);
        let entry = enters_ball(&foot, &across, self.radius_m)?;
        let place = (direction * entry - self.start_m).dot(&axis);
        (place >= 0.0 && place <= along.norm()).then_some(entry)
    }

    /// Distance of a point from the surface, metres; negative inside.
    #[must_use]
    pub fn distance_m(&self, point_m: &Vec3) -> f32 {
        let along = self.end_m - self.start_m;
        let share = (point_m - self.start_m).dot(&along) / along.norm_squared().max(1.0e-12);
        (point_m - self.start_m - along * share.clamp(0.0, 1.0)).norm() - self.radius_m
    }
}

/// Where a ray from the origin enters a ball, or, in the plane across an axis, a circle.
fn enters_ball(centre: &Vec3, direction: &Vec3, radius_m: f32) -> Option<f32> {
    let squared = direction.norm_squared();
    let middle = centre.dot(direction) / squared;
    // From the nearest point of the ray, not by b^2 - 4ac: a thin bone far away would be lost in
    // rounding.
    let half_chord_squared = radius_m * radius_m - (centre - direction * middle).norm_squared();
    (half_chord_squared >= 0.0).then(|| middle - sqrt(half_chord_squared / squared))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn capsule(start: [f32; 3], end: [f32; 3], radius_m: f32) -> Capsule {
        Capsule { bone: 1, start_m: Vec3::from(start), end_m: Vec3::from(end), radius_m }
    }

    #[test]
    fn known_entries() {
        let across = capsule([-1.0, 0.0, 3.0], [1.0, 0.0, 3.0], 0.1);
        assert!((across.entry(&Vec3::z()).unwrap() - 2.9).abs() < 1.0e-6);
        assert!(across.entry(&Vec3::new(0.0, 0.05, 1.0)).is_none());
        let along = capsule([0.0, 0.0, 2.0], [0.0, 0.0, 3.0], 0.1);
        assert!((along.entry(&Vec3::z()).unwrap() - 1.9).abs() < 1.0e-6);
        assert!(capsule([0.0, 0.0, -3.0], [0.1, 0.0, -3.0], 0.2).entry(&Vec3::z()).is_none(), "behind");
        let point = capsule([0.0, 0.0, 2.0], [0.0, 0.0, 2.0], 0.1);
        assert!((point.entry(&Vec3::z()).unwrap() - 1.9).abs() < 1.0e-6);
    }

    proptest! {
        #[test]
        fn the_entry_lies_on_the_surface_and_nothing_before_it(
            start in prop::array::uniform3(-1.0_f32..1.0), end in prop::array::uniform3(-1.0_f32..1.0), depth in 2.5_f32..6.0,
            radius_m in 0.02_f32..0.3, share in -0.1_f32..1.1, beside in prop::array::uniform3(-0.3_f32..0.3),
        ) {
            let mut capsule = capsule(start, end, radius_m);
            capsule.start_m.z += depth;
            capsule.end_m.z += depth;
            let aim = capsule.start_m + (capsule.end_m - capsule.start_m) * share + Vec3::from(beside);
            let direction = aim / aim.z;
            // March along the ray.
            let inside = (0..4000).map(|step| step as f32 * 0.002).find(|z| capsule.distance_m(&(direction * *z)) < 0.0);
            match capsule.entry(&direction) {
                Some(entry) => {
                    prop_assert!(capsule.distance_m(&(direction * entry)).abs() < 1.0e-4);
                    prop_assert!(inside.is_none_or(|z| z > entry - 1.0e-4 && z < entry + 0.01), "{entry} {inside:?}");
                }
                None => prop_assert!(inside.is_none(), "{inside:?}"),
            }
        }
    }
}
