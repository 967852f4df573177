//! Locally weighted regression (Cleveland and Devlin 1988). At each sample it is the value of a
//! parabola that is fitted to its neighbours, near ones with more weight.

use nalgebra::{Matrix3, Vector3};

/// Width of the window times the frequency of which one half is left. From the gain of a local
/// parabola with tricube weights: the sum of kernel times cosine is 0.5 at 1.72275.
const WINDOW_TIMES_CUTOFF: f64 = 1.72275;

/// `values` smoothed so that one half is left at `cutoff`, a share of the rate.
#[must_use]
pub fn smoothed(values: &[f64], cutoff: f64) -> Vec<f64> {
    let half = 0.5 * WINDOW_TIMES_CUTOFF / cutoff;
    (0..values.len()).map(|sample| at(values, sample, half)).collect()
}

/// The value of the parabola about `sample`; what lies `half` samples away has no weight.
fn at(values: &[f64], sample: usize, half: f64) -> f64 {
    let reach = half.floor() as usize;
    let (mut products, mut sums, mut count) = (Matrix3::zeros(), Vector3::zeros(), 0);
    for other in sample.saturating_sub(reach)..=(sample + reach).min(values.len() - 1) {
        // Places in units of the window keep the matrix well conditioned.
        let place = (other as f64 - sample as f64) / half;
        let weight = (1.0 - place.abs().powi(3)).max(0.0).powi(3);
        let powers = Vector3::new(1.0, place, place * place);
        products += weight * powers * powers.transpose();
        sums += weight * values[other] * powers;
        count += usize::from(weight > 0.0);
    }
    if count <= 3 {
        return values[sample];
    }
    products.cholesky().map_or(values[sample], |cholesky| cholesky.solve(&sums)[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Weighted `numpy.polyfit` of degree 2 in each window; 6 Hz at 60 Hz.
    #[test]
    fn values_are_those_of_weighted_fits() {
        let series: Vec<f64> = (0..24).map(f64::from).map(|i| (0.35 * i).sin() + 0.3 * (2.5 * i * i).sin()).collect();
        let smooth = smoothed(&series, 0.1);
        let wanted = [(0, 0.0302313), (1, 0.3761824), (7, 0.6587555), (12, -0.6823706), (23, 0.9961069)];
        for (sample, wanted) in wanted {
            assert!((smooth[sample] - wanted).abs() < 1.0e-5, "{sample}: {}", smooth[sample]);
        }
    }

    #[test]
    fn parabolas_stay_and_half_of_the_cut_off_frequency_is_left() {
        let parabola: Vec<f64> = (0..30).map(f64::from).map(|i| 3.0 - i + 0.2 * i * i).collect();
        for (value, wanted) in smoothed(&parabola, 0.1).iter().zip(&parabola) {
            assert!((value - wanted).abs() < 1.0e-9);
        }
        let wave: Vec<f64> = (0..600).map(|i| (TAU * 0.02 * f64::from(i)).cos()).collect();
        assert!((smoothed(&wave, 0.02)[300] - 0.5).abs() < 1.0e-3);
        assert_eq!(smoothed(&[1.0, 5.0, 1.0], 0.1), [1.0, 5.0, 1.0]);
    }
}
