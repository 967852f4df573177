//! The shipped skin model, and how it follows a picture's light.

use sinew_core::error::ParameterError;
use sinew_core::vision::skin::GaussianSkin;
use sinew_core::vision::white_balance::Gains;

/// A normal distribution of the chromaticities r = R/(R+G+B) and g = G/(R+G+B) of skin, after
/// [`Gains::quarter_grey_world`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BalancedSkin {
    /// Mean of r and g.
    pub mean: [f64; 2],
    /// Covariance: rr, rg, gg.
    pub covariance: [f64; 3],
    /// Largest Mahalanobis distance that is skin.
    pub threshold: f64,
    /// Smallest R+G+B that is judged, 0 to 765.
    pub min_sum: u16,
}

/// What `sinew` ships as `host/models/skin_gaussian.json`; a test compares the two.
pub const SHIPPED: BalancedSkin = BalancedSkin {
    mean: [0.4518225941392692, 0.31568084533748647],
    covariance: [0.0016592468087220885, 0.00003576732622276313, 0.00018407363888856985],
    threshold: 2.25,
    min_sum: 215,
};

impl BalancedSkin {
    /// The core's classifier with these numbers: for colours that are balanced.
    ///
    /// # Errors
    /// Names the number that cannot be used.
    pub fn classifier(&self) -> Result<GaussianSkin, ParameterError> {
        let [mean_r, mean_g] = self.mean.map(|value| value as f32);
        let covariance = self.covariance.map(|value| value as f32);
        GaussianSkin::new(mean_r, mean_g, covariance, self.threshold as f32, self.min_sum)
    }

    /// The classifier for a picture's own colours, `gains` being those that balance the picture.
    ///
    /// # Errors
    /// None in practice: a small change of tint keeps all numbers usable.
    pub fn for_picture(&self, gains: &Gains) -> Result<GaussianSkin, ParameterError> {
        let (mean, covariance) = gains.raw_moments(self.mean, self.covariance);
        Self { mean, covariance, ..*self }.classifier()
    }

    /// The numbers of a classifier for balanced colours.
    #[must_use]
    pub fn of_classifier(skin: &GaussianSkin) -> Self {
        Self {
            mean: [skin.mean_r(), skin.mean_g()].map(f64::from),
            covariance: skin.covariance().map(f64::from),
            threshold: f64::from(skin.threshold()),
            min_sum: skin.min_sum(),
        }
    }
}
