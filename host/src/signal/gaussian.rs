//! A weighted mean with Gaussian weights.

use super::odd_extension::extended;
use std::f64::consts::{LN_2, PI};

/// Where the weights end, in standard deviations: 6e-5 of them lie beyond. Source: SciPy's
/// `gaussian_filter1d`.
const TRUNCATION: f64 = 4.0;

/// `values` with Gaussian weights that leave one half at `cutoff`, a share of the rate.
///
/// exp(-2 (pi sigma f)^2) is a Gaussian's gain, so sigma is root(ln 2 / 2) / (pi cutoff).
#[must_use]
pub fn smoothed(values: &[f64], cutoff: f64) -> Vec<f64> {
    let sigma = (LN_2 / 2.0).sqrt() / (PI * cutoff);
    let reach = (TRUNCATION * sigma + 0.5).floor() as usize;
    let weights: Vec<f64> =
        (0..=2 * reach).map(|i| (-0.5 * ((i as f64 - reach as f64) / sigma).powi(2)).exp()).collect();
    let sum: f64 = weights.iter().sum();
    let (series, before) = extended(values, reach);
    let (first, last) = (series.first().copied().unwrap_or(0.0), series.last().copied().unwrap_or(0.0));
    let at = |place: usize| match place.checked_sub(reach) {
        None => first,
        Some(place) => series.get(place).copied().unwrap_or(last),
    };
    let mean = |sample: usize| {
        let products = weights.iter().enumerate().map(|(i, weight)| weight * at(before + sample + i));
        products.sum::<f64>() / sum
    };
    (0..values.len()).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `gaussian_filter1d` of SciPy 1.17.1 on the series with its odd extension; 6 Hz at 60 Hz.
    #[test]
    fn values_are_those_of_scipy() {
        let series: Vec<f64> = (0..24).map(f64::from).map(|i| (0.35 * i).sin() + 0.3 * (2.5 * i * i).sin()).collect();
        let smooth = smoothed(&series, 0.1);
        let wanted = [(0, 0.0), (1, 0.269704726221), (7, 0.600859916406), (12, -0.569810894455), (22, 0.896729640137)];
        for (sample, wanted) in wanted {
            assert!((smooth[sample] - wanted).abs() < 1.0e-9, "{sample}: {}", smooth[sample]);
        }
    }

    #[test]
    fn half_of_the_cut_off_frequency_is_left() {
        let wave: Vec<f64> = (0..600).map(|i| (2.0 * PI * 0.04 * f64::from(i)).cos()).collect();
        assert!((smoothed(&wave, 0.04)[300] - 0.5).abs() < 1.0e-3);
        assert!((smoothed(&[2.0, 2.0], 0.001)[1] - 2.0).abs() < 1.0e-12);
    }
}
