//! Keypoints of one person that a program holds in memory.

use super::detections::Detections;
use super::orders::{self, PointFrame, Points, by_key, named_by};
use super::pixels;
use super::upright::upright;
use crate::cyclic::CyclicError;
use crate::error::Result;
use std::path::Path;

/// What stands for the file in messages.
pub const ARRAY: &str = "keypoints";

/// Short names of the layouts that [`from_points`] takes, such as `coco17`.
#[must_use]
pub fn layouts() -> Vec<&'static str> {
    orders::keys().collect()
}

/// Keypoints in this layout, one entry a frame: x, y and confidence of each point. A point is
/// missing where one of them is not finite, or x and y are zero. Coordinates that are shares of the
/// picture become pixels by `image_size_px` (width and height), and y points down.
///
/// # Errors
/// An unknown layout, another number of points, a place that no picture has, shares without a size.
pub fn from_points(frames: &[Points], layout: &str, image_size_px: Option<[f64; 2]>) -> Result<Detections> {
    let Some((name, parts)) = by_key(layout) else {
        let rule = format!("has to be one of {}, not `{layout}`", layouts().join(", "));
        return Err(CyclicError::parameter("layout", rule).into());
    };
    let mut named = Vec::with_capacity(frames.len());
    for (frame, points) in (0..).zip(frames) {
        if points.len() != parts.len() {
            let rule = format!("need {} points a frame for the layout `{layout}`, not {}", parts.len(), points.len());
            return Err(CyclicError::parameter(ARRAY, rule).into());
        }
        let found = (0..).zip(parts.iter().copied()).zip(points).map(|(place, value)| orders::found(*value, place));
        let points: Points = found
            .collect::<std::result::Result<_, _>>()
            .map_err(|rule| CyclicError::parameter(ARRAY, format!("at frame {frame}: {rule}")))?;
        named.push(PointFrame { frame, people: vec![points] });
    }
    let layout = format!("{name}, {} points", parts.len());
    let found = Detections { layout, ..named_by(&named, &parts) };
    Ok(upright(pixels::to_pixels(found, image_size_px, Path::new(ARRAY))?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keypoints::layout::stick_joints;

    #[test]
    fn the_stick_figure_is_its_own_layout() {
        let points: Points = (0..14).map(|joint| [10.0 + f64::from(joint), 20.0, 0.9]).collect();
        let found = from_points(std::slice::from_ref(&points), "stick14", None).unwrap();
        let joints = stick_joints(&found.frames[0].people[0]);
        assert!((0..14).all(|joint| joints[joint] == Some([10.0 + joint as f64, 20.0])), "{joints:?}");
        let refused = |points: Points, layout: &str| from_points(&[points], layout, None).unwrap_err().to_string();
        assert!(refused(points.clone(), "coco").contains("`layout` has to be one of arms7, "));
        assert!(refused(points, "coco17").contains("`keypoints` need 17 points"));
        assert!(refused(vec![[1.0e12, 0.0, 1.0]; 14], "stick14").contains("at frame 0: keypoint `0`"));
    }
}
