//! How likely a blob is a hand: arm (6) to (9), as printed or adapted to open hands.
//!
//! ```
//! use sinew_core::vision::hand_likelihood::HandLikelihood;
//!
//! let likelihood = HandLikelihood::default();
//! let image_px = 640.0 * 480.0;
//! // The same shape as large as a hand at a metre, and as a speck.
//! let hand = likelihood.of_features(4700.0, image_px, 0.9, 0.8);
//! let speck = likelihood.of_features(60.0, image_px, 0.9, 0.8);
//! assert!(hand > 0.9 && speck < 0.2, "{hand}, {speck}");
//! ```

use super::features::Blob;
use crate::error::{ParameterError, Rule, not_negative, positive};
use crate::math::{clamp, exp, ln, max};

/// Which features are used, and how.
///
/// ```
/// use sinew_core::vision::hand_likelihood::{HandLikelihood, LikelihoodForm};
///
/// // A good shape, a little smaller than the smallest hand: the paper's gate rejects it, the
/// // default lowers its likelihood.
/// let filled = HandLikelihood::default();
/// let paper = filled.with_form(LikelihoodForm::Paper);
/// let [paper, filled] =
///     [paper, filled].map(|form| form.of_features(300.0, 640.0 * 480.0, 0.9, 0.8));
/// assert_eq!(paper, 0.0);
/// assert!((0.1..0.5).contains(&filled), "{filled}");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[repr(u8)]
pub enum LikelihoodForm {
    /// arm (6) to (9) as printed: an area gate, features of the plain blob, weights as factors.
    Paper,
    /// A smooth area term times the geometric mean of both features of the finger-filled blob.
    ///
    /// Weights are exponents, so that a weight of zero leaves its feature out.
    #[default]
    Filled,
}

/// Turns a blob's features into p(hand | blob).
///
/// ```
/// use sinew_core::vision::hand_likelihood::{
///     DEFAULT_AREA_FRACTIONS, DEFAULT_SCALE, HandLikelihood, LikelihoodForm,
/// };
///
/// // Gloves change the outline: leave the ellipse out, by a weight of zero.
/// let weights = [1.0, 1.0, 0.0];
/// let gloved = HandLikelihood::new(
///     LikelihoodForm::Filled,
///     weights,
///     DEFAULT_AREA_FRACTIONS,
///     DEFAULT_SCALE,
/// )?;
/// let of =
///     |likelihood: &HandLikelihood| likelihood.of_features(5000.0, 640.0 * 480.0, 0.9, 0.1);
/// assert!(of(&gloved) > 0.9 && of(&gloved) > of(&HandLikelihood::default()));
/// // A wrong parameter is refused by its name.
/// let wrong = HandLikelihood::new(
///     LikelihoodForm::Filled,
///     [-1.0; 3],
///     DEFAULT_AREA_FRACTIONS,
///     DEFAULT_SCALE,
/// );
/// assert_eq!(wrong.map_err(|error| error.parameter), Err("weights"));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct HandLikelihood {
    form: LikelihoodForm,
    weights: [f32; 3],
    area_fractions: [f32; 2],
    scale: f32,
}

/// Weights of the area, centrality and ellipse features; w_j = 1 of arm (6).
pub const DEFAULT_WEIGHTS: [f32; 3] = [1.0; 3];
/// Smallest and largest area of a hand as fractions of the image's area; TH_min and TH_max of arm
/// (7).
///
/// Chosen: a webcam of 60 degrees at 4:3 sees a fist of 60 cm^2 at 0.1 % of the image from 2.5 m.
/// It sees an open hand of 150 cm^2 at 15 % from 0.3 m.
pub const DEFAULT_AREA_FRACTIONS: [f32; 2] = [0.001, 0.15];
/// The factor in F(x) = 1 - exp(-5 x) of arm (6).
pub const DEFAULT_SCALE: f32 = 5.0;

/// The smooth area term is a half at this many times TH_min, and at TH_max.
///
/// Chosen: a hand at arm's length from a desk's camera has ten to thirty times TH_min.
/// Measured with the other area parameters:
/// `cargo test -p sinew-lab --test accuracy hand_likelihood_roc`.
const HALF_AT_TIMES_MIN: f32 = 5.0;
/// Far below that, the term goes as the area to this power.
///
/// Chosen with `HALF_AT_TIMES_MIN`: a hand 30 pixels wide in 640 reaches 0.65, a speck of 100
/// pixels 0.07.
const LOW_AREA_POWER: f32 = 1.5;
/// Far beyond TH_max, the term goes as one over the area to this power.
///
/// Chosen: a smooth fall in place of the gate of arm (7).
const HIGH_AREA_POWER: f32 = 2.0;

impl Default for HandLikelihood {
    fn default() -> Self {
        Self {
            form: LikelihoodForm::Filled,
            weights: DEFAULT_WEIGHTS,
            area_fractions: DEFAULT_AREA_FRACTIONS,
            scale: DEFAULT_SCALE,
        }
    }
}

impl HandLikelihood {
    /// A likelihood of the given `form`.
    ///
    /// `weights` belong to the area, centrality and ellipse features. `area_fractions` are the
    /// smallest and largest usual area (TH_min, TH_max), as fractions of the image's area. `scale`
    /// is that of F(x) = 1 - exp(-scale x).
    ///
    /// # Errors
    /// Weights must not be negative, areas and scale positive, the areas in order.
    pub fn new(
        form: LikelihoodForm,
        weights: [f32; 3],
        area_fractions: [f32; 2],
        scale: f32,
    ) -> Result<Self, ParameterError> {
        for weight in weights {
            not_negative("weights", weight)?;
        }
        for fraction in area_fractions {
            positive("area_fractions", fraction)?;
        }
        if area_fractions[0] >= area_fractions[1] {
            return Err(ParameterError::new("area_fractions", Rule::OrderedInterval));
        }
        Ok(Self { form, weights, area_fractions, scale: positive("scale", scale)? })
    }

    /// The same parameters in another form.
    #[must_use]
    pub fn with_form(self, form: LikelihoodForm) -> Self {
        Self { form, ..self }
    }

    /// p(hand | blob) in [0, 1] for a blob of an image of `image_area_px` pixels.
    #[must_use]
    pub fn evaluate(&self, blob: &Blob, image_area_px: f32) -> f32 {
        let shape = match self.form {
            LikelihoodForm::Paper => &blob.plain,
            LikelihoodForm::Filled => &blob.filled,
        };
        self.of_features(blob.area_px as f32, image_area_px, shape.centrality(), shape.ellipse_iou)
    }

    /// arm (6) for an area and two shape features in [0, 1] from any source.
    #[must_use]
    pub fn of_features(&self, area_px: f32, image_area_px: f32, centrality: f32, ellipse_iou: f32) -> f32 {
        self.scaled([self.area_term(area_px, image_area_px), centrality, ellipse_iou])
    }

    /// Upper bound of the likelihood of a blob of this area, for any shape.
    #[must_use]
    pub fn upper_bound(&self, area_px: f32, image_area_px: f32) -> f32 {
        self.of_features(area_px, image_area_px, 1.0, 1.0)
    }

    /// arm (6), or its default form.
    fn scaled(&self, features: [f32; 3]) -> f32 {
        let [area, centrality, ellipse] = features;
        let [w_area, w_centrality, w_ellipse] = self.weights;
        let product = match self.form {
            LikelihoodForm::Paper => w_area * area * w_centrality * centrality * w_ellipse * ellipse,
            LikelihoodForm::Filled => {
                power(area, w_area) * power(centrality, 0.5 * w_centrality) * power(ellipse, 0.5 * w_ellipse)
            }
        };
        clamp(1.0 - exp(-self.scale * product), 0.0, 1.0)
    }

    /// arm (7), or two logistic curves in the logarithm of the area, a rising and a falling one.
    fn area_term(&self, area_px: f32, image_area_px: f32) -> f32 {
        let [low, high] = self.area_fractions;
        let fraction = area_px / max(image_area_px, 1.0);
        match self.form {
            LikelihoodForm::Paper => f32::from(u8::from((low..=high).contains(&fraction))),
            LikelihoodForm::Filled => {
                let small = power(HALF_AT_TIMES_MIN * low / max(fraction, 1.0e-9), LOW_AREA_POWER);
                let large = power(fraction / high, HIGH_AREA_POWER);
                1.0 / ((1.0 + small) * (1.0 + large))
            }
        }
    }
}

/// `base` to the power of `exponent`; 1 for the exponent 0.
fn power(base: f32, exponent: f32) -> f32 {
    if exponent <= 0.0 {
        1.0
    } else if base <= 0.0 {
        0.0
    } else {
        exp(exponent * ln(base))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Pixel;
    use crate::vision::components::BoundingBox;
    use crate::vision::features::ShapeFeatures;
    use proptest::prelude::*;

    fn blob(area_px: u32, plain: (f32, f32), filled: (f32, f32)) -> Blob {
        let shape = |(centrality, ellipse_iou): (f32, f32)| ShapeFeatures {
            area_px: area_px as f32,
            dt_max_px: 10.0,
            dt_at_centroid_px: 10.0 * centrality,
            ellipse_iou,
            ..ShapeFeatures::default()
        };
        Blob {
            area_px,
            centroid: Pixel::default(),
            moments_px2: [1.0, 0.0, 1.0],
            bounding_box: BoundingBox { min_u: 0, min_v: 0, max_u: 9, max_v: 9 },
            plain: shape(plain),
            filled: shape(filled),
            shape_complete: true,
        }
    }

    const IMAGE_PX: f32 = 640.0 * 480.0;

    #[test]
    fn the_paper_form_is_the_printed_equation() {
        let paper = HandLikelihood::default().with_form(LikelihoodForm::Paper);
        let p = paper.evaluate(&blob(5000, (0.5, 0.6), (1.0, 1.0)), IMAGE_PX);
        assert!((p - (1.0 - (-5.0_f32 * 0.3).exp())).abs() < 1.0e-6);
        assert_eq!(paper.evaluate(&blob(60_000, (1.0, 1.0), (1.0, 1.0)), IMAGE_PX), 0.0);
        assert_eq!(paper.evaluate(&blob(300, (1.0, 1.0), (1.0, 1.0)), IMAGE_PX), 0.0);
    }

    #[test]
    fn the_area_counts_smoothly_by_default() {
        let default = HandLikelihood::default();
        let p = [100, 200, 400, 3000, 30_000, 60_000, 120_000, 300_000]
            .map(|area_px| default.evaluate(&blob(area_px, (0.0, 0.0), (0.9, 0.8)), IMAGE_PX));
        assert!(p[..4].is_sorted() && p[3..].is_sorted_by(|a, b| a > b), "{p:?}");
        assert!(p[0] < 0.2 && p[7] < 0.2 && p[3] > 0.85 && p[4] > 0.9, "{p:?}");
    }

    proptest! {
        #[test]
        fn likelihoods_are_probabilities_below_their_bound(
            area in 1_u32..4_000_000, plain in (0.0_f32..1.0, 0.0_f32..1.0), filled in (0.0_f32..1.0, 0.0_f32..1.0),
            image in 0.0_f32..1.0e7, weights in prop::array::uniform3(0.0_f32..3.0), paper: bool,
        ) {
            let form = if paper { LikelihoodForm::Paper } else { LikelihoodForm::Filled };
            let likelihood = HandLikelihood::new(form, weights, DEFAULT_AREA_FRACTIONS, DEFAULT_SCALE).unwrap();
            let p = likelihood.evaluate(&blob(area, plain, filled), image);
            prop_assert!((0.0..=1.0).contains(&p));
            prop_assert!(p <= likelihood.upper_bound(area as f32, image) + 1.0e-6);
        }
    }

    #[test]
    fn bad_parameters_are_refused_by_name() {
        let new = |w, a, s| HandLikelihood::new(LikelihoodForm::Paper, w, a, s).unwrap_err();
        assert_eq!(new([1.0, -1.0, 1.0], [0.1, 0.2], 5.0), ParameterError::new("weights", Rule::NotNegative));
        assert_eq!(new([1.0; 3], [0.2, 0.1], 5.0), ParameterError::new("area_fractions", Rule::OrderedInterval));
        assert_eq!(new([1.0; 3], [0.1, 0.2], 0.0), ParameterError::new("scale", Rule::Positive));
    }
}
