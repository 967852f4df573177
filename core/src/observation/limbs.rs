//! Which temporal edge pixels belong to which limb (the arm paper's missing page, decided in DESIGN.md section 4).
//!
//! A pixel belongs to the limb of the last estimate that is nearer to it in the image, if it lies within a band around
//! that limb; a pixel far from both is dropped.

use crate::camera::Pixel;
use crate::math::sqrt;
use crate::vision::edges::EdgePixel;
use heapless::Vec;

/// Most pixels kept for one limb.
pub const MAX_LIMB_PIXELS: usize = 256;

/// Pixels whose limb a first pass remembers for the second one.
const REMEMBERED_PIXELS: usize = 1024;
/// Of these in a word.
const PIXELS_PER_WORD: usize = 16;

/// Pixels of both limbs.
#[derive(Debug, Clone, Default)]
pub struct LimbPixels {
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
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArmImagePoints {
    /// Image of the shoulder.
    pub shoulder: Pixel,
    /// Image of the elbow.
    pub elbow: Pixel,
    /// Image of the hand.
    pub hand: Pixel,
}

/// A segment of the image, made ready for many distances.
#[derive(Debug, Clone, Copy)]
struct Segment {
    from: Pixel,
    du: f32,
    dv: f32,
    length_squared: f32,
}

impl Segment {
    fn new(from: Pixel, to: Pixel) -> Self {
        let (du, dv) = (to.u_px - from.u_px, to.v_px - from.v_px);
        Self { from, du, dv, length_squared: du * du + dv * dv }
    }

    /// Square of the distance of `point`.
    #[inline]
    fn distance_squared(&self, point: Pixel) -> f32 {
        let (u, v) = (point.u_px - self.from.u_px, point.v_px - self.from.v_px);
        let along = u * self.du + v * self.dv;
        // The share of the way at which the point is nearest, cut to the segment.
        let share = if !(along < self.length_squared) {
            1.0
        } else if along > 0.0 {
            along / self.length_squared
        } else {
            0.0
        };
        let (mu, mv) = (u - share * self.du, v - share * self.dv);
        mu * mu + mv * mv
    }
}

/// Distance of `point` from the segment `a`-`b`, pixels.
#[must_use]
pub fn distance_to_segment_px(point: Pixel, a: Pixel, b: Pixel) -> f32 {
    sqrt(Segment::new(a, b).distance_squared(point))
}

/// Sorts `pixels` to the limbs of `arm` within `band_px`, into `result`.
///
/// Where a limb would get more than [`MAX_LIMB_PIXELS`], an even share of all is kept: a first pass counts, a second keeps
/// every k-th.
pub fn split(pixels: &[EdgePixel], arm: &ArmImagePoints, band_px: f32, result: &mut LimbPixels) {
    let limbs = Limbs::new(arm, band_px);
    result.upper.clear();
    result.fore.clear();
    let mut counts = [0_usize; 2];
    // Two bits a pixel for the second pass: 1 + limb, or 0.
    let mut codes = [0_u32; REMEMBERED_PIXELS / PIXELS_PER_WORD];
    for (index, pixel) in pixels.iter().enumerate() {
        let Some(limb) = limbs.limb_of(pixel) else { continue };
        // What finds no room comes in the second pass.
        let _ = if limb == 0 { result.upper.push(*pixel) } else { result.fore.push(*pixel) };
        counts[limb] += 1;
        if let Some(word) = codes.get_mut(index / PIXELS_PER_WORD) {
            *word |= (1 + limb as u32) << (2 * (index % PIXELS_PER_WORD));
        }
    }
    for (limb, count) in counts.into_iter().enumerate() {
        if count > MAX_LIMB_PIXELS {
            let kept = if limb == 0 { &mut result.upper } else { &mut result.fore };
            kept.clear();
            let of_limb = pixels.iter().enumerate().filter(|(index, pixel)| match codes.get(index / PIXELS_PER_WORD) {
                Some(word) => word >> (2 * (index % PIXELS_PER_WORD)) & 3 == 1 + limb as u32,
                None => limbs.limb_of(pixel) == Some(limb),
            });
            for (_, pixel) in of_limb.step_by(count.div_ceil(MAX_LIMB_PIXELS)) {
                // Cannot overflow: the stride leaves at most the capacity.
                let _ = kept.push(*pixel);
            }
        }
    }
}

/// Part by which the squares of two distances have to differ at least for their roots, rounded, to differ in the same sense.
const CLEARLY: f32 = 1.0e-6;

/// Both limbs and the band around them.
#[derive(Debug, Clone, Copy)]
struct Limbs {
    upper: Segment,
    fore: Segment,
    band_px: f32,
}

impl Limbs {
    fn new(arm: &ArmImagePoints, band_px: f32) -> Self {
        Self { upper: Segment::new(arm.shoulder, arm.elbow), fore: Segment::new(arm.elbow, arm.hand), band_px }
    }

    /// 0 for the upper arm, 1 for the forearm, `None` beyond the band. Roots are taken only where the squares do not decide.
    fn limb_of(&self, pixel: &EdgePixel) -> Option<usize> {
        let point = Pixel::new(f32::from(pixel.u), f32::from(pixel.v));
        let (upper, fore) = (self.upper.distance_squared(point), self.fore.distance_squared(point));
        let is_upper = upper <= fore || (upper <= fore * (1.0 + CLEARLY) && sqrt(upper) <= sqrt(fore));
        let (limb, nearer) = if is_upper { (0, upper) } else { (1, fore) };
        let band_squared = self.band_px * self.band_px;
        let inside = nearer <= band_squared * (1.0 - CLEARLY)
            || (nearer <= band_squared * (1.0 + CLEARLY) && sqrt(nearer) <= self.band_px);
        inside.then_some(limb)
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

    #[test]
    fn every_pixel_goes_where_its_distances_say() {
        let limbs = Limbs::new(&ARM, 30.0);
        for u in 0..320_u16 {
            for v in 0..240_u16 {
                let point = Pixel::new(f32::from(u), f32::from(v));
                let upper = distance_to_segment_px(point, ARM.shoulder, ARM.elbow);
                let fore = distance_to_segment_px(point, ARM.elbow, ARM.hand);
                let (limb, nearer) = if upper <= fore { (0, upper) } else { (1, fore) };
                assert_eq!(limbs.limb_of(&EdgePixel { u, v }), (nearer <= 30.0).then_some(limb), "{u}, {v}");
            }
        }
    }

    #[test]
    fn a_crowd_of_both_limbs_is_every_k_th_pixel_of_each() {
        // In turns on the upper arm, on the forearm and far from both; more than are remembered.
        let places = [EdgePixel { u: 100, v: 150 }, EdgePixel { u: 150, v: 200 }, EdgePixel { u: 310, v: 20 }];
        let pixels: Vec<EdgePixel, 2000> = (0..2000_u16)
            .map(|i| EdgePixel { u: places[usize::from(i % 3)].u + i / 200, ..places[usize::from(i % 3)] })
            .collect();
        let mut limbs = LimbPixels::none();
        split(&pixels, &ARM, 30.0, &mut limbs);
        for (limb, kept) in [&limbs.upper, &limbs.fore].into_iter().enumerate() {
            // 667 pixels of each, every third.
            let wanted: Vec<EdgePixel, 2000> = pixels.iter().skip(limb).step_by(3).step_by(3).copied().collect();
            assert_eq!(kept.as_slice(), wanted.as_slice());
        }
    }

    #[test]
    fn a_crowd_is_thinned_evenly_to_the_capacity() {
        let pixels: Vec<EdgePixel, 2000> = (0..2000_u16).map(|i| EdgePixel { u: 100, v: 100 + i / 20 }).collect();
        let mut limbs = LimbPixels::none();
        split(&pixels, &ARM, 30.0, &mut limbs);
        assert!(limbs.upper.len() <= MAX_LIMB_PIXELS && limbs.upper.len() > MAX_LIMB_PIXELS / 2);
        assert!(limbs.upper.last().unwrap().v > 180, "the end of the limb is missing");
    }

    #[test]
    fn a_point_like_limb_has_a_distance_too() {
        let p = Pixel::new(3.0, 4.0);
        assert_eq!(distance_to_segment_px(p, Pixel::default(), Pixel::default()), 5.0);
    }
}
