//! Outlier rejection by Hampel's identifier: a value is compared with the median of its window.

use super::median::{STD_PER_MEDIAN, median};
use wide::f64x8;

/// Samples on each side of a window of seven. Source: the default of MATLAB's `hampel`; Pose2Sim
/// and Sports2D have the same window.
const HALF_WINDOW: usize = 3;
/// Samples of a window.
const WINDOW: usize = 2 * HALF_WINDOW + 1;
/// Windows that are judged at once: as many as a vector has numbers.
const LANES: usize = 8;
/// Standard deviations beyond which a value is an outlier. Source: Pearson 2002, "Outliers in
/// process modeling and identification", and MATLAB's `hampel`.
const THRESHOLD: f64 = 3.0;
/// Values in a window that judge its middle; fewer judge nothing. Chosen: with four, the first
/// value of a bend is an outlier.
const MIN_VALUES: usize = 5;

/// Takes outliers out of `series`; true in the result where one was. Up to three in a row are found
/// where they stand out from what the motion does in the window.
///
/// The scale is the window's median absolute deviation, and at least that of the whole series about
/// its running medians. Seven values alone make a scale so small by chance that 4.4 % of plain
/// normal noise would be rejected. With the whole series it is 0.8 %.
pub fn reject(series: &mut [Option<f64>]) -> Vec<bool> {
    let judged = judged(series);
    let mut deviations: Vec<f64> = judged.iter().flatten().map(|[deviation, _]| *deviation).collect();
    let usual = STD_PER_MEDIAN * median(&mut deviations).unwrap_or(0.0);
    let is_outlier =
        |judged: Option<[f64; 2]>| judged.is_some_and(|[deviation, scale]| deviation > THRESHOLD * scale.max(usual));
    let outliers: Vec<bool> = judged.into_iter().map(is_outlier).collect();
    for (value, _) in series.iter_mut().zip(&outliers).filter(|(_, is_outlier)| **is_outlier) {
        *value = None;
    }
    outliers
}

/// [`deviation_and_scale`] of all samples, eight at once where no value is missing.
fn judged(series: &[Option<f64>]) -> Vec<Option<[f64; 2]>> {
    let mut judged = Vec::with_capacity(series.len());
    while judged.len() < series.len() {
        let sample = judged.len();
        match deviations_and_scales(series, sample) {
            Some([deviations, scales]) => judged.extend((0..LANES).map(|lane| Some([deviations[lane], scales[lane]]))),
            None => judged.push(deviation_and_scale(series, sample)),
        }
    }
    judged
}

/// How far a value is from the median of its window, and the window's scale; `None` where there is
/// no value or the window has too few.
fn deviation_and_scale(series: &[Option<f64>], sample: usize) -> Option<[f64; 2]> {
    let value = series[sample]?;
    let window = &series[sample.saturating_sub(HALF_WINDOW)..(sample + HALF_WINDOW + 1).min(series.len())];
    let mut places = [0.0; WINDOW];
    let count = places.iter_mut().zip(window.iter().flatten()).map(|(place, value)| *place = *value).count();
    if count < MIN_VALUES {
        return None;
    }
    let values = &mut places[..count];
    let middle = median(values)?;
    values.iter_mut().for_each(|value| *value = (*value - middle).abs());
    Some([(value - middle).abs(), STD_PER_MEDIAN * median(values)?])
}

/// The same of `sample` and those after it; `None` where a window is not whole.
fn deviations_and_scales(series: &[Option<f64>], sample: usize) -> Option<[[f64; LANES]; 2]> {
    let first = sample.checked_sub(HALF_WINDOW)?;
    let mut values = [0.0; LANES + WINDOW - 1];
    for (place, value) in values.iter_mut().zip(series.get(first..first + LANES + WINDOW - 1)?) {
        *place = (*value)?;
    }
    let window = std::array::from_fn(|place| f64x8::new(std::array::from_fn(|lane| values[place + lane])));
    let middle = median_of_window(window);
    let scale = median_of_window(window.map(|value| (value - middle).abs()));
    Some([(window[HALF_WINDOW] - middle).abs().to_array(), (STD_PER_MEDIAN * scale).to_array()])
}

/// Medians of seven values, by exchanges that leave the fourth smallest in its place.
fn median_of_window(mut values: [f64x8; WINDOW]) -> f64x8 {
    /// Source: Devillard, "Fast median search: an ANSI C implementation", 1998.
    const EXCHANGES: [[usize; 2]; 13] =
        [[0, 5], [0, 3], [1, 6], [2, 4], [0, 1], [3, 5], [2, 6], [2, 3], [3, 6], [4, 5], [1, 4], [1, 3], [3, 4]];
    for [a, b] in EXCHANGES {
        (values[a], values[b]) = (values[a].fast_min(values[b]), values[a].fast_max(values[b]));
    }
    values[HALF_WINDOW]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rejected(values: impl IntoIterator<Item = f64>) -> Vec<usize> {
        let mut series: Vec<Option<f64>> = values.into_iter().map(Some).collect();
        let outliers = reject(&mut series);
        assert!(series.iter().zip(&outliers).all(|(value, is_outlier)| value.is_none() == *is_outlier));
        (0..outliers.len()).filter(|sample| outliers[*sample]).collect()
    }

    #[test]
    fn spikes_of_up_to_three_samples_go() {
        let wave = |i: usize| (0.2 * i as f64).sin() + 0.01 * (7.0 * (i * i) as f64).sin();
        let spikes = [12, 30, 31, 50, 51, 52];
        assert_eq!(rejected((0..70).map(|i| if spikes.contains(&i) { 9.0 } else { wave(i) })), spikes);
    }

    #[test]
    fn smooth_motion_has_no_outliers() {
        assert!(rejected((0..200).map(|i| (0.3 * f64::from(i)).sin())).is_empty());
        assert!(rejected((0..200).map(|i| (f64::from(i) - 100.0).abs())).is_empty());
        assert!(rejected((0..40).map(|i| if i < 20 { 0.0 } else { 5.0 })).is_empty());
        assert!(rejected([1.0, 50.0, 1.0, 1.0]).is_empty(), "too short to judge");
    }

    #[test]
    fn exchanges_find_the_median_of_any_seven() {
        // By the 0-1 principle, all sequences of zeros and ones are enough.
        for bits in 0..1_u32 << WINDOW {
            let values = std::array::from_fn(|place| f64x8::splat(f64::from(bits >> place & 1)));
            let wanted = f64::from(u8::from(bits.count_ones() > 3));
            assert_eq!(median_of_window(values).to_array(), [wanted; LANES], "{bits:07b}");
        }
    }

    #[test]
    fn eight_at_once_are_judged_as_one_by_one() {
        let wave = |i: usize| Some((0.2 * i as f64).sin() + 0.3 * (7.0 * (i * i) as f64).sin());
        let series: Vec<Option<f64>> = (0..90).map(|i| wave(i).filter(|_| i != 40 && i != 41)).collect();
        let one_by_one: Vec<_> = (0..series.len()).map(|sample| deviation_and_scale(&series, sample)).collect();
        assert_eq!(judged(&series), one_by_one);
    }
}
