//! A quarter of a grey-world correction: a skin model follows the tint of each picture in part.
//!
//! A full grey-world correction takes a picture full of skin for a picture in red light. Its fourth
//! root moves colours a quarter of the way (in log). The exponent is measured in `docs/skin.md`.
//! This module computes in `f64`, for hosts and browsers; square roots are rounded exactly
//! everywhere.

use libm::sqrt;

/// One of so many rows of a picture counts for its mean colour.
const ROW_STEP: usize = 4;

/// Factors for red, green and blue.
///
/// ```
/// use sinew_core::vision::white_balance::Gains;
///
/// // A picture of two reddish pixels: red is lowered, blue raised.
/// let gains = Gains::of_picture(&[200, 120, 80, 200, 120, 80], 2);
/// let [red, _, blue] = gains.apply([200, 120, 80]);
/// assert!(red < 200.0 && blue > 80.0);
/// // A mean of skin in this light has a redder raw mean.
/// let (mean, _) = gains.raw_moments([0.45, 0.31], [1.6e-3, 1.0e-4, 1.8e-4]);
/// assert!(mean[0] > 0.45);
/// assert_eq!(Gains::quarter_grey_world([90.0; 3]), Gains::NEUTRAL);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gains([f64; 3]);

impl Gains {
    /// Factors of one: no correction.
    pub const NEUTRAL: Self = Self([1.0; 3]);

    /// The gains for a picture of interleaved RGB with `width` pixels a row.
    #[must_use]
    pub fn of_picture(rgb: &[u8], width: usize) -> Self {
        Self::quarter_grey_world(mean_colour(rgb, width))
    }

    /// The fourth roots of the factors that would make the mean colour (0 to 255 a channel) grey.
    #[must_use]
    pub fn quarter_grey_world(mean: [f64; 3]) -> Self {
        let mean = mean.map(|channel| channel.max(1.0));
        let grey = (mean[0] + mean[1] + mean[2]) / 3.0;
        Self(mean.map(|channel| sqrt(sqrt(grey / channel))))
    }

    /// The balanced colour, not rounded.
    #[must_use]
    pub fn apply(&self, rgb: [u8; 3]) -> [f64; 3] {
        [0, 1, 2].map(|i| f64::from(rgb[i]) * self.0[i])
    }

    /// A colour with the chromaticity of the balanced one, at most as bright as `rgb`: no channel
    /// is cut off.
    #[must_use]
    pub fn darkened(&self, rgb: [u8; 3]) -> [u8; 3] {
        let max = self.0[0].max(self.0[1]).max(self.0[2]);
        [0, 1, 2].map(|i| (f64::from(rgb[i]) * self.0[i] / max + 0.5) as u8)
    }

    /// Mean (r, g) and covariance (rr, rg, gg) of raw chromaticities that become `mean` and
    /// `covariance` when balanced.
    ///
    /// To first order around the mean: balancing is a perspective map close to the identity.
    #[must_use]
    pub fn raw_moments(&self, mean: [f64; 2], covariance: [f64; 3]) -> ([f64; 2], [f64; 3]) {
        let [r, g] = mean;
        // Raw = balanced / gains; x_i = q_i / sum(q), with q_i = m_i / gain_i.
        let q = [r / self.0[0], g / self.0[1], (1.0 - r - g) / self.0[2]];
        let sum = q[0] + q[1] + q[2];
        let mean = [q[0] / sum, q[1] / sum];
        // Derivatives of q and of its sum by the balanced r and g; blue is the rest.
        let dq = [[1.0 / self.0[0], 0.0], [0.0, 1.0 / self.0[1]]];
        let dsum = [1.0 / self.0[0] - 1.0 / self.0[2], 1.0 / self.0[1] - 1.0 / self.0[2]];
        let jacobian = [0, 1].map(|i| [0, 1].map(|j| (dq[i][j] - mean[i] * dsum[j]) / sum));
        (mean, propagated(jacobian, covariance))
    }
}

/// J C J' of a symmetric C (rr, rg, gg).
fn propagated(jacobian: [[f64; 2]; 2], [rr, rg, gg]: [f64; 3]) -> [f64; 3] {
    let form = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] * rr + (a[0] * b[1] + a[1] * b[0]) * rg + a[1] * b[1] * gg;
    [form(jacobian[0], jacobian[0]), form(jacobian[0], jacobian[1]), form(jacobian[1], jacobian[1])]
}

/// Mean colour of every fourth row.
fn mean_colour(rgb: &[u8], width: usize) -> [f64; 3] {
    let (mut sums, mut count) = ([0_u64; 3], 0_u64);
    for row in rgb.chunks_exact((3 * width).max(1)).step_by(ROW_STEP) {
        for pixel in row.as_chunks::<3>().0 {
            for (sum, channel) in sums.iter_mut().zip(pixel) {
                *sum += u64::from(*channel);
            }
        }
        count += width as u64;
    }
    sums.map(|sum| sum as f64 / count.max(1) as f64)
}
