//! Which bone each pixel sees, and how far away.

use super::camera::StereoCamera;
use super::capsule::Capsule;
use sinew_core::camera::Pixel;
use sinew_core::skeleton::full_body::{BODY_BONES, BODY_PARENTS};

use crate::body::BodyJoints;

/// A capsule that comes nearer to the camera than this is looked for in the whole picture, metres.
const NEAR_M: f32 = 0.1;

/// What one pixel sees of the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VisiblePixel {
    /// The pixel's centre.
    pub pixel: Pixel,
    /// The bone whose surface is nearest.
    pub bone: usize,
    /// z of that surface, metres.
    pub depth_m: f32,
}

/// The capsules of a body: each bone with flesh whose two ends are known.
#[must_use]
pub fn capsules(joints: &BodyJoints, radii_m: &[f32; BODY_BONES]) -> Vec<Capsule> {
    let capsule = |bone: usize| {
        let parent = usize::from(BODY_PARENTS[bone]?);
        let radius_m = radii_m[bone];
        (radius_m > 0.0).then_some(Capsule { bone, start_m: joints[parent]?, end_m: joints[bone]?, radius_m })
    };
    (0..BODY_BONES).filter_map(capsule).collect()
}

/// The pixels that see a body, row by row.
#[must_use]
pub fn visible_pixels(camera: &StereoCamera, capsules: &[Capsule]) -> Vec<VisiblePixel> {
    let (width, height) = (camera.width_px as usize, camera.height_px as usize);
    let mut nearest: Vec<Option<(f32, usize)>> = vec![None; width * height];
    for capsule in capsules {
        let [columns, rows] = covered(camera, capsule);
        for v in rows.0..rows.1 {
            for u in columns.0..columns.1 {
                let direction = camera.direction(Pixel::new(u as f32, v as f32));
                let Some(depth_m) = capsule.entry(&direction) else { continue };
                let seen = &mut nearest[v * width + u];
                if seen.is_none_or(|(other_m, _)| depth_m < other_m) {
                    *seen = Some((depth_m, capsule.bone));
                }
            }
        }
    }
    let pixel = |(index, seen): (usize, &Option<(f32, usize)>)| {
        let (depth_m, bone) = (*seen)?;
        Some(VisiblePixel { pixel: Pixel::new((index % width) as f32, (index / width) as f32), bone, depth_m })
    };
    nearest.iter().enumerate().filter_map(pixel).collect()
}

/// Columns and rows, first and one past the last, outside of which the capsule is not seen.
fn covered(camera: &StereoCamera, capsule: &Capsule) -> [(usize, usize); 2] {
    let size = [camera.width_px, camera.height_px];
    let centre = camera.centre();
    let middle = [centre.u_px, centre.v_px];
    std::array::from_fn(|axis| {
        let whole = (0, size[axis] as usize);
        let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
        for end in [capsule.start_m, capsule.end_m] {
            let r = capsule.radius_m;
            if !(end.z - r > NEAR_M) {
                return whole;
            }
            for (reach, depth) in [(-r, end.z - r), (-r, end.z + r), (r, end.z - r), (r, end.z + r)] {
                let place = camera.focal_px * (end[axis] + reach) / depth + middle[axis];
                (low, high) = (low.min(place), high.max(place));
            }
        }
        let cut = |place: f32| (place.max(0.0) as usize).min(whole.1);
        (cut(low), cut(high + 2.0))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_core::math::Vec3;

    fn ball(bone: usize, centre: Vec3, radius_m: f32) -> Capsule {
        Capsule { bone, start_m: centre, end_m: centre, radius_m }
    }

    #[test]
    fn the_nearer_bone_hides_the_farther_one() {
        let camera = StereoCamera::default();
        let far = ball(1, Vec3::new(0.0, 0.0, 4.0), 0.5);
        let near = ball(2, Vec3::new(0.0, 0.0, 2.0), 0.1);
        let alone = visible_pixels(&camera, &[far]);
        let both = visible_pixels(&camera, &[far, near]);
        assert_eq!(alone.len(), both.len(), "the small one stands before the large one");
        let share = both.iter().filter(|seen| seen.bone == 2).count() as f32 / both.len() as f32;
        let wanted = (0.1_f32 / 2.0 / (0.5 / 4.0)).powi(2);
        assert!((share - wanted).abs() < 0.02, "{share} instead of {wanted}");
        assert!(both.iter().all(|seen| seen.bone == 1 || seen.depth_m < 2.0));
    }

    #[test]
    fn the_searched_rectangle_misses_nothing() {
        let camera = StereoCamera { width_px: 160, height_px: 120, focal_px: 125.0, ..StereoCamera::default() };
        for (x, y, z) in [(0.0, 0.0, 1.0), (0.5, -0.4, 1.0), (-1.2, 0.9, 2.0), (0.1, 0.1, 0.3), (0.3, 0.0, 0.1)] {
            let capsule =
                Capsule { bone: 1, start_m: Vec3::new(x, y, z), end_m: Vec3::new(-y, x, z + 0.7), radius_m: 0.15 };
            let mut everywhere = 0;
            for v in 0..120 {
                for u in 0..160 {
                    let direction = camera.direction(Pixel::new(u as f32, v as f32));
                    everywhere += usize::from(capsule.entry(&direction).is_some());
                }
            }
            assert_eq!(visible_pixels(&camera, &[capsule]).len(), everywhere, "{x} {y} {z}");
        }
    }

    #[test]
    fn a_bone_without_flesh_or_end_has_no_capsule() {
        let mut joints = [Some(Vec3::new(0.0, 0.0, 3.0)); BODY_BONES];
        let mut radii_m = [0.1; BODY_BONES];
        radii_m[0] = 0.0;
        assert_eq!(capsules(&joints, &radii_m).len(), BODY_BONES - 1);
        joints[4] = None;
        assert_eq!(capsules(&joints, &radii_m).len(), BODY_BONES - 3, "and the one that hangs on it");
    }
}
