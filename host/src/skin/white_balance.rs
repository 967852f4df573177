//! A quarter of a grey-world correction: most of what an image's own tint tells, with little of its false alarms.
//!
//! A full grey-world correction takes a picture full of skin for a picture in red light. Its fourth root moves colours
//! a quarter of the way (in log), and is made of square roots, which are the same bits everywhere.

use super::gaussian::GaussianModel;
use image::RgbImage;
use serde::{Deserialize, Serialize};

/// Every how many rows of an image count for its mean colour.
const ROW_STEP: usize = 4;

/// How a model's chromaticities relate to those of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WhiteBalance {
    /// They are the same.
    None,
    /// The model's are those of the image after [`Gains::quarter_grey_world`].
    QuarterGreyWorld,
}

/// Factors for red, green and blue.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gains([f64; 3]);

impl Gains {
    /// Changes nothing.
    pub const NEUTRAL: Self = Self([1.0; 3]);

    /// The fourth roots of the factors that would make the mean colour grey.
    #[must_use]
    pub fn quarter_grey_world(mean: [f64; 3]) -> Self {
        let mean = mean.map(|channel| channel.max(1.0));
        let grey = (mean[0] + mean[1] + mean[2]) / 3.0;
        Self(mean.map(|channel| (grey / channel).sqrt().sqrt()))
    }

    /// The gains for an image.
    #[must_use]
    pub fn of_image(balance: WhiteBalance, image: &RgbImage) -> Self {
        match balance {
            WhiteBalance::None => Self::NEUTRAL,
            WhiteBalance::QuarterGreyWorld => Self::quarter_grey_world(mean_colour(image)),
        }
    }

    /// The balanced colour, not rounded.
    #[must_use]
    pub fn apply(&self, rgb: [u8; 3]) -> [f64; 3] {
        [0, 1, 2].map(|i| f64::from(rgb[i]) * self.0[i])
    }

    /// The Gaussian of raw chromaticities that becomes `model` when balanced, to first order around its mean.
    ///
    /// Balancing maps chromaticities by a perspective map that is close to the identity, so the first order is enough.
    #[must_use]
    pub fn raw_model(&self, model: &GaussianModel) -> GaussianModel {
        let [r, g] = model.mean;
        // Raw = balanced / gains; x_i = q_i / sum(q), with q_i = m_i / gain_i.
        let q = [r / self.0[0], g / self.0[1], (1.0 - r - g) / self.0[2]];
        let sum = q[0] + q[1] + q[2];
        let mean = [q[0] / sum, q[1] / sum];
        // Derivatives of q and of its sum by the balanced r and g, blue being what is left.
        let dq = [[1.0 / self.0[0], 0.0], [0.0, 1.0 / self.0[1]]];
        let dsum = [1.0 / self.0[0] - 1.0 / self.0[2], 1.0 / self.0[1] - 1.0 / self.0[2]];
        let jacobian = [0, 1].map(|i| [0, 1].map(|j| (dq[i][j] - mean[i] * dsum[j]) / sum));
        GaussianModel { mean, covariance: propagate(jacobian, model.covariance), ..*model }
    }
}

/// J C J' of a symmetric C (rr, rg, gg).
fn propagate(jacobian: [[f64; 2]; 2], [rr, rg, gg]: [f64; 3]) -> [f64; 3] {
    let form = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] * rr + (a[0] * b[1] + a[1] * b[0]) * rg + a[1] * b[1] * gg;
    [form(jacobian[0], jacobian[0]), form(jacobian[0], jacobian[1]), form(jacobian[1], jacobian[1])]
}

/// Mean colour of every fourth row.
fn mean_colour(image: &RgbImage) -> [f64; 3] {
    let row_bytes = 3 * image.width() as usize;
    let (mut sums, mut count) = ([0_u64; 3], 0_u64);
    for row in image.as_raw().chunks_exact(row_bytes.max(1)).step_by(ROW_STEP) {
        for pixel in row.as_chunks::<3>().0 {
            sums = [0, 1, 2].map(|i| sums[i] + u64::from(pixel[i]));
        }
        count += u64::from(image.width());
    }
    sums.map(|sum| sum as f64 / count.max(1) as f64)
}

#[cfg(test)]
mod tests {
    use super::super::gaussian::chromaticity;
    use super::*;
    use image::Rgb;

    fn model() -> GaussianModel {
        let white_balance = WhiteBalance::QuarterGreyWorld;
        GaussianModel {
            mean: [0.45, 0.31],
            covariance: [1.6e-3, 1e-4, 1.8e-4],
            threshold: 2.0,
            min_sum: 60,
            white_balance,
        }
    }

    #[test]
    fn a_grey_image_changes_nothing() {
        let grey = RgbImage::from_fn(9, 9, |u, v| Rgb([(u * 20 + v) as u8; 3]));
        assert_eq!(Gains::of_image(WhiteBalance::QuarterGreyWorld, &grey), Gains::NEUTRAL);
        let same = Gains::NEUTRAL.raw_model(&model());
        assert!((same.mean[0] - 0.45).abs() < 1e-12 && (same.covariance[0] - 1.6e-3).abs() < 1e-12);
    }

    #[test]
    fn the_raw_model_measures_as_the_model_does_after_balancing() {
        let gains = Gains::quarter_grey_world([180.0, 120.0, 90.0]);
        let (raw, balanced) = (gains.raw_model(&model()).classifier().unwrap(), model().classifier().unwrap());
        for rgb in [[180, 120, 90], [200, 130, 120], [150, 110, 70], [120, 90, 85]] {
            let scaled = gains.apply(rgb);
            let after = balanced.distance(scaled.map(|c| (c.round()) as u8)).unwrap();
            let before = raw.distance(rgb).unwrap();
            assert!((before - after).abs() < 0.15, "{rgb:?}: {before} and {after}");
        }
    }

    #[test]
    fn red_light_pulls_the_raw_mean_to_red_and_black_is_no_trouble() {
        let raw = Gains::quarter_grey_world([200.0, 100.0, 100.0]).raw_model(&model());
        assert!(raw.mean[0] > 0.47, "{:?}", raw.mean);
        assert_eq!(Gains::of_image(WhiteBalance::QuarterGreyWorld, &RgbImage::new(3, 3)), Gains::NEUTRAL);
        assert!(chromaticity([0.0; 3]).is_none());
    }
}
