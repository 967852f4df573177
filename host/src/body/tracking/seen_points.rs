//! The points of a frame, ready to be weighed.

use crate::cloud::{MAX_POINTS, PointCloud, blocks_of};
use sinew_core::math::Vec3;
use sinew_core::observation::point_cloud::PointBlock;
use sinew_core::observation::range_smoothing::RangeSmoothing;

/// The points of a frame: what is weighed of them, and how many are not.
#[derive(Debug, Clone, Default)]
pub struct SeenPoints {
    /// At most [`MAX_POINTS`] in their order, metres, camera axes.
    pub points_m: Vec<Vec3>,
    /// The same in the blocks in which they are weighed, smoothed.
    pub(super) blocks: Vec<PointBlock>,
    /// Points that are none: not finite, at the camera's centre, or too far away.
    pub skipped: usize,
    /// Points left out by chance, since there are more than can be weighed.
    pub over_cap: usize,
}

impl SeenPoints {
    /// The points of `cloud`; `seed` and `frame` draw those that stay of a large one.
    #[must_use]
    pub fn new(mut cloud: PointCloud, seed: u64, frame: u64, smoothing: Option<&RangeSmoothing>) -> Self {
        let before = cloud.limit(MAX_POINTS, seed, frame);
        let blocks = blocks_of(&mut cloud.points_m.clone(), smoothing);
        let over_cap = before - cloud.points_m.len();
        Self { points_m: cloud.points_m, blocks, skipped: cloud.skipped, over_cap }
    }
}
