//! Which temporal edge pixels belong to which limb (the arm paper's missing page, decided in DESIGN.md section 4).
//!
//! A pixel belongs to the limb of the last estimate that is nearer to it in the image, if it lies within a band around
//! that limb; a pixel far from both is dropped.

use crate::camera::Pixel;
use crate::math::{clamp, sqrt};
use crate::vision::edges::EdgePixel;
use heapless::Vec;

/// Most pixels kept for one limb.
pub const MAX_LIMB_PIXELS: usize = 256;

/// Pixels of both limbs.
#[derive(Debug, Clone, Default)]
pub struct LimbPixels {
    /// Near the upper arm.
    pub upper: Vec<EdgePixel, MAX_LIMB_PIXELS>,
    /// Near the forearm.
    pub fore: Vec<EdgePixel, MAX_LIMB_PIXELS>,
}

/// Image of an arm: its three joints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArmImagePoints {
    /// Image of the shoulder.
    pub shoulder: Pixel,
    /// Image of the elbow.
    pub elbow: Pixel,
    /// Image of the hand.
    pub hand: Pixel,
}

/// Distance of `point` from the segment `a`-`b`, pixels.
#[must_use]
pub fn distance_to_segment_px(point: Pixel, a: Pixel, b: Pixel) -> f32 {
    let (du, dv) = (b.u_px - a.u_px, b.v_px - a.v_px);
    let squared = du * du + dv * dv;
    let along = (point.u_px - a.u_px) * du + (point.v_px - a.v_px) * dv;
    let share = if squared > 0.0 { clamp(along / squared, 0.0, 1.0) } else { 0.0 };
    let (mu, mv) = (point.u_px - a.u_px - share * du, point.v_px - a.v_px - share * dv);
    sqrt(mu * mu + mv * mv)
}

/// Sorts `pixels` to the limbs of `arm` within `band_px`.
///
/// Where a limb would get more than [`MAX_LIMB_PIXELS`], an even share of all is kept: a first pass counts, a second keeps
/// every k-th.
#[must_use]
pub fn split(pixels: &[EdgePixel], arm: &ArmImagePoints, band_px: f32) -> LimbPixels {
    let mut result = LimbPixels::default();
    let mut counts = [0_usize; 2];
    for pixel in pixels {
        if let Some(limb) = limb_of(pixel, arm, band_px) {
            counts[limb] += 1;
        }
    }
    let strides = counts.map(|count| count.div_ceil(MAX_LIMB_PIXELS).max(1));
    let mut seen = [0_usize; 2];
    for pixel in pixels {
        let Some(limb) = limb_of(pixel, arm, band_px) else { continue };
        if seen[limb].is_multiple_of(strides[limb]) {
            let kept = if limb == 0 { &mut result.upper } else { &mut result.fore };
            // Cannot overflow: the stride leaves at most the capacity.
            let _ = kept.push(*pixel);
        }
        seen[limb] += 1;
    }
    result
}

/// 0 for the upper arm, 1 for the forearm, `None` beyond the band.
fn limb_of(pixel: &EdgePixel, arm: &ArmImagePoints, band_px: f32) -> Option<usize> {
    let point = Pixel::new(f32::from(pixel.u), f32::from(pixel.v));
    let upper = distance_to_segment_px(point, arm.shoulder, arm.elbow);
    let fore = distance_to_segment_px(point, arm.elbow, arm.hand);
    if upper <= fore { (upper <= band_px).then_some(0) } else { (fore <= band_px).then_some(1) }
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
        let limbs = split(&pixels, &ARM, 30.0);
        assert_eq!(limbs.upper.as_slice(), &[pixels[0], pixels[3]]);
        assert_eq!(limbs.fore.as_slice(), &[pixels[1]]);
    }

    #[test]
    fn a_crowd_is_thinned_evenly_to_the_capacity() {
        let pixels: Vec<EdgePixel, 2000> = (0..2000_u16).map(|i| EdgePixel { u: 100, v: 100 + i / 20 }).collect();
        let limbs = split(&pixels, &ARM, 30.0);
        assert!(limbs.upper.len() <= MAX_LIMB_PIXELS && limbs.upper.len() > MAX_LIMB_PIXELS / 2);
        assert!(limbs.upper.last().unwrap().v > 180, "the end of the limb is missing");
    }

    #[test]
    fn a_point_like_limb_has_a_distance_too() {
        let p = Pixel::new(3.0, 4.0);
        assert_eq!(distance_to_segment_px(p, Pixel::default(), Pixel::default()), 5.0);
    }
}
