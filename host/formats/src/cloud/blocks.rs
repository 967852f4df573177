//! The points of a frame as blocks, the form in which the core weighs them.

use super::point_cloud::MAX_POINTS;
use sinew_core::math::Vec3;
use sinew_core::observation::point_cloud::{BLOCK_POINTS, PointBlock, PointCloud};
use sinew_core::observation::range_smoothing::{RangeSmoothing, SightLine};

/// Sorts the points in place and returns the blocks in which the core weighs them. With
/// `smoothing`, distances are averaged first. Points beyond [`MAX_POINTS`] are left out.
#[must_use]
pub fn blocks_of(points_m: &mut [Vec3], smoothing: Option<&RangeSmoothing>) -> Vec<PointBlock> {
    if let Some(smoothing) = smoothing {
        smoothing.smooth(points_m, &Vec3::zeros(), &mut vec![SightLine::default(); points_m.len()]);
    }
    let mut weighed = Box::new(PointCloud::<{ MAX_POINTS / BLOCK_POINTS }>::new());
    // The readers pass on no point that it would refuse.
    let _ = weighed.set(points_m, &Vec3::zeros());
    weighed.blocks().to_vec()
}
