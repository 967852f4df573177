//! The points of a frame as blocks, the form in which the core weighs them.

use super::point_cloud::MAX_POINTS;
use sinew_core::math::Vec3;
use sinew_core::observation::point_cloud::{BLOCK_POINTS, PointBlock, PointCloud};
use sinew_core::observation::range_smoothing::{RangeSmoothing, SightLine};

/// Sorts the points in place and returns the blocks in which the core weighs them. With
/// `smoothing`, distances are averaged first, and blocks have the scatter that it says. Points
/// beyond [`MAX_POINTS`] are left out.
#[must_use]
pub fn blocks_of(points_m: &mut [Vec3], smoothing: Option<&RangeSmoothing>) -> Vec<PointBlock> {
    let mut along_std_m = 0.0;
    if let Some(smoothing) = smoothing {
        let lines = &mut vec![SightLine::default(); points_m.len()];
        along_std_m = smoothing.smooth(points_m, &Vec3::zeros(), lines);
    }
    let mut weighed = Box::new(PointCloud::<{ MAX_POINTS / BLOCK_POINTS }>::new());
    // The readers pass on no point that it would refuse.
    let _ = weighed.set(points_m, &Vec3::zeros());
    weighed.scatter_by(along_std_m);
    weighed.blocks().to_vec()
}
