//! Turning points of a smooth series, and where its slope reaches a level.

use crate::signal::gaps::pieces;

/// Where `series` is largest, samples from its start, between samples by a parabola through three.
///
/// A maximum counts if the series falls by `min_prominence` on both sides before it rises above it
/// or ends. Nothing is found over missing values.
pub fn maxima(series: &[Option<f64>], min_prominence: f64) -> Vec<f64> {
    let mut found = Vec::new();
    for piece in pieces(series, 0) {
        let values: Vec<f64> = series[piece.clone()].iter().flatten().copied().collect();
        for sample in 1..values.len().saturating_sub(1) {
            let [before, here, after] = [values[sample - 1], values[sample], values[sample + 1]];
            if before < here && here >= after && prominence(&values, sample) >= min_prominence {
                let bend = before - 2.0 * here + after;
                let shift = if bend < 0.0 { 0.5 * (before - after) / bend } else { 0.0 };
                found.push((piece.start + sample) as f64 + shift);
            }
        }
    }
    found
}

/// How far the series falls on the side where it falls less, before it is higher than at `sample`.
fn prominence(values: &[f64], sample: usize) -> f64 {
    let here = values[sample];
    let fall = |side: &mut dyn Iterator<Item = &f64>| {
        let lowest = side.take_while(|value| **value <= here).fold(here, |lowest, value| lowest.min(*value));
        here - lowest
    };
    fall(&mut values[..sample].iter().rev()).min(fall(&mut values[sample + 1..].iter()))
}

/// Change of `series` a sample at `sample`, from the samples beside it.
pub fn slope(series: &[Option<f64>], sample: usize) -> Option<f64> {
    let (before, after) = (series[sample.checked_sub(1)?]?, (*series.get(sample + 1)?)?);
    Some(0.5 * (after - before))
}

/// Which way from a moment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// Later.
    Later,
    /// Earlier.
    Earlier,
}

/// The first moment from `moment` on at which the slope is `level` or less, within `limit` samples;
/// `None` where it is not reached, or values are missing on the way.
pub fn slope_reaches(series: &[Option<f64>], moment: f64, level: f64, way: Way, limit: f64) -> Option<f64> {
    let (start, step) = match way {
        Way::Later => (moment.floor(), 1.0),
        Way::Earlier => (moment.ceil(), -1.0),
    };
    let mut place = start;
    let mut last = slope(series, start as usize)?;
    while (place - moment).abs() <= limit && place >= 1.0 {
        place += step;
        let here = slope(series, place as usize)?;
        if here <= level {
            let share = if last > level { (last - level) / (last - here) } else { 0.0 };
            return Some(place - step + step * share);
        }
        last = here;
    }
    None
}

/// Value at a moment between samples, on the straight line; `None` where one beside it is missing.
pub fn value_at(series: &[Option<f64>], moment: f64) -> Option<f64> {
    let below = moment.floor();
    let share = moment - below;
    let here = (*series.get(below as usize)?)?;
    if share < 1.0e-9 {
        return Some(here);
    }
    Some(here + share * ((*series.get(below as usize + 1)?)? - here))
}

/// Whether there is a value in every sample from one moment to the next.
pub fn is_whole(series: &[Option<f64>], from: f64, to: f64) -> bool {
    let range = from.floor().max(0.0) as usize..=to.ceil() as usize;
    series.get(range).is_some_and(|samples| samples.iter().all(Option::is_some))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn wave(count: usize) -> Vec<Option<f64>> {
        (0..count).map(|i| Some((TAU * (i as f64 - 7.3) / 40.0).cos())).collect()
    }

    #[test]
    fn maxima_lie_between_samples_and_not_at_the_ends_or_gaps() {
        let mut series = wave(130);
        let found = maxima(&series, 0.5);
        assert_eq!(found.len(), 3, "{found:?}");
        for (found, wanted) in found.iter().zip([7.3, 47.3, 87.3]) {
            assert!((found - wanted).abs() < 0.01, "{found}");
        }
        series[86] = None;
        assert_eq!(maxima(&series, 0.5).len(), 2, "none beside a gap");
        let ripple: Vec<Option<f64>> = (0..60).map(|i| Some(0.1 * f64::from(i % 2))).collect();
        assert!(maxima(&ripple, 0.2).is_empty());
    }

    #[test]
    fn slopes_are_reached_on_both_sides() {
        let series = wave(100);
        // Slope of the cosine: -TAU / 40 sin; half of the steepest 1/12 of a cycle from the top.
        let level = -0.5 * TAU / 40.0;
        let later = slope_reaches(&series, 47.3, level, Way::Later, 10.0).unwrap();
        assert!((later - (47.3 + 40.0 / 12.0)).abs() < 0.05, "{later}");
        let earlier = slope_reaches(&series, 67.3, level, Way::Earlier, 10.0).unwrap();
        assert!((earlier - (67.3 - 40.0 / 12.0)).abs() < 0.05, "{earlier}");
        assert_eq!(slope_reaches(&series, 47.3, -9.0, Way::Later, 10.0), None);
        assert!(is_whole(&series, 3.2, 98.5) && !is_whole(&series, 3.2, 99.5));
    }
}
