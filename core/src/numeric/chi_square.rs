//! The innovation gate: chi-square test of the normalised innovation squared (NIS).

use crate::math::sqrt;

/// Default gate, as a quantile of the standard normal. Chosen: it flags one valid measurement in a
/// thousand.
pub const DEFAULT_GATE_SIGMAS: f32 = 3.09;

/// Value that a chi-square variable with `degrees` degrees of freedom exceeds as often as a
/// standard normal exceeds `sigmas`. Source: Wilson and Hilferty 1931, within 4 % from `sigmas` 1
/// to 4.
///
/// ```
/// use sinew_core::numeric::chi_square::{DEFAULT_GATE_SIGMAS, chi_square_quantile};
///
/// // Tables say 34.53 for 13 degrees of freedom and a probability of 0.001.
/// assert!((chi_square_quantile(13, DEFAULT_GATE_SIGMAS) - 34.53).abs() < 0.2);
/// ```
#[must_use]
pub fn chi_square_quantile(degrees: usize, sigmas: f32) -> f32 {
    if degrees == 0 {
        return 0.0;
    }
    let n = degrees as f32;
    let spread = 2.0 / (9.0 * n);
    let root = 1.0 - spread + sigmas * sqrt(spread);
    n * root * root * root
}

/// Whether a normalised innovation squared (NIS) lies beyond the gate.
///
/// ```
/// use sinew_core::numeric::chi_square::{DEFAULT_GATE_SIGMAS, is_outlier};
///
/// assert!(!is_outlier(20.0, 13, DEFAULT_GATE_SIGMAS), "13 angles, each a little off");
/// assert!(is_outlier(20.0, 1, DEFAULT_GATE_SIGMAS), "one angle, 4.5 standard deviations off");
/// assert!(!is_outlier(0.0, 0, DEFAULT_GATE_SIGMAS), "nothing seen, nothing wrong");
/// ```
#[must_use]
pub fn is_outlier(innovation_squared: f32, present_angles: usize, sigmas: f32) -> bool {
    present_angles > 0 && !(innovation_squared <= chi_square_quantile(present_angles, sigmas))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_agree_with_the_tables() {
        // Upper 0.1 % points of chi-square.
        for (degrees, exact) in [(1, 10.828), (2, 13.816), (5, 20.515), (13, 34.528)] {
            let quantile = chi_square_quantile(degrees, 3.090_2);
            assert!((quantile / exact - 1.0).abs() < 0.04, "{degrees}: {quantile} instead of {exact}");
        }
    }

    #[test]
    fn an_empty_measurement_is_no_outlier_and_nan_is_one() {
        assert!(!is_outlier(0.0, 0, 3.0));
        assert!(is_outlier(f32::NAN, 3, 3.0));
        assert!(is_outlier(40.0, 13, DEFAULT_GATE_SIGMAS) && !is_outlier(30.0, 13, DEFAULT_GATE_SIGMAS));
    }
}
