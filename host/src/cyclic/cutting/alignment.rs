//! Brings the starts of all cycles of a recording to one phase.
//!
//! Each start was found from the one before, so that small errors add up over a long recording.
//! Here every start is compared with the mean motion round all of them, which none of them can
//! drift away from.

use super::channels::Channels;
use std::ops::Range;

/// Times that the mean motion is made anew.
const ROUNDS: usize = 4;
/// How far a start is moved in a round, as a fraction of the period.
const REACH: f64 = 0.125;
/// Smallest share of the mean motion's values that have to be there to be compared with.
const MIN_SHARE: f64 = 0.25;

/// Moves each of `starts` (frames, rising) to where the motion of a period round it is nearest to
/// the mean of all. They stay apart by at least half a period. All of them together stay where they
/// are on the mean.
pub fn align(channels: &Channels, starts: &mut [usize], period: usize) {
    for _ in 0..ROUNDS {
        let template = Template::of(channels, starts, period);
        let shifts: Vec<i64> = starts.iter().map(|&start| template.best_shift(channels, start, period)).collect();
        let common = median(shifts.clone());
        if shifts.iter().all(|&shift| shift == common) {
            break;
        }
        let moved = |start: usize, shift: i64| start.saturating_add_signed((shift - common) as isize);
        for (index, shift) in shifts.into_iter().enumerate() {
            let earliest = index.checked_sub(1).map_or(0, |before| starts[before] + period / 2);
            let latest = starts.get(index + 1).map_or(channels.len(), |after| after.saturating_sub(period / 2));
            let wanted = moved(starts[index], shift);
            if (earliest..=latest).contains(&wanted) {
                starts[index] = wanted;
            }
        }
    }
}

/// The middle one of `values`, the later of two; 0 of none.
#[must_use]
pub fn median(mut values: Vec<i64>) -> i64 {
    values.sort_unstable();
    values.get(values.len() / 2).copied().unwrap_or(0)
}

/// Mean motion of a period, round its middle.
struct Template {
    /// For each signal, the mean of each frame of the window; NaN where it is never there.
    means: Vec<Vec<f64>>,
}

impl Template {
    fn of(channels: &Channels, starts: &[usize], period: usize) -> Self {
        let mean = |signal: &Vec<f64>, offset: usize| {
            let at = |start: &usize| signal.get((start + offset).checked_sub(period / 2)?).copied();
            let known: Vec<f64> = starts.iter().filter_map(at).filter(|value| !value.is_nan()).collect();
            if known.is_empty() { f64::NAN } else { known.iter().sum::<f64>() / known.len() as f64 }
        };
        let means = channels.signals().iter().map(|signal| (0..period).map(|offset| mean(signal, offset)).collect());
        Self { means: means.collect() }
    }

    /// By how many frames the motion round `start` comes later than the mean.
    fn best_shift(&self, channels: &Channels, start: usize, period: usize) -> i64 {
        let reach = ((REACH * period as f64) as i64).max(1);
        let known = self.means.iter().flatten().filter(|value| !value.is_nan()).count();
        let least = (MIN_SHARE * known as f64).max(1.0) as usize;
        let candidates = (-reach..=reach).filter_map(|shift| {
            let (difference, count) = self.difference(channels, start as i64 + shift - (period / 2) as i64);
            (count >= least).then_some((shift, difference / count as f64))
        });
        candidates.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |best| best.0)
    }

    /// Sum of squared differences from the window that begins at frame `from`, and how many there
    /// are.
    fn difference(&self, channels: &Channels, from: i64) -> (f64, usize) {
        let (mut sum, mut count) = (0.0, 0);
        for (signal, mean) in channels.signals().iter().zip(&self.means) {
            let window: Range<i64> = from.max(0)..(from + mean.len() as i64).min(signal.len() as i64);
            for frame in window {
                let square = (signal[frame as usize] - mean[(frame - from) as usize]).powi(2);
                if !square.is_nan() {
                    sum += square;
                    count += 1;
                }
            }
        }
        (sum, count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::angle_table::{ANGLES, AngleTable};
    use std::f64::consts::TAU;

    #[test]
    fn starts_that_drift_come_back_to_one_phase() {
        let period = 60_usize;
        let row = |frame: usize| {
            std::array::from_fn::<_, ANGLES, _>(|angle| {
                let phase = TAU * (frame as f64 / period as f64 + 0.07 * angle as f64);
                Some(1.5 + 0.4 * phase.sin() + 0.1 * (2.0 * phase).cos())
            })
        };
        let table = AngleTable::from_angles(0, &(0..700).map(row).collect::<Vec<_>>()).unwrap();
        let channels = Channels::of(&table).unwrap().over_period(period);
        let mut starts: Vec<usize> = (0..10).map(|index| 40 + 61 * index + index % 3).collect();
        align(&channels, &mut starts, period);
        let phases: Vec<usize> = starts.iter().map(|start| start % period).collect();
        let (least, most) = (phases.iter().min().unwrap(), phases.iter().max().unwrap());
        assert!(most - least <= 1, "{starts:?}");
        assert!((44..=48).contains(least), "their mean stays: {starts:?}");
    }
}
