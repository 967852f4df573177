//! A blob measured in one pass over its lines, and its likelihood of being a hand.

use crate::camera::Pixel;
use crate::math::{clamp, max, sqrt};
use crate::vision::blobs::Ranked;
use crate::vision::candidate::HandCandidate;
use crate::vision::components::{BoundingBox, Component};
use crate::vision::hand_likelihood::HandLikelihood;
use core::f32::consts::PI;

/// Features from a connected component's sums.
///
/// The same numbers as those of [`crate::vision::features::Blob`] for the same pixels.
///
/// ```
/// use sinew_core::vision::component_scanner::ComponentScanner;
/// use sinew_core::vision::front_end::moment_blob::MomentBlob;
/// use sinew_core::vision::hand_likelihood::HandLikelihood;
/// use sinew_core::vision::mask::Mask;
/// use sinew_core::vision::runs::RunPool;
///
/// // A bracket: one arm up, one arm across.
/// let mut rows = [0x0f; 32];
/// rows[28..].fill(u32::MAX);
/// let mask = Mask::new(&rows, 32, 32)?;
/// ComponentScanner::<8, 8>::new().scan(
///     &mask,
///     &mut RunPool::new(&mut []),
///     &mut |component, _| {
///         let bracket = MomentBlob::of(component, &HandLikelihood::default(), 32.0 * 32.0);
///         assert_eq!(bracket.area_px, 28 * 4 + 4 * 32);
///         assert!(
///             bracket.ellipse_fill() < 0.6 && bracket.roundness() < 0.5,
///             "neither an ellipse nor round"
///         );
///     },
/// );
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct MomentBlob {
    /// Number of pixels.
    pub area_px: u32,
    /// Centre of gravity.
    pub centroid: Pixel,
    /// Second central moments of the pixels: uu, uv, vv, square pixels.
    pub moments_px2: [f32; 3],
    /// Length of the outline, holes' outlines too, pixels; see
    /// [`crate::vision::components::crofton_perimeter`].
    pub perimeter_px: f32,
    /// Smallest upright rectangle around all pixels.
    pub bounding_box: BoundingBox,
    /// Moment likelihood of being a hand, 0 to 1; see [`moment_likelihood`].
    pub moment_likelihood: f32,
}

impl MomentBlob {
    /// Measures a component of an image of `image_area_px` pixels.
    #[must_use]
    pub fn of(component: &Component, likelihood: &HandLikelihood, image_area_px: f32) -> Self {
        let mut blob = Self {
            area_px: component.area_px(),
            centroid: component.centroid(),
            moments_px2: component.moments_px2(),
            perimeter_px: component.perimeter_px(),
            bounding_box: component.bounding_box(),
            moment_likelihood: 0.0,
        };
        blob.moment_likelihood = moment_likelihood(&blob, likelihood, image_area_px);
        blob
    }

    /// Area as a part of that of the ellipse with the same second moments, 0 to 1. It is one for an
    /// ellipse, 0.95 for a rectangle, and less for what is bent, branched or hollow.
    #[must_use]
    pub fn ellipse_fill(&self) -> f32 {
        // The variance of one pixel's square is 1/12 in both directions.
        let [uu, uv, vv] = self.moments_px2;
        let (uu, vv) = (max(uu, 0.0) + 1.0 / 12.0, max(vv, 0.0) + 1.0 / 12.0);
        let area = 4.0 * PI * sqrt(max(uu * vv - uv * uv, 1.0 / 144.0));
        clamp(self.area_px as f32 / area, 0.0, 1.0)
    }

    /// 4 pi A / P^2, 0 to 1: one for a disc, less the longer the outline.
    #[must_use]
    pub fn roundness(&self) -> f32 {
        let square = self.perimeter_px * self.perimeter_px;
        clamp(4.0 * PI * self.area_px as f32 / max(square, 1.0), 0.0, 1.0)
    }
}

/// The *moment likelihood*: p(hand | blob) from one pass, without a distance transform and a
/// rotated ellipse.
///
/// It is F of the area term of `likelihood` and of [`MomentBlob::ellipse_fill`], which replaces
/// both shape features. A blob that fills the ellipse of its own moments has its mass about its
/// centre and is covered by an ellipse. The perimeter has no influence: an open hand's outline is
/// long unless its fingers are filled.
///
/// ```
/// use core::f32::consts::PI;
/// use sinew_core::camera::Pixel;
/// use sinew_core::vision::components::BoundingBox;
/// use sinew_core::vision::front_end::moment_blob::{MomentBlob, moment_likelihood};
/// use sinew_core::vision::hand_likelihood::HandLikelihood;
///
/// // A disc of radius 30, and a ring of the same area from radius 40 to 50.
/// let disc = MomentBlob {
///     area_px: 2827,
///     centroid: Pixel::new(160.0, 120.0),
///     moments_px2: [225.0, 0.0, 225.0],
///     perimeter_px: 2.0 * PI * 30.0,
///     bounding_box: BoundingBox { min_u: 130, min_v: 90, max_u: 190, max_v: 150 },
///     moment_likelihood: 0.0,
/// };
/// let ring = MomentBlob { moments_px2: [1025.0, 0.0, 1025.0], ..disc };
/// let of = |blob| moment_likelihood(blob, &HandLikelihood::default(), 320.0 * 240.0);
/// assert!(of(&disc) > 0.9 && of(&ring) < of(&disc) - 0.2, "{} {}", of(&disc), of(&ring));
/// ```
#[must_use]
pub fn moment_likelihood(blob: &MomentBlob, likelihood: &HandLikelihood, image_area_px: f32) -> f32 {
    let fill = blob.ellipse_fill();
    likelihood.of_features(blob.area_px as f32, image_area_px, fill, fill)
}

impl Ranked for MomentBlob {
    fn likelihood(&self) -> f32 {
        self.moment_likelihood
    }

    fn candidate(&self) -> HandCandidate {
        HandCandidate {
            centre: self.centroid,
            moments_px2: self.moments_px2,
            area_px: self.area_px as f32,
            likelihood: self.moment_likelihood,
        }
    }
}
