//! Sections `[likelihood]` and `[edges]`: what is taken from the pixels.

use serde::{Deserialize, Serialize};
use sinew_core::error::ParameterError;
use sinew_core::vision::edges::{DEFAULT_MIN_GRADIENT, DEFAULT_MIN_MOTION, EdgeDetector};
use sinew_core::vision::hand_likelihood::{
    DEFAULT_AREA_FRACTIONS, DEFAULT_SCALE, DEFAULT_WEIGHTS, HandLikelihood, LikelihoodForm,
};

/// From a blob's features to p(hand | blob), arm (6) to arm (9).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LikelihoodConfig {
    /// Which form.
    pub form: LikelihoodForm,
    /// Weights of area, centrality and ellipse.
    pub weights: [f32; 3],
    /// Smallest and largest usual area of a hand as shares of the image's area.
    pub area_fractions: [f32; 2],
    /// The factor in F(x) = 1 - exp(-scale x).
    pub scale: f32,
}

impl Default for LikelihoodConfig {
    fn default() -> Self {
        Self {
            form: LikelihoodForm::Filled,
            weights: DEFAULT_WEIGHTS,
            area_fractions: DEFAULT_AREA_FRACTIONS,
            scale: DEFAULT_SCALE,
        }
    }
}

impl LikelihoodConfig {
    /// The likelihood.
    ///
    /// # Errors
    /// Names the value that is out of its range.
    pub fn build(&self) -> Result<HandLikelihood, ParameterError> {
        HandLikelihood::new(self.form, self.weights, self.area_fractions, self.scale)
    }
}

/// Which pixels are temporal edges.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct EdgeConfig {
    /// Smallest gradient, grey levels a pixel.
    pub min_gradient: f32,
    /// Smallest smoothed change since the frame before, grey levels.
    pub min_motion: f32,
}

impl Default for EdgeConfig {
    fn default() -> Self {
        Self { min_gradient: DEFAULT_MIN_GRADIENT, min_motion: DEFAULT_MIN_MOTION }
    }
}

impl EdgeConfig {
    /// The detector.
    ///
    /// # Errors
    /// Names the value that is out of its range.
    pub fn build(&self) -> Result<EdgeDetector, ParameterError> {
        EdgeDetector::new(self.min_gradient, self.min_motion)
    }
}
