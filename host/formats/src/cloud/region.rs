//! The part of space in which points count: what stands behind a person is cut off.

use super::point_cloud::PointCloud;
use sinew_core::math::Vec3;

/// A box and a plane, camera axes, metres; without either every point counts.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Region {
    /// Least and greatest x, y and z of the points that count, metres.
    pub inside_m: Option<[Vec3; 2]>,
    /// A plane a x + b y + c z + d = 0, x, y and z in metres: points with a positive left side
    /// count.
    pub above: Option<[f32; 4]>,
}

impl Region {
    /// Whether a point counts.
    #[must_use]
    pub fn has(&self, point_m: &Vec3) -> bool {
        let is_inside = self.inside_m.is_none_or(|[low_m, high_m]| {
            (0..3).all(|axis| point_m[axis] >= low_m[axis] && point_m[axis] <= high_m[axis])
        });
        is_inside && self.above.is_none_or(|[a, b, c, d]| a * point_m.x + b * point_m.y + c * point_m.z + d > 0.0)
    }
}

impl PointCloud {
    /// Leaves out the points that do not count, and adds them to [`PointCloud::outside`].
    pub fn cut_to(&mut self, region: &Region) {
        let before = self.points_m.len();
        self.points_m.retain(|point_m| region.has(point_m));
        self.outside += before - self.points_m.len();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_behind_a_wall_and_on_the_floor_go() {
        let mut cloud = PointCloud::from_points([
            Vec3::new(0.0, 0.0, 3.0),
            Vec3::new(0.0, 0.0, 5.0),
            Vec3::new(-2.0, 0.0, 3.0),
            Vec3::new(0.0, 0.99, 3.0),
        ]);
        let box_m = [Vec3::new(-1.0, -2.0, 0.5), Vec3::new(1.0, 2.0, 4.0)];
        // The floor is a metre below the camera; what is less than 3 cm above it goes.
        let region = Region { inside_m: Some(box_m), above: Some([0.0, -1.0, 0.0, 0.97]) };
        cloud.cut_to(&region);
        assert_eq!((cloud.points_m.as_slice(), cloud.outside), (&[Vec3::new(0.0, 0.0, 3.0)][..], 3));
        cloud.cut_to(&Region::default());
        assert_eq!((cloud.points_m.len(), cloud.outside), (1, 3));
    }
}
