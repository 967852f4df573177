//! Weights of particles relative to the greatest, and their sums over chunks.

use crate::math::{exp, exp_small, max};

/// Turns log-weights into weights relative to `greatest` and returns their sum, taken in eight
/// parts; NaN has no weight.
#[inline(always)]
pub(super) fn exponentiate(greatest: f32, weights: &mut [f32]) -> f32 {
    let mut sums = [0.0; 8];
    let (eights, rest) = weights.as_chunks_mut::<8>();
    for eight in eights {
        for i in 0..8 {
            eight[i] = relative_weight(eight[i], greatest);
            sums[i] += eight[i];
        }
    }
    let mut sum = 0.0;
    for value in rest {
        *value = relative_weight(*value, greatest);
        sum += *value;
    }
    sums.iter().fold(sum, |all, part| all + part)
}

/// Weight relative to the `greatest`; zero for NaN and below exp(-40).
#[inline(always)]
pub(super) fn relative_weight(log_weight: f32, greatest: f32) -> f32 {
    let below = log_weight - greatest;
    let value = exp_small(below);
    if below > -40.0 { value } else { 0.0 }
}

/// Greatest of the log-weights; negative infinity where there is none.
#[inline]
#[must_use]
pub(super) fn greatest(log_weights: &[f32]) -> f32 {
    log_weights.iter().fold(f32::NEG_INFINITY, |best, &value| max(value, best))
}

/// Weights of a set of particles: the greatest log-weight, and the sum of all weights relative to
/// it.
///
/// ```
/// use core::f32::consts::LN_2;
/// use sinew_core::cyclic::particle::weights::WeightShare;
///
/// // Two chunks, the best particle of the second weighs half as much as that of the first.
/// let first = WeightShare { greatest_log_weight: -10.0, weight: 300.0 };
/// let second = WeightShare { greatest_log_weight: -10.0 - LN_2, weight: 100.0 };
/// let scale = second.scale(first.greatest_log_weight);
/// assert!((first.weight + scale * second.weight - 350.0).abs() < 1e-3);
/// assert_eq!(WeightShare::NOTHING.scale(-10.0), 0.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeightShare {
    /// Negative infinity of no particle.
    pub greatest_log_weight: f32,
    /// At least 1 where any particle has a weight.
    pub weight: f32,
}

impl WeightShare {
    /// No particle.
    pub const NOTHING: Self = Self { greatest_log_weight: f32::NEG_INFINITY, weight: 0.0 };

    /// Factor of the weights that makes them relative to `greatest_log_weight`.
    #[must_use]
    pub fn scale(&self, greatest_log_weight: f32) -> f32 {
        if self.greatest_log_weight > f32::NEG_INFINITY {
            exp(self.greatest_log_weight - greatest_log_weight)
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nan_has_no_weight_and_the_greatest_weight_is_one() {
        let mut weights = [-3.0, f32::NAN, -1.0, -200.0, f32::NEG_INFINITY];
        let best = greatest(&weights);
        assert_eq!(best, -1.0);
        let sum = exponentiate(best, &mut weights);
        assert_eq!((weights[1], weights[2], weights[3], weights[4]), (0.0, 1.0, 0.0, 0.0));
        assert!((sum - 1.0 - (-2.0_f32).exp()).abs() < 1.0e-6);
    }
}
