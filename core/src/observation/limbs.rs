//! Which temporal edge pixels belong to which limb; the arm paper leaves it open.
//!
//! A pixel belongs to the limb of the last estimate that is nearer to it in the image. It has to
//! lie within a band around that limb: a pixel far from both is dropped.

use crate::camera::Pixel;
use crate::math::{abs, sqrt};
use crate::vision::edges::{EdgePixel, EdgeThinning};
use heapless::Vec;

/// Largest number of pixels kept for one limb.
pub(crate) const MAX_LIMB_PIXELS: usize = 256;

/// Pixels of both limbs.
#[derive(Debug, Clone, Default)]
pub(crate) struct LimbPixels {
    /// Near the upper arm.
    pub upper: Vec<EdgePixel, MAX_LIMB_PIXELS>,
    /// Near the forearm.
    pub fore: Vec<EdgePixel, MAX_LIMB_PIXELS>,
}

impl LimbPixels {
    /// No pixel.
    #[must_use]
    pub const fn none() -> Self {
        Self { upper: Vec::new(), fore: Vec::new() }
    }
}

/// Image of an arm: its three joints.
///
/// ```
/// use sinew_core::camera::Camera;
/// use sinew_core::math::Vec3;
/// use sinew_core::skeleton::{ArmGeometry, Side};
/// use sinew_core::tracker::arm::{ArmModel, ArmOptions};
///
/// let camera = Camera::from_field_of_view(640, 480, 1.05)?;
/// let arm = ArmGeometry::new(Side::Left, 0.30, 0.35)?;
/// let model = ArmModel::new(camera, (640, 480), arm, ArmOptions::default())?;
/// // What to draw over the picture: an arm that hangs before the camera.
/// let [shoulder_m, elbow_m, hand_m] = [0.0, 0.30, 0.65].map(|y_m| Vec3::new(0.0, y_m, 1.5));
/// let image =
///     model.image_points(&shoulder_m, &elbow_m, &hand_m).expect("in front of the camera");
/// assert!(image.shoulder.v_px < image.elbow.v_px && image.elbow.v_px < image.hand.v_px);
/// assert!((image.hand.u_px - image.shoulder.u_px).abs() < 1e-3, "straight below");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArmImagePoints {
    /// Image of the shoulder.
    pub shoulder: Pixel,
    /// Image of the elbow.
    pub elbow: Pixel,
    /// Image of the hand.
    pub hand: Pixel,
}

/// A segment of the image: its middle, its direction as cosine and sine, half of its length.
#[derive(Debug, Clone, Copy)]
struct Segment {
    middle: Pixel,
    cosine: f32,
    sine: f32,
    half_px: f32,
}

/// Terms shared by the pixels of a row: coordinates of its column 0 along and across the segment.
#[derive(Debug, Clone, Copy)]
struct SegmentRow {
    along_px: f32,
    across_px: f32,
}

impl Segment {
    fn new(a: Pixel, b: Pixel) -> Self {
        let (du, dv) = (b.u_px - a.u_px, b.v_px - a.v_px);
        let length_px = sqrt(du * du + dv * dv);
        let (cosine, sine) = if length_px > 0.0 { (du / length_px, dv / length_px) } else { (1.0, 0.0) };
        let middle = Pixel::new(a.u_px + 0.5 * du, a.v_px + 0.5 * dv);
        Self { middle, cosine, sine, half_px: 0.5 * length_px }
    }

    fn row(&self, v_px: f32) -> SegmentRow {
        let (u, v) = (-self.middle.u_px, v_px - self.middle.v_px);
        SegmentRow { along_px: u * self.cosine + v * self.sine, across_px: v * self.cosine - u * self.sine }
    }

    /// Square of the distance of the pixel in column `u_px` of `row`.
    #[inline]
    fn distance_squared(&self, row: &SegmentRow, u_px: f32) -> f32 {
        let across = row.across_px - u_px * self.sine;
        let beyond_end = abs(row.along_px + u_px * self.cosine) - self.half_px;
        let square = across * across;
        if beyond_end > 0.0 { square + beyond_end * beyond_end } else { square }
    }
}

/// Sorts `pixels` to the limbs of `arm` within `band_px`, into `result`.
///
/// Where a limb has more than [`MAX_LIMB_PIXELS`], every 2^k-th is kept ([`EdgeThinning`]). Fast
/// where `pixels` come row by row.
pub(crate) fn split(pixels: &[EdgePixel], arm: &ArmImagePoints, band_px: f32, result: &mut LimbPixels) {
    let limbs = [Segment::new(arm.shoulder, arm.elbow), Segment::new(arm.elbow, arm.hand)];
    result.upper.clear();
    result.fore.clear();
    let (mut upper_thinning, mut fore_thinning) = (EdgeThinning::new(), EdgeThinning::new());
    let band_squared = band_px * band_px;
    let mut row_of_both = 0;
    let mut rows = limbs.map(|limb| limb.row(0.0));
    for pixel in pixels {
        if pixel.v != row_of_both {
            row_of_both = pixel.v;
            rows = limbs.map(|limb| limb.row(f32::from(pixel.v)));
        }
        let u_px = f32::from(pixel.u);
        let upper = limbs[0].distance_squared(&rows[0], u_px);
        let fore = limbs[1].distance_squared(&rows[1], u_px);
        if upper <= fore {
            if upper <= band_squared {
                upper_thinning.offer_to(*pixel, &mut result.upper);
            }
        } else if fore <= band_squared {
            fore_thinning.offer_to(*pixel, &mut result.fore);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ARM: ArmImagePoints = ArmImagePoints {
        shoulder: Pixel::new(100.0, 100.0),
        elbow: Pixel::new(100.0, 200.0),
        hand: Pixel::new(200.0, 200.0),
    };

    #[test]
    fn pixels_go_to_the_nearer_limb_and_far_ones_are_dropped() {
        let pixels = [
            EdgePixel { u: 105, v: 150 },
            EdgePixel { u: 150, v: 190 },
            EdgePixel { u: 300, v: 300 },
            EdgePixel { u: 100, v: 75 },
        ];
        let mut limbs = LimbPixels::none();
        split(&pixels, &ARM, 30.0, &mut limbs);
        assert_eq!(limbs.upper.as_slice(), &[pixels[0], pixels[3]]);
        assert_eq!(limbs.fore.as_slice(), &[pixels[1]]);
    }

    fn arm(shoulder: [f32; 2], elbow: [f32; 2], hand: [f32; 2]) -> ArmImagePoints {
        let [shoulder, elbow, hand] = [shoulder, elbow, hand].map(|[u, v]| Pixel::new(u, v));
        ArmImagePoints { shoulder, elbow, hand }
    }

    /// By the nearest of 2001 points of the segment.
    fn distance_by_points(point: Pixel, a: Pixel, b: Pixel) -> f32 {
        let distance = |i: u16| {
            let share = f32::from(i) / 2000.0;
            let at = Pixel::new(a.u_px + share * (b.u_px - a.u_px), a.v_px + share * (b.v_px - a.v_px));
            (point.u_px - at.u_px).hypot(point.v_px - at.v_px)
        };
        (0..=2000).map(distance).fold(f32::MAX, f32::min)
    }

    #[test]
    fn every_pixel_goes_where_its_distances_say() {
        // At right angles, aslant across the image's corner, folded, and without an upper arm.
        let point = [120.0, 60.0];
        let arms = [
            ARM,
            arm([-40.0, 30.5], [61.25, -12.0], [90.0, 70.0]),
            arm([200.0, 50.0], [230.0, 200.0], [215.0, 90.0]),
            arm(point, point, [150.0, 200.0]),
        ];
        let mut judged = 0;
        for arm in arms {
            for (u, v) in (0..320_u16).step_by(7).flat_map(|u| (0..240_u16).step_by(5).map(move |v| (u, v))) {
                let (pixel, point) = (EdgePixel { u, v }, Pixel::new(f32::from(u), f32::from(v)));
                let upper = distance_by_points(point, arm.shoulder, arm.elbow);
                let fore = distance_by_points(point, arm.elbow, arm.hand);
                if (upper - fore).abs() < 0.1 && upper.min(fore) < 31.0 || (upper.min(fore) - 30.0).abs() < 0.1 {
                    // Too near to call for the points.
                    continue;
                }
                judged += 1;
                let mut found = LimbPixels::none();
                split(&[pixel], &arm, 30.0, &mut found);
                let wanted = [upper < fore, fore < upper].map(|nearer| nearer && upper.min(fore) < 30.0);
                assert_eq!([&found.upper, &found.fore].map(|list| !list.as_slice().is_empty()), wanted, "{u}, {v}");
            }
        }
        assert!(judged > 7000, "{judged}");
    }

    #[test]
    fn rows_may_come_in_any_order() {
        let pixels: std::vec::Vec<EdgePixel> =
            (0..200_u16).map(|i| EdgePixel { u: 90 + i % 21, v: 100 + i * 37 % 101 }).collect();
        let mut limbs = LimbPixels::none();
        split(&pixels, &ARM, 12.0, &mut limbs);
        let wanted: std::vec::Vec<EdgePixel> =
            pixels.iter().copied().filter(|p| i32::from(p.u) - 100 <= 200 - i32::from(p.v)).collect();
        assert_eq!(limbs.upper.as_slice(), wanted);
        assert_eq!(limbs.fore.as_slice().len(), pixels.len() - wanted.len());
    }

    #[test]
    fn a_crowd_of_both_limbs_is_every_fourth_pixel_of_each() {
        // In turns on the upper arm, on the forearm and far from both.
        let places = [EdgePixel { u: 100, v: 150 }, EdgePixel { u: 150, v: 200 }, EdgePixel { u: 310, v: 20 }];
        let pixels: std::vec::Vec<EdgePixel> = (0..2000_u16)
            .map(|i| EdgePixel { u: places[usize::from(i % 3)].u + i / 200, ..places[usize::from(i % 3)] })
            .collect();
        let mut limbs = LimbPixels::none();
        split(&pixels, &ARM, 30.0, &mut limbs);
        for (limb, kept) in [&limbs.upper, &limbs.fore].into_iter().enumerate() {
            // 667 pixels of each.
            let wanted: std::vec::Vec<EdgePixel> = pixels.iter().skip(limb).step_by(3).step_by(4).copied().collect();
            assert_eq!(kept.as_slice(), wanted.as_slice());
        }
    }

    #[test]
    fn a_crowd_is_thinned_evenly_to_the_capacity() {
        let pixels: std::vec::Vec<EdgePixel> = (0..2000_u16).map(|i| EdgePixel { u: 100, v: 100 + i / 20 }).collect();
        let mut limbs = LimbPixels::none();
        split(&pixels, &ARM, 30.0, &mut limbs);
        assert!((MAX_LIMB_PIXELS / 2..=MAX_LIMB_PIXELS).contains(&limbs.upper.as_slice().len()));
        assert!(limbs.upper.as_slice().last().unwrap().v > 180, "the end of the limb is missing");
    }

    #[test]
    fn a_point_like_limb_has_a_distance_too() {
        let limb = Segment::new(Pixel::default(), Pixel::default());
        assert_eq!(limb.distance_squared(&limb.row(4.0), 3.0), 25.0);
    }
}
