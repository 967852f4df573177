//! Tempering: a likelihood that would let too few particles live is flattened.

use crate::math::exp;
use crate::particle::Weights;

/// Halvings of the exponent's interval.
const HALVINGS: usize = 14;

/// The greatest exponent in (0, 1] that leaves at least `least` effective particles when all
/// log-weights are multiplied by it; 2^-14 where none does.
#[must_use]
pub fn temper<const N: usize>(weights: &Weights<N>, least: f32) -> f32 {
    let greatest = weights.log().iter().copied().fold(f32::NEG_INFINITY, |a, b| if b > a { b } else { a });
    if !greatest.is_finite() {
        return 1.0;
    }
    let effective = |exponent: f32| {
        let (mut sum, mut square) = (0.0, 0.0);
        for &log_weight in weights.log() {
            if !log_weight.is_nan() {
                let weight = exp(exponent * (log_weight - greatest));
                sum += weight;
                square += weight * weight;
            }
        }
        sum * sum / square
    };
    if effective(1.0) >= least {
        return 1.0;
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if effective(middle) >= least {
            low = middle;
        } else {
            high = middle;
        }
    }
    if low > 0.0 { low } else { high }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_wanted_share_lives_on(logs in prop::collection::vec(-4000.0_f32..0.0, 20..64), share in 0.1_f32..0.6) {
            let mut weights = Weights::<64>::uniform(logs.len()).unwrap();
            for (i, &value) in logs.iter().enumerate() {
                weights.set_log(i, value);
            }
            let wanted = share * logs.len() as f32;
            let exponent = temper(&weights, wanted);
            prop_assert!(exponent > 0.0 && exponent <= 1.0);
            for (i, &value) in logs.iter().enumerate() {
                weights.set_log(i, exponent * value);
            }
            weights.normalise().unwrap();
            let found = weights.effective_sample_size();
            prop_assert!(found >= 0.98 * wanted, "{} instead of {}", found, wanted);
            prop_assert!(exponent == 1.0 || found <= 1.2 * wanted + 1.0, "{} instead of {}", found, wanted);
        }
    }
}
