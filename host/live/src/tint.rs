//! A quarter of a grey-world correction, as the host's: the skin model follows the tint of each picture a little.
//!
//! In `f64` and in the host's order of operations, so that both decide alike to the last bit; square roots are exactly rounded everywhere.

use crate::skin_model::BalancedSkin;
use libm::sqrt;

/// Every how many rows of a picture count for its mean colour.
const ROW_STEP: usize = 4;

/// Factors for red, green and blue.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gains([f64; 3]);

impl Gains {
    /// The gains for a picture of interleaved RGB with `width` pixels a row.
    #[must_use]
    pub fn of_picture(rgb: &[u8], width: usize) -> Self {
        Self::quarter_grey_world(mean_colour(rgb, width))
    }

    /// The fourth roots of the factors that would make the mean colour grey.
    #[must_use]
    pub fn quarter_grey_world(mean: [f64; 3]) -> Self {
        let mean = mean.map(|channel| channel.max(1.0));
        let grey = (mean[0] + mean[1] + mean[2]) / 3.0;
        Self(mean.map(|channel| sqrt(sqrt(grey / channel))))
    }

    /// A colour with the chromaticity of the balanced one, at most as bright as before, so that no channel is cut off.
    #[must_use]
    pub fn darkened(&self, rgb: [u8; 3]) -> [u8; 3] {
        let most = self.0[0].max(self.0[1]).max(self.0[2]);
        [0, 1, 2].map(|i| (f64::from(rgb[i]) * self.0[i] / most + 0.5) as u8)
    }

    /// The Gaussian of raw chromaticities that becomes `model` when balanced, to first order around its mean.
    ///
    /// Balancing maps chromaticities by a perspective map that is close to the identity, so the first order is enough.
    #[must_use]
    pub fn raw_model(&self, model: &BalancedSkin) -> BalancedSkin {
        let [r, g] = model.mean;
        // Raw = balanced / gains; x_i = q_i / sum(q), with q_i = m_i / gain_i.
        let q = [r / self.0[0], g / self.0[1], (1.0 - r - g) / self.0[2]];
        let sum = q[0] + q[1] + q[2];
        let mean = [q[0] / sum, q[1] / sum];
        // Derivatives of q and of its sum by the balanced r and g, blue being what is left.
        let dq = [[1.0 / self.0[0], 0.0], [0.0, 1.0 / self.0[1]]];
        let dsum = [1.0 / self.0[0] - 1.0 / self.0[2], 1.0 / self.0[1] - 1.0 / self.0[2]];
        let jacobian = [0, 1].map(|i| [0, 1].map(|j| (dq[i][j] - mean[i] * dsum[j]) / sum));
        BalancedSkin { mean, covariance: propagated(jacobian, model.covariance), ..*model }
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
