//! A blob that may be a hand: the trackers' input from vision.

use crate::camera::Pixel;
use crate::math::{exp, ln, max, sqrt};
use core::f32::consts::PI;

/// The part of a blob that an arm tracker uses: a few numbers, so that a frame's list is small
/// state.
///
/// ```
/// use sinew_core::vision::candidate::HandCandidate;
///
/// // An ellipse of 40 by 20 pixels has its own area; turned edge on it is half as wide.
/// let flat = HandCandidate { moments_px2: [100.0, 0.0, 25.0], ..HandCandidate::default() };
/// let edge = HandCandidate { moments_px2: [100.0, 0.0, 6.25], ..flat };
/// assert!((flat.length_weighted_area_px(0.5) - 628.3).abs() < 0.1);
/// // A size weighted towards the length keeps more of it: a better measure of the hand's distance.
/// let kept = |share| edge.length_weighted_area_px(share) / flat.length_weighted_area_px(share);
/// assert!((kept(0.5) - 0.5).abs() < 1e-3 && kept(0.65) > 0.6);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub struct HandCandidate {
    /// Assumed centre of the hand.
    pub centre: Pixel,
    /// Second central moments of the blob's pixels: uu, uv, vv, in square pixels.
    pub moments_px2: [f32; 3],
    /// Number of pixels of the blob.
    pub area_px: f32,
    /// p(hand | blob) in [0, 1]: arm (6) or the default form.
    pub likelihood: f32,
}

impl HandCandidate {
    /// Area of the ellipse with the blob's second moments, its axes weighted by exponents, square
    /// pixels.
    ///
    /// The long axis has the exponent 2 `length_share`, the short axis the rest; one half gives the
    /// ellipse's own area. A hand turned edge on loses width and keeps its length, so weighting the
    /// length gives a better depth.
    #[must_use]
    pub fn length_weighted_area_px(&self, length_share: f32) -> f32 {
        let [uu, uv, vv] = self.moments_px2;
        let (middle, half) = (0.5 * (uu + vv), 0.5 * (uu - vv));
        let radius = sqrt(half * half + uv * uv);
        // The variance of one pixel's square is 1/12, so nothing is narrower.
        let [long, short] = [middle + radius, middle - radius].map(|variance| max(variance, 1.0 / 12.0));
        4.0 * PI * exp(length_share * ln(long) + (1.0 - length_share) * ln(short))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn ellipse(long_px: f32, short_px: f32, angle_rad: f32) -> HandCandidate {
        let (sine, cosine) = crate::math::sin_cos(angle_rad);
        let (a, b) = (0.25 * long_px * long_px, 0.25 * short_px * short_px);
        let moments_px2 =
            [a * cosine * cosine + b * sine * sine, (a - b) * sine * cosine, a * sine * sine + b * cosine * cosine];
        HandCandidate { moments_px2, ..HandCandidate::default() }
    }

    proptest! {
        #[test]
        fn an_ellipse_has_its_own_area_at_one_half_in_any_direction(
            long in 6.0_f32..200.0, ratio in 0.1_f32..1.0, angle in -3.0_f32..3.0,
        ) {
            let area = PI * long * long * ratio;
            let measured = ellipse(long, long * ratio, angle).length_weighted_area_px(0.5);
            prop_assert!((measured / area - 1.0).abs() < 0.02, "{} {}", measured, area);
        }

        #[test]
        fn the_measure_grows_with_the_square_of_the_scale(share in 0.0_f32..=1.0, scale in 1.0_f32..5.0) {
            let [small, large] = [1.0, scale].map(|s| ellipse(30.0 * s, 15.0 * s, 0.4).length_weighted_area_px(share));
            prop_assert!((large / small / (scale * scale) - 1.0).abs() < 1.0e-3);
        }
    }

    #[test]
    fn a_hand_turned_edge_on_keeps_more_of_its_length_weighted_area() {
        let [flat, edge] = [20.0, 10.0].map(|width| ellipse(40.0, width, 0.0));
        let kept = |share| edge.length_weighted_area_px(share) / flat.length_weighted_area_px(share);
        assert!(kept(0.63) > kept(0.5) + 0.05);
    }

    #[test]
    fn a_blob_without_extent_has_a_positive_area() {
        assert!(HandCandidate::default().length_weighted_area_px(0.6) > 0.5);
    }
}
