//! Where cycles begin: the first by the swing of a limb, each next by the return of the whole pose.

use super::alignment::{align, median};
use super::channels::Channels;
use crate::cyclic::angle_table::AngleTable;
use std::f64::consts::TAU;

/// Angles whose swing gives the first start, best first: left and right thigh, left and right upper
/// arm, shanks, forearms, trunk.
const ANCHORS: [usize; 9] = [8, 11, 2, 5, 9, 12, 3, 6, 0];
/// Share of the frames in which the anchor has to be there.
const MIN_SHARE: f64 = 0.6;
/// How much shorter or longer than the period a cycle may be.
const STRETCH: f64 = 0.25;
/// Smallest correlation of the pose round a start with that round the next.
const MIN_RETURN: f64 = 0.5;

/// Start and end of each cycle, frames from the table's first.
#[must_use]
pub fn boundaries(table: &AngleTable, channels: &Channels, period: usize) -> Vec<[usize; 2]> {
    let peaks = swing_peaks(table, channels.len(), period);
    let mut starts: Vec<usize> = Vec::new();
    // Whether a cycle leads to the start of this index from the one before.
    let mut follows: Vec<bool> = Vec::new();
    let mut next_start = 0;
    for &peak in &peaks {
        if peak < next_start {
            continue;
        }
        let mut at = peak;
        while let Some(end) = next(channels, at, period) {
            if at == peak {
                starts.push(at);
                follows.push(false);
            }
            starts.push(end);
            follows.push(true);
            at = end;
        }
        // After a break the next peak is tried, not less than half a period on.
        next_start = at + period / 2;
    }
    align(channels, &mut starts, period);
    let shift = to_peaks(&starts, &peaks, period);
    let moved = |start: usize| start.checked_add_signed(shift).filter(|&start| start <= channels.len());
    let cycle = |(pair, follows): (&[usize], &bool)| follows.then_some([moved(pair[0])?, moved(pair[1])?]);
    starts.windows(2).zip(follows.iter().skip(1)).filter_map(cycle).collect()
}

/// By how many frames the swing's peaks lie later than the starts. It is the middle one of all, so
/// that no single step decides where a person's cycles begin.
fn to_peaks(starts: &[usize], peaks: &[usize], period: usize) -> isize {
    let from_start = |&start: &usize| {
        let distances = peaks.iter().map(|&peak| peak as i64 - start as i64);
        distances.min_by_key(|distance| distance.abs()).filter(|distance| 4 * distance.abs() <= period as i64)
    };
    median(starts.iter().filter_map(from_start).collect()) as isize
}

/// Where the pose round `start` comes back.
fn next(channels: &Channels, start: usize, period: usize) -> Option<usize> {
    let half = period / 2;
    let slack = ((STRETCH * period as f64) as usize).max(1);
    let mut best: Option<(usize, f64)> = None;
    for lag in period - slack..=period + slack {
        // The end is the frame after the last one, so it may lie at the end of the recording.
        if start + lag > channels.len() {
            break;
        }
        let window = start.saturating_sub(half)..(start + half + 1).min(channels.len() - lag);
        if window.len() < half {
            continue;
        }
        if let Some(difference) = channels.difference(window, lag)
            && best.is_none_or(|(_, least)| difference < least)
        {
            best = Some((lag, difference));
        }
    }
    let (lag, _) = best?;
    if start + lag == channels.len() && lag < period + slack {
        // The recording ends before it is known where the pose is nearest.
        return None;
    }
    let window = start.saturating_sub(half)..(start + half + 1).min(channels.len() - lag);
    (channels.correlation(window, lag)? > MIN_RETURN).then_some(start + lag)
}

/// Peaks of a limb's swing at the motion's period, frames from the first.
fn swing_peaks(table: &AngleTable, frames: usize, period: usize) -> Vec<usize> {
    let signal = |angle: usize| -> Vec<Option<f64>> {
        let mut signal = vec![None; frames];
        for row in table.rows() {
            // A thigh is farthest forward where its angle is least: x is forward and y down.
            signal[(row.frame - table.first_frame()) as usize] =
                row.angles_rad[angle].map(|angle| -angle.sin().atan2(angle.cos()));
        }
        signal
    };
    let share = |signal: &[Option<f64>]| signal.iter().flatten().count() as f64 / frames as f64;
    let chosen = ANCHORS.into_iter().map(signal).find(|signal| share(signal) >= MIN_SHARE);
    let chosen = chosen.unwrap_or_else(|| {
        let all = ANCHORS.into_iter().map(signal);
        all.max_by(|a, b| share(a).total_cmp(&share(b))).unwrap_or_default()
    });
    peaks(&fundamental(&chosen, period))
}

/// The part of `signal` that has the period, by projection on cosine and sine over one period round
/// each frame.
fn fundamental(signal: &[Option<f64>], period: usize) -> Vec<f64> {
    let half = period / 2;
    (0..signal.len())
        .map(|frame| {
            let window = frame.saturating_sub(half)..(frame + half + 1).min(signal.len());
            let known: Vec<(f64, f64)> = window
                .filter_map(|other| Some((TAU * (other as f64 - frame as f64) / period as f64, signal[other]?)))
                .collect();
            let count = known.len().max(1) as f64;
            let mean = known.iter().map(|(_, value)| value).sum::<f64>() / count;
            known.iter().map(|(phase, value)| (value - mean) * phase.cos()).sum::<f64>() * 2.0 / count
        })
        .collect()
}

fn peaks(signal: &[f64]) -> Vec<usize> {
    let is_peak = |&frame: &usize| {
        let before = frame.checked_sub(1).map_or(f64::NEG_INFINITY, |before| signal[before]);
        let after = signal.get(frame + 1).copied().unwrap_or(f64::NEG_INFINITY);
        signal[frame] > 0.0 && signal[frame] > before && signal[frame] >= after && frame > 0 && frame + 1 < signal.len()
    };
    (0..signal.len()).filter(is_peak).collect()
}
