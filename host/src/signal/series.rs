//! A series through outlier rejection, gap filling and a filter.

use super::gaps::pieces;
use super::options::{FilterKind, FilterOptions};
use super::{butterworth, gaps, gaussian, gcv_spline, hampel, loess, median};
use crate::cyclic::turns::unwrap_along_time;
use crate::error::Result;

/// `series`, evenly sampled at `rate_hz`, without outliers and smoothed. `None` is a missing value.
///
/// Gaps up to the gap limit are filled. A longer gap stays, and so do those at both ends; what lies
/// between two of them is filtered on its own.
///
/// # Errors
/// Options that a series of this rate cannot have; see [`FilterOptions::check`].
pub fn filtered(series: &[Option<f64>], rate_hz: f64, options: &FilterOptions) -> Result<Vec<Option<f64>>> {
    options.check(rate_hz)?;
    let mut series: Vec<Option<f64>> = series.iter().map(|value| value.filter(|value| value.is_finite())).collect();
    if options.hampel {
        hampel::reject(&mut series);
    }
    let longest = gaps::longest_filled(options.gap_limit_s, rate_hz);
    let mut result = vec![None; series.len()];
    for piece in pieces(&series, longest) {
        let filled = gaps::filled(&series[piece.clone()]);
        let smooth = smoothed(&filled, rate_hz, options.filter);
        for (place, value) in result[piece].iter_mut().zip(smooth) {
            *place = Some(value);
        }
    }
    Ok(result)
}

/// As [`filtered`] for angles in radians. Whole turns are added first, so that no step from pi to
/// minus pi is smoothed, and stay in the result.
///
/// # Errors
/// As [`filtered`].
pub fn filtered_angles(angles_rad: &[Option<f64>], rate_hz: f64, options: &FilterOptions) -> Result<Vec<Option<f64>>> {
    let mut angles_rad = angles_rad.to_vec();
    unwrap_along_time(&mut angles_rad);
    filtered(&angles_rad, rate_hz, options)
}

fn smoothed(values: &[f64], rate_hz: f64, filter: FilterKind) -> Vec<f64> {
    match filter {
        FilterKind::Butterworth { cutoff_hz, order } => butterworth::smoothed(values, cutoff_hz / rate_hz, order),
        FilterKind::Gaussian { cutoff_hz } => gaussian::smoothed(values, cutoff_hz / rate_hz),
        FilterKind::Median { window_s } => median::smoothed(values, window_s * rate_hz),
        FilterKind::Loess { cutoff_hz } => loess::smoothed(values, cutoff_hz / rate_hz),
        FilterKind::GcvSpline => gcv_spline::smoothed(values).values,
        FilterKind::None => values.to_vec(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::turns::wrapped;
    use proptest::prelude::*;

    const KINDS: [FilterKind; 6] = [
        FilterKind::BUTTERWORTH,
        FilterKind::GAUSSIAN,
        FilterKind::MEDIAN,
        FilterKind::LOESS,
        FilterKind::GcvSpline,
        FilterKind::None,
    ];

    fn with(filter: FilterKind) -> FilterOptions {
        FilterOptions { filter, ..FilterOptions::default() }
    }

    /// A swing at 1 Hz, 30 samples a second.
    fn swing(sample: usize) -> f64 {
        20.0 * (std::f64::consts::TAU * sample as f64 / 30.0).sin()
    }

    #[test]
    fn short_gaps_are_filled_and_long_ones_split() {
        let gap = |sample: usize| sample < 2 || (20..26).contains(&sample) || (60..67).contains(&sample);
        let series: Vec<Option<f64>> = (0..100).map(|sample| (!gap(sample)).then(|| swing(sample))).collect();
        for kind in KINDS {
            let smooth = filtered(&series, 30.0, &with(kind)).unwrap();
            for (sample, value) in smooth.iter().enumerate() {
                assert_eq!(value.is_none(), sample < 2 || (60..67).contains(&sample), "{kind:?}: {sample}");
                let off = value.map_or(0.0, |value| (value - swing(sample)).abs());
                assert!(off < 1.5, "{kind:?}: {sample} is {off} off");
            }
        }
    }

    #[test]
    fn a_spike_leaves_no_trace() {
        let mut series: Vec<Option<f64>> = (0..90).map(|sample| Some(swing(sample))).collect();
        series[44] = Some(90.0);
        for kind in KINDS {
            let smooth = filtered(&series, 30.0, &with(kind)).unwrap();
            assert!((smooth[44].unwrap() - swing(44)).abs() < 1.0, "{kind:?}: {:?}", smooth[44]);
        }
        let kept = FilterOptions { hampel: false, filter: FilterKind::None, ..FilterOptions::default() };
        assert_eq!(filtered(&series, 30.0, &kept).unwrap(), series);
    }

    #[test]
    fn angles_wind_through_pi() {
        let series: Vec<Option<f64>> = (0..80).map(|sample| Some(wrapped(0.2 * f64::from(sample)))).collect();
        for kind in KINDS {
            let smooth = filtered_angles(&series, 60.0, &with(kind)).unwrap();
            for (sample, value) in smooth.iter().enumerate() {
                assert!((value.unwrap() - 0.2 * sample as f64).abs() < 0.01, "{kind:?}: {sample}");
            }
        }
    }

    proptest! {
        #[test]
        fn any_series_gives_finite_values_as_long_as_it_is(
            series in prop::collection::vec(prop::option::weighted(0.8, -1.0e6..1.0e6_f64), 0..60),
            kind in 0..KINDS.len(),
            rate_hz in 14.0..300.0_f64,
        ) {
            let smooth = filtered(&series, rate_hz, &with(KINDS[kind])).unwrap();
            prop_assert_eq!(smooth.len(), series.len());
            prop_assert!(smooth.iter().flatten().all(|value| value.is_finite()));
        }
    }
}
