//! The points of one frame, and which points can be used.

use sinew_core::math::Vec3;
use sinew_core::observation::point_cloud::MIN_RANGE_M;

/// Maximum number of points of a frame that a tracker is given; [`PointCloud::limit`] draws them
/// from a larger cloud.
pub const MAX_POINTS: usize = 20_000;
/// Radius around the camera's centre in which no point can be: matching that failed is often
/// written as the origin.
pub const CENTRE_RADIUS_M: f32 = MIN_RANGE_M;
/// Distance beyond which no point can be: far more than a stereo camera measures, and its square is
/// an ordinary number.
pub const MAX_DISTANCE_M: f32 = 1_000.0;

/// The points of one frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PointCloud {
    /// Points in metres in the order of the file: finite, between [`CENTRE_RADIUS_M`] and
    /// [`MAX_DISTANCE_M`] from the camera's centre.
    pub points_m: Vec<Vec3>,
    /// Number of points of the file that were left out as unusable.
    pub skipped: usize,
    /// Of these, the number beyond [`MAX_DISTANCE_M`].
    pub far: usize,
    /// Number of points that were left out since they are outside of the region that counts.
    pub outside: usize,
}

impl PointCloud {
    /// Takes the points that can be used and counts the others.
    pub fn from_points(points_m: impl IntoIterator<Item = Vec3>) -> Self {
        let mut cloud = Self::default();
        for point_m in points_m {
            cloud.push(point_m);
        }
        cloud
    }

    /// Adds a point, or counts it if it cannot be used.
    pub fn push(&mut self, point_m: Vec3) {
        let distance_m = point_m.norm();
        // False for NaN and infinity.
        if distance_m > CENTRE_RADIUS_M && distance_m <= MAX_DISTANCE_M {
            self.points_m.push(point_m);
        } else {
            self.skipped += 1;
            self.far += usize::from(distance_m > MAX_DISTANCE_M && distance_m.is_finite());
        }
    }
}
