//! Cuts that hold several cycles: where a tempo changes in steps, the recording resembles itself
//! best at a common multiple of its periods.

use super::channels::Channels;
use super::period::NEARLY;

/// How far the correlation falls before it rises to a period: the flank of the peak at zero has
/// peaks of noise. Chosen: what a period may be worse than the best.
const LEAST_FALL: f64 = 1.0 - NEARLY;
/// By how much a cut may be longer than both of its neighbours once others were split. Chosen: a
/// cycle is a quarter longer at most ([`super::recurrence`]), so two of them are.
const LONGEST_SHARE: f64 = 1.5;

/// Splits cuts into the cycles that they hold, each of at least `shortest` frames. One in which the
/// tempo changes cannot be split, and is left out beside those that are.
#[must_use]
pub fn split(channels: &Channels, cuts: &[[usize; 2]], shortest: usize) -> Vec<[usize; 2]> {
    let parts: Vec<Vec<[usize; 2]>> = cuts.iter().map(|&cut| cycles_in(channels, cut, shortest)).collect();
    if parts.iter().all(|parts| parts.len() == 1) {
        return cuts.to_vec();
    }
    let length = |cut: &[usize; 2]| (cut[1] - cut[0]) as f64;
    let is_whole = |index: usize| {
        let [before, after] = [index.checked_sub(1), Some(index + 1)].map(|other| parts.get(other?));
        let neighbours = [before.and_then(|parts| parts.last()), after.and_then(|parts| parts.first())];
        let longest = neighbours.into_iter().flatten().map(length).fold(0.0, f64::max);
        parts[index].len() > 1 || longest == 0.0 || length(&parts[index][0]) <= LONGEST_SHARE * longest
    };
    (0..parts.len()).filter(|&index| is_whole(index)).flat_map(|index| parts[index].iter().copied()).collect()
}

/// The cycles of one cut, of the same length. Most cuts are one.
fn cycles_in(channels: &Channels, [start, end]: [usize; 2], shortest: usize) -> Vec<[usize; 2]> {
    let frames = end - start;
    let at = |lag: usize| channels.correlation(start..end - lag, lag).unwrap_or(-1.0);
    let correlations: Vec<f64> = (shortest - 1..=2 * frames / 3).map(at).collect();
    let mut least = f64::INFINITY;
    let period = correlations.windows(3).enumerate().find_map(|(index, around)| {
        least = least.min(around[0]);
        let is_peak = around[1] > around[0] && around[1] >= around[2];
        (is_peak && around[1] >= NEARLY && around[1] - least >= LEAST_FALL).then_some(shortest + index)
    });
    let count = period.map_or(1, |period| (frames as f64 / period as f64).round() as usize);
    (0..count).map(|index| [start + index * frames / count, start + (index + 1) * frames / count]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::angle_table::{ANGLES, AngleTable};
    use std::f64::consts::TAU;

    /// Limbs of all phases, `cycles` of a moment in cycles from the start.
    fn channels(cycles: impl Fn(usize) -> f64, frames: usize) -> Channels {
        let row = |frame: usize| {
            std::array::from_fn::<_, ANGLES, _>(|angle| {
                let phase = TAU * (cycles(frame) + 0.37 * angle as f64);
                Some(1.5 + 0.4 * phase.sin() + 0.15 * (2.0 * phase).sin())
            })
        };
        let table = AngleTable::from_angles(0, &(0..frames).map(row).collect::<Vec<_>>()).unwrap();
        Channels::of(&table).unwrap()
    }

    #[test]
    fn cuts_of_three_and_five_cycles_are_split_and_one_of_both_is_left_out() {
        // Periods of 40 frames up to frame 280, of 24 from there on.
        let cycles = |frame: usize| frame.min(280) as f64 / 40.0 + frame.saturating_sub(280) as f64 / 24.0;
        let split = split(&channels(cycles, 720), &[[0, 120], [120, 240], [240, 360], [360, 480], [480, 600]], 12);
        let lengths: Vec<usize> = split.iter().map(|cut| cut[1] - cut[0]).collect();
        assert_eq!(lengths, [vec![40; 6], vec![24; 10]].concat());
    }

    #[test]
    fn cuts_of_one_cycle_stay() {
        let cuts = [[0, 60], [60, 120], [120, 180]];
        assert_eq!(split(&channels(|frame| frame as f64 / 60.0, 240), &cuts, 12), cuts);
    }
}
