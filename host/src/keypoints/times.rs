//! From the times of rows to frames and their rate.

use super::layout::{DetectedFrame, Keypoint};

/// Share of the smallest steps that are left out when the step between frames is looked for.
/// Chosen: less than jitter spoils, more than single wrong times.
const LOW_QUANTILE: f64 = 0.1;
/// How far a step may be from a whole number of frames, in frames. Chosen: a phone's variable rate
/// is more than that.
const MAX_OFF_FRAMES: f64 = 0.2;
/// As above, for times that are rounded to [`ROUNDINGS_S`]: 60 frames a second in two decimals are
/// 0.6 off.
const MAX_OFF_ROUNDED_FRAMES: f64 = 0.7;
/// Times may be rounded to these, seconds.
const ROUNDINGS_S: [f64; 3] = [0.1, 0.01, 0.001];
/// Frames that are left out may make the median step this many times the step between frames.
const MAX_MEDIAN_STEPS: f64 = 2.5;
/// Share of the steps that have to be whole. Chosen: a recording may stall now and then.
const MIN_WHOLE_SHARE: f64 = 0.95;
/// How far a row's time may be from where an even rate puts it, frames: a row belongs to the frame
/// whose time is nearest.
const MAX_OFF_LINE_FRAMES: f64 = 0.5;
/// Longest step that is filled where frames come at uneven times, in median steps (the issue's
/// 2.5).
const MAX_FILLED_STEPS: f64 = 2.5;
/// A rate this near to a whole number, as a share of it, is that number: times are rounded. 29.97
/// is farther from 30.
const WHOLE_RATE: f64 = 5.0e-4;
/// Most frames that times may spread over. Chosen: a day at 120 frames a second is 1e7.
const MAX_FRAMES: f64 = 1.0e8;

/// When frames were taken.
#[derive(Debug, Clone, PartialEq)]
pub struct Timing {
    /// Frames per second.
    pub rate_hz: f64,
    /// Number of each row's frame, from 0.
    pub frames: Vec<u64>,
    /// Times lie on the frames; if not, they come at uneven steps.
    pub is_even: bool,
}

/// Finds the rate and the frame of each time, in seconds. `None` for less than two times, times
/// that do not rise, and times so far apart that they cannot be one recording's.
#[must_use]
pub fn timing(times_s: &[f64]) -> Option<Timing> {
    let steps: Vec<f64> = times_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if steps.is_empty() || steps.iter().any(|step| *step <= 0.0) {
        return None;
    }
    let mut sorted = steps.clone();
    sorted.sort_by(f64::total_cmp);
    let at = |share: f64| sorted[((sorted.len() - 1) as f64 * share) as usize];
    let [low, median] = [LOW_QUANTILE, 0.5].map(at);
    if steps.iter().sum::<f64>() / low > MAX_FRAMES {
        return None;
    }
    let is_rounded = |to: &&f64| times_s.iter().all(|time| (time / **to - (time / **to).round()).abs() < 1.0e-6);
    let rounding_s = ROUNDINGS_S.iter().find(is_rounded).copied().unwrap_or(0.0);
    for base in [Some(median), Some(low).filter(|low| *low >= median / MAX_MEDIAN_STEPS)].into_iter().flatten() {
        // The second pass counts long gaps with the refined step.
        let step = (0..2).fold(base, |step, _| {
            steps.iter().sum::<f64>() / steps.iter().map(|length| counted(*length, step)).sum::<f64>()
        });
        let max_off = (1.01 * rounding_s / step).clamp(MAX_OFF_FRAMES, MAX_OFF_ROUNDED_FRAMES);
        let is_whole = |length: &&f64| (**length / step - counted(**length, step)).abs() <= max_off;
        if steps.iter().filter(is_whole).count() as f64 >= MIN_WHOLE_SHARE * steps.len() as f64 {
            let mut frame = 0;
            let rest = steps.iter().map(|length| {
                frame += counted(*length, step) as u64;
                frame
            });
            let frames: Vec<u64> = std::iter::once(0).chain(rest).collect();
            if max_off_line_s(&frames, times_s) <= MAX_OFF_LINE_FRAMES * step {
                return Some(Timing { rate_hz: rounded(1.0 / step), frames, is_even: true });
            }
        }
    }
    let short: Vec<f64> = steps.into_iter().filter(|step| *step <= MAX_FILLED_STEPS * median).collect();
    let step = short.iter().sum::<f64>() / short.len() as f64;
    let frames = times_s.iter().map(|time| ((time - times_s[0]) / step).round() as u64).collect();
    Some(Timing { rate_hz: rounded(1.0 / step), frames, is_even: false })
}

/// The farthest that a time is from the line through the times of all frames (least squares),
/// seconds. Steps that are whole one by one may still run away from it: the rate changes.
fn max_off_line_s(frames: &[u64], times_s: &[f64]) -> f64 {
    let count = times_s.len() as f64;
    let mean_frame = frames.iter().map(|frame| *frame as f64).sum::<f64>() / count;
    let mean_s = times_s.iter().sum::<f64>() / count;
    let pairs = || frames.iter().zip(times_s).map(|(frame, time)| (*frame as f64 - mean_frame, time - mean_s));
    let step_s =
        pairs().map(|(frame, time)| frame * time).sum::<f64>() / pairs().map(|(frame, _)| frame * frame).sum::<f64>();
    pairs().map(|(frame, time)| (time - step_s * frame).abs()).fold(0.0, f64::max)
}

/// Frames in a step: at least one.
fn counted(length: f64, step: f64) -> f64 {
    (length / step).round().max(1.0)
}

fn rounded(rate_hz: f64) -> f64 {
    let whole = rate_hz.round();
    if (rate_hz - whole).abs() < WHOLE_RATE * rate_hz { whole } else { rate_hz }
}

/// The rate of frames that have both numbers and times, if these agree: `None` where times run
/// away from numbers by more than a quarter of a frame in more than 5 % of them.
#[must_use]
pub fn rate_of_numbers(frames: &[u64], times_s: &[f64]) -> Option<f64> {
    let (first, last) = (frames.first()?, frames.last()?);
    let span_s = times_s.last()? - times_s.first()?;
    if last == first || span_s <= 0.0 {
        return None;
    }
    let rate_hz = (last - first) as f64 / span_s;
    let is_near =
        |(frame, time): &(&u64, &f64)| (((**frame - first) as f64) - (**time - times_s[0]) * rate_hz).abs() <= 0.25;
    let near = frames.iter().zip(times_s).filter(is_near).count();
    (near as f64 >= MIN_WHOLE_SHARE * frames.len() as f64).then(|| rounded(rate_hz))
}

/// Frames at even times between those of `uneven`, by straight lines over steps of up to 2.5
/// median steps. Of people only those are taken whose places in both lists are the same.
#[must_use]
pub fn evened(uneven: &[DetectedFrame], times_s: &[f64], rate_hz: f64) -> Vec<DetectedFrame> {
    let Some(&start_s) = times_s.first() else { return Vec::new() };
    let mut even: Vec<DetectedFrame> = Vec::new();
    for (pair, times) in uneven.windows(2).zip(times_s.windows(2)) {
        let [from, to] = [0, 1].map(|end| (times[end] - start_s) * rate_hz);
        let numbers = from.ceil() as u64..=to.floor() as u64;
        if to - from <= MAX_FILLED_STEPS {
            let next = even.last().map_or(0, |last| last.frame + 1);
            for frame in numbers.filter(|frame| *frame >= next) {
                let share = ((frame as f64 - from) / (to - from)).clamp(0.0, 1.0);
                let people = pair[0].people.iter().zip(&pair[1].people).map(|(a, b)| between(a, b, share)).collect();
                even.push(DetectedFrame { frame, people });
            }
        }
    }
    even
}

fn between(before: &[Keypoint], after: &[Keypoint], share: f64) -> Vec<Keypoint> {
    let mixed = |a: f64, b: f64| a + share * (b - a);
    before
        .iter()
        .filter_map(|a| {
            let b = after.iter().find(|b| b.part == a.part)?;
            Some(Keypoint {
                part: a.part,
                position_px: [0, 1].map(|axis| mixed(a.position_px[axis], b.position_px[axis])),
                confidence: a.confidence.min(b.confidence),
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keypoints::layout::Part;

    #[test]
    fn rows_that_were_dropped_are_missing_frames() {
        // Every third frame of 30 a second is not there; four decimals.
        let kept: Vec<u64> = (0..180).filter(|frame| frame % 3 != 0).collect();
        let times: Vec<f64> = kept.iter().map(|frame| (*frame as f64 / 30.0 * 1.0e4).round() / 1.0e4).collect();
        let found = timing(&times).unwrap();
        assert!(found.is_even && (found.rate_hz - 30.0).abs() < 1.0e-9, "{}", found.rate_hz);
        assert!(kept.iter().zip(&found.frames).all(|(kept, found)| *kept == found + 1));
    }

    #[test]
    fn rounded_times_do_not_drift() {
        for (rate, decimals) in [(30.0, 1.0e2), (60.0, 1.0e2), (29.97, 1.0e3), (120.0, 1.0e3), (12.5, 1.0e2)] {
            let times: Vec<f64> =
                (0..2000).map(|frame| (f64::from(frame) / rate * decimals).round() / decimals).collect();
            let found = timing(&times).unwrap();
            assert!(found.is_even && found.frames.iter().copied().eq(0..2000), "{rate}");
            assert!((found.rate_hz / rate - 1.0).abs() < 1.0e-3, "{rate}: {}", found.rate_hz);
        }
    }

    #[test]
    fn uneven_times_are_filled_to_even_frames() {
        let times: Vec<f64> =
            (0..90).map(|i: i32| f64::from(i) / 30.0 + 0.012 * f64::from(i * 7 % 5 - 2) / 2.0).collect();
        let found = timing(&times).unwrap();
        assert!(!found.is_even);
        let frame = |time: &f64| DetectedFrame {
            frame: 0,
            people: vec![vec![Keypoint { part: Part::Nose, position_px: [100.0 * time, 5.0], confidence: 1.0 }]],
        };
        let uneven: Vec<DetectedFrame> = times.iter().map(frame).collect();
        let even = evened(&uneven, &times, found.rate_hz);
        assert!(even.len() > 80 && even.windows(2).all(|pair| pair[0].frame < pair[1].frame));
        for frame in &even {
            let wanted = 100.0 * (times[0] + frame.frame as f64 / found.rate_hz);
            assert!((frame.people[0][0].position_px[0] - wanted).abs() < 1.0e-9);
        }
    }

    /// Steps of 22, 33 and 47 ms are no multiples of a common one.
    #[test]
    fn a_variable_rate_is_not_taken_for_left_out_frames() {
        let mut time_s = 0.0;
        let times: Vec<f64> = (0..120)
            .map(|row: usize| {
                time_s += [0.022, 0.033, 0.033, 0.047][row * 7 % 11 % 4];
                time_s
            })
            .collect();
        let found = timing(&times).unwrap();
        assert!(!found.is_even && (found.rate_hz - 31.0).abs() < 3.0, "{found:?}");
    }

    /// Steps that are whole one by one: the rate changes half way, drifts, or a step is off once.
    #[test]
    fn a_rate_that_changes_on_the_way_is_uneven() {
        let of_steps = |steps: &[f64]| {
            let mut time_s = 7.0;
            let rest = steps.iter().map(|step| {
                time_s += step;
                time_s
            });
            timing(&[7.0].into_iter().chain(rest).collect::<Vec<f64>>()).unwrap()
        };
        let two = |first: f64, then: f64| [vec![1.0 / first; 135], vec![1.0 / then; 120]].concat();
        for (first, then) in [(30.0, 28.0), (30.0, 24.0), (60.0, 50.0)] {
            assert!(!of_steps(&two(first, then)).is_even, "{first} to {then}");
        }
        let drifting: Vec<f64> = (0..265).map(|row| 1.0 / (33.0 - 6.0 * f64::from(row) / 264.0)).collect();
        assert!(!of_steps(&drifting).is_even);
        // Jitter within half a frame, and one frame that came late for good.
        let jitter: Vec<f64> = (0..300).map(|row: i32| (1.0 + 0.08 * f64::from(row * 7 % 5 - 2)) / 30.0).collect();
        let late: Vec<f64> = (0..300).map(|row| if row == 90 { 1.4 / 30.0 } else { 1.0 / 30.0 }).collect();
        assert!(of_steps(&jitter).is_even && of_steps(&late).is_even);
        assert!(of_steps(&two(30.0, 30.0)).is_even);
    }

    #[test]
    fn times_that_are_none_have_no_rate() {
        assert_eq!(timing(&[1.0]), None);
        assert_eq!(timing(&[1.0, 1.0]), None);
        assert_eq!(timing(&[0.0, 1.0e-9, 1.0e9]), None);
        assert_eq!(rate_of_numbers(&[0, 1, 3], &[0.0, 0.04, 0.12]), Some(25.0));
        assert_eq!(rate_of_numbers(&[0, 1, 2, 3], &[0.0, 0.04, 0.2, 0.24]), None);
    }
}
