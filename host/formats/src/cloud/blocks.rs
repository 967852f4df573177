//! The points of a frame as blocks, the form in which the core weighs them.

use super::point_cloud::MAX_POINTS;
use sinew_core::math::Vec3;
use sinew_core::observation::point_cloud::{BLOCK_POINTS, PointBlock, PointCloud};
use sinew_core::observation::range_smoothing::{RangeSmoothing, SightLine};

/// The points, brought in place into the order and the blocks in which the core weighs them, after their distances were averaged where
/// `smoothing` says how; those beyond [`MAX_POINTS`] are left out.
#[must_use]
pub fn blocks_of(points_m: &mut [Vec3], smoothing: Option<&RangeSmoothing>) -> Vec<PointBlock> {
    if let Some(smoothing) = smoothing {
        smoothing.smooth(points_m, &Vec3::zeros(), &mut vec![SightLine::default(); points_m.len()]);
    }
    let mut weighed = Box::new(PointCloud::<{ MAX_POINTS / BLOCK_POINTS }>::new());
    // What it leaves out, the reader's rules have left out already.
    let _ = weighed.set(points_m, &Vec3::zeros());
    weighed.blocks().to_vec()
}
