//! Butterworth's low-pass filter, forwards and backwards, so that it has no lag.

use super::odd_extension::extended;
use std::f64::consts::PI;

/// Section of a filter, of second or of first order: `y[n] = b0 x[n] + b1 x[n-1] + b2 x[n-2] -
/// a1 y[n-1] - a2 y[n-2]`. A constant passes unchanged.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Section {
    b: [f64; 3],
    a: [f64; 2],
}

impl Section {
    /// The analogue section 1 / (s^2 + s / q + 1) by the bilinear transform (Oppenheim and Schafer,
    /// "Discrete-Time Signal Processing", section 7.1.2). `warped` is tan(pi cut-off / rate).
    fn second_order(warped: f64, inverse_q: f64) -> Self {
        let square = warped * warped;
        let scale = 1.0 / (1.0 + warped * inverse_q + square);
        let b = square * scale;
        Self { b: [b, 2.0 * b, b], a: [2.0 * (square - 1.0) * scale, (1.0 - warped * inverse_q + square) * scale] }
    }

    /// The analogue section 1 / (s + 1).
    fn first_order(warped: f64) -> Self {
        let b = warped / (1.0 + warped);
        Self { b: [b, b, 0.0], a: [(warped - 1.0) / (1.0 + warped), 0.0] }
    }

    /// Filters in place, from the state of a series that has always been its first value (the
    /// transposed direct form II).
    fn run(&self, values: &mut [f64]) {
        let Some(&first) = values.first() else { return };
        let Self { b: [b0, b1, b2], a: [a1, a2] } = *self;
        let mut second = (b2 - a2) * first;
        let mut state = (b1 - a1) * first + second;
        for value in values {
            let output = b0 * *value + state;
            state = b1 * *value - a1 * output + second;
            second = b2 * *value - a2 * output;
            *value = output;
        }
    }
}

/// Sections of a low-pass filter of `order`; `cutoff` is a share of the rate, in (0, 0.5).
fn sections(cutoff: f64, order: usize) -> Vec<Section> {
    let warped = (PI * cutoff).tan();
    let inverse_q = |pair: usize| 2.0 * ((2 * pair + 1) as f64 * PI / (2 * order) as f64).sin();
    let pairs = (0..order / 2).map(|pair| Section::second_order(warped, inverse_q(pair)));
    let rest = (!order.is_multiple_of(2)).then(|| Section::first_order(warped));
    pairs.chain(rest).collect()
}

/// `values` through a filter of half of `order` forwards and then backwards (Gustafsson 1996).
/// `cutoff` is a share of the rate in (0, 0.5); `order` is even.
///
/// The ends are continued by three times the number of coefficients, as `filtfilt` of SciPy and
/// MATLAB does. A short series is continued as far as it goes.
#[must_use]
pub fn smoothed(values: &[f64], cutoff: f64, order: usize) -> Vec<f64> {
    let one_way = order / 2;
    let sections = sections(cutoff, one_way);
    let (mut series, before) = extended(values, 3 * (one_way + 1));
    for _ in 0..2 {
        sections.iter().for_each(|section| section.run(&mut series));
        series.reverse();
    }
    series[before..before + values.len()].to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A slow swing with a rough part.
    fn rough() -> Vec<f64> {
        (0..24).map(f64::from).map(|i| (0.35 * i).sin() + 0.3 * (2.5 * i * i).sin()).collect()
    }

    /// `filtfilt(*butter(order // 2, cutoff / (rate / 2)), x)` of SciPy 1.17.1 at some samples.
    #[test]
    fn values_are_those_of_scipy() {
        const SAMPLES: [usize; 6] = [0, 1, 7, 12, 22, 23];
        let references = [
            (
                4,
                6.0,
                30.0,
                [0.000084298798, 0.334066165909, 0.746947239282, -0.625128430036, 0.975224143379, 1.013949899470],
            ),
            (
                4,
                6.0,
                60.0,
                [0.001054551160, 0.308172164020, 0.674163188313, -0.664782659556, 0.894751018091, 1.019920158942],
            ),
            (
                8,
                6.0,
                60.0,
                [-0.003112337986, 0.335683066121, 0.718574984421, -0.747426200284, 0.893366955377, 1.011133620364],
            ),
            (
                2,
                5.0,
                30.0,
                [-0.000067731631, 0.327805959739, 0.675002849453, -0.583471048100, 0.919445758464, 1.013832808207],
            ),
            (
                6,
                5.0,
                30.0,
                [-0.000287871988, 0.314822760954, 0.743685857516, -0.659362312862, 0.996670822729, 1.014044462697],
            ),
        ];
        for (order, cutoff_hz, rate_hz, wanted) in references {
            let smooth = smoothed(&rough(), cutoff_hz / rate_hz, order);
            for (sample, wanted) in SAMPLES.into_iter().zip(wanted) {
                assert!((smooth[sample] - wanted).abs() < 1.0e-9, "{order} {cutoff_hz}: {sample} {}", smooth[sample]);
            }
        }
    }

    /// As `filtfilt(..., padlen=4)` has it.
    #[test]
    fn a_short_series_is_continued_as_far_as_it_goes() {
        let wanted = [0.002235687644, 0.317987041654, 0.557561728438, 0.826133939132, 1.210774271415];
        for (value, wanted) in smoothed(&rough()[..5], 0.2, 4).into_iter().zip(wanted) {
            assert!((value - wanted).abs() < 1.0e-9, "{value}");
        }
        assert!((smoothed(&[3.0], 0.2, 4)[0] - 3.0).abs() < 1.0e-12);
    }

    #[test]
    fn half_of_the_cut_off_frequency_is_left() {
        let wave: Vec<f64> = (0..600).map(|i| (2.0 * PI * 0.1 * f64::from(i)).cos()).collect();
        let smooth = smoothed(&wave, 0.1, 4);
        assert!((smooth[300] - 0.5).abs() < 1.0e-6, "{}", smooth[300]);
    }
}
