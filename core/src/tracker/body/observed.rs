//! Which bones a frame's points show.

use crate::math::{length, max, sqrt};
use crate::observation::body_surface::BodySurface;
use crate::observation::point_cloud::PointBlock;
use crate::observation::point_likelihood::NearestSkin;

/// A point nearer to a bone's skin than this belongs to it, metres.
const NEAR_M: f32 = 0.08;
/// A bone with less than this share of the points that its size lets expect is not observed.
const LEAST_SHARE: f32 = 0.25;

/// Whether the points show each bone: enough of them lie on its skin and on no other's.
///
/// What to expect follows from the size in which each bone would appear to the camera, as if none hid another: a limb behind the
/// trunk is not observed. Without points nothing is; a bone without flesh has no skin to show.
#[must_use]
pub fn observed<const BONES: usize>(surface: &BodySurface<BONES>, blocks: &[PointBlock]) -> [bool; BONES] {
    let mut counts = [0.0_f32; BONES];
    for block in blocks {
        let nearest = NearestSkin::find(surface, block, NEAR_M);
        for &index in nearest.capsule.iter().take(usize::from(block.count)) {
            if let Some(count) = surface.capsules.get(usize::from(index)).and_then(|seen| counts.get_mut(seen.bone)) {
                *count += 1.0;
            }
        }
    }
    let mut sizes = [0.0; BONES];
    for seen in &surface.capsules {
        let middle = (seen.capsule.start_m + seen.capsule.end_m) * 0.5 - surface.camera_m;
        let squared = max(middle.dot(&middle), 1.0e-6);
        let foreshortened = length(&seen.along_m.cross(&middle)) / sqrt(squared);
        let r = seen.capsule.radius_m;
        sizes[seen.bone] = (2.0 * r * foreshortened + 3.0 * r * r) / squared;
    }
    let (found, size): (f32, f32) = (counts.iter().sum(), sizes.iter().sum());
    let mut result = [false; BONES];
    for bone in 0..BONES {
        result[bone] = counts[bone] > 0.0 && counts[bone] >= LEAST_SHARE * found * sizes[bone] / size;
    }
    result
}
