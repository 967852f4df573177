//! Outlier rejection by Hampel's identifier: a value is compared with the median of its window.

use super::median::{STD_PER_MEDIAN, median};

/// Samples on each side of a window of seven. Source: the default of MATLAB's `hampel`; Pose2Sim
/// and Sports2D have the same window.
const HALF_WINDOW: usize = 3;
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
    let judged: Vec<Option<[f64; 2]>> = (0..series.len()).map(|sample| deviation_and_scale(series, sample)).collect();
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

/// How far a value is from the median of its window, and the window's scale; `None` where there is
/// no value or the window has too few.
fn deviation_and_scale(series: &[Option<f64>], sample: usize) -> Option<[f64; 2]> {
    let value = series[sample]?;
    let window = &series[sample.saturating_sub(HALF_WINDOW)..(sample + HALF_WINDOW + 1).min(series.len())];
    let mut places = [0.0; 2 * HALF_WINDOW + 1];
    let count = places.iter_mut().zip(window.iter().flatten()).map(|(place, value)| *place = *value).count();
    if count < MIN_VALUES {
        return None;
    }
    let values = &mut places[..count];
    let middle = median(values)?;
    values.iter_mut().for_each(|value| *value = (*value - middle).abs());
    Some([(value - middle).abs(), STD_PER_MEDIAN * median(values)?])
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
}
