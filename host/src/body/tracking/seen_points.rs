//! The points of a frame, ready to be weighed.

use crate::cloud::{PointCloud, blocks_of};
use sinew_core::math::Vec3;
use sinew_core::observation::point_cloud::PointBlock;
use sinew_core::observation::range_smoothing::RangeSmoothing;
use sinew_core::skeleton::full_body::BODY_ANGLES;

/// A cloud of fewer points shows no pose: a pose has as many numbers.
const MIN_BODY_POINTS: usize = BODY_ANGLES;

/// The points of a frame: what is weighed of them, and how many are not.
#[derive(Debug, Clone, Default)]
pub struct SeenPoints {
    /// At most as many as are weighed, in their order, metres, camera axes.
    pub points_m: Vec<Vec3>,
    /// The same in the blocks in which they are weighed, smoothed.
    pub(super) blocks: Vec<PointBlock>,
    /// Points that are none: not finite, at the camera's centre, or too far away.
    pub skipped: usize,
    /// Points left out by chance, since there are more than can be weighed.
    pub over_cap: usize,
    /// Points outside of the region that counts.
    pub outside: usize,
}

impl SeenPoints {
    /// At most `max_points` points of `cloud`; `seed` and `frame` draw those that stay of a large
    /// one.
    #[must_use]
    pub fn new(
        mut cloud: PointCloud,
        max_points: usize,
        (seed, frame): (u64, u64),
        smoothing: Option<&RangeSmoothing>,
    ) -> Self {
        let before = cloud.limit(max_points, seed, frame);
        let blocks = blocks_of(&mut cloud.points_m.clone(), smoothing);
        let over_cap = before - cloud.points_m.len();
        Self { points_m: cloud.points_m, blocks, skipped: cloud.skipped, over_cap, outside: cloud.outside }
    }

    /// Whether there are enough points to look for a body in them.
    #[must_use]
    pub fn show_a_body(&self) -> bool {
        self.points_m.len() >= MIN_BODY_POINTS
    }
}
