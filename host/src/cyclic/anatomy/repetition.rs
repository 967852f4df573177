//! Repetitions: how long each cycle took and how far each joint went.

use super::angles::{ANATOMICAL_ANGLES, AnatomicalSeries, COUNT};
use serde::Serialize;

/// Smallest and largest value of an angle in a repetition.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Range {
    /// Least, degrees.
    pub min_deg: f64,
    /// Greatest, degrees.
    pub max_deg: f64,
}

impl Range {
    /// Range of motion, degrees.
    #[must_use]
    pub fn extent_deg(&self) -> f64 {
        self.max_deg - self.min_deg
    }
}

/// One cycle.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Repetition {
    /// Number, from 1.
    pub number: usize,
    /// Start, seconds from frame 0.
    pub start_s: f64,
    /// Time that it took, seconds.
    pub duration_s: f64,
    /// Repetitions a minute at this tempo.
    pub tempo_per_min: f64,
    /// Range of each anatomical angle; `None` where it was seen in less than two frames.
    pub ranges: [Option<Range>; COUNT],
}

/// The repetitions of `series` between the frames `[start, end]` of each cycle; these may lie
/// between frames. Cycles that do not last are left out.
#[must_use]
pub fn repetitions(series: &AnatomicalSeries, cycles: &[[f64; 2]]) -> Vec<Repetition> {
    let lasting = cycles.iter().filter(|[start, end]| end > start);
    let repetition = |(index, &[start, end]): (usize, &[f64; 2])| {
        let duration_s = (end - start) / series.rate_hz;
        Repetition {
            number: index + 1,
            start_s: start / series.rate_hz,
            duration_s,
            tempo_per_min: 60.0 / duration_s,
            ranges: std::array::from_fn(|angle| range(series, angle, start, end)),
        }
    };
    lasting.enumerate().map(repetition).collect()
}

fn range(series: &AnatomicalSeries, angle: usize, start: f64, end: f64) -> Option<Range> {
    let from = series.frames.partition_point(|frame| (*frame as f64) < start);
    let to = series.frames.partition_point(|frame| (*frame as f64) <= end);
    let values: Vec<f64> = series.angles_deg[from..to.max(from)].iter().filter_map(|pose| pose[angle]).collect();
    let fold = |best: fn(f64, f64) -> f64| values.iter().copied().reduce(best);
    (values.len() >= 2).then_some(Range { min_deg: fold(f64::min)?, max_deg: fold(f64::max)? })
}

/// The repetitions as CSV: `repetition,start_s,duration_s,tempo_per_min`, then least, greatest and
/// range of each angle.
#[must_use]
pub fn to_csv(repetitions: &[Repetition]) -> String {
    let mut text = "repetition,start_s,duration_s,tempo_per_min".to_owned();
    for name in ANATOMICAL_ANGLES {
        text.push_str(&format!(",{name}_min_deg,{name}_max_deg,{name}_range_deg"));
    }
    text.push('\n');
    for repetition in repetitions {
        let Repetition { number, start_s, duration_s, tempo_per_min, ranges } = repetition;
        text.push_str(&format!("{number},{start_s:.4},{duration_s:.4},{tempo_per_min:.3}"));
        for range in ranges {
            match range {
                None => text.push_str(",,,"),
                Some(range) => {
                    text.push_str(&format!(",{:.3},{:.3},{:.3}", range.min_deg, range.max_deg, range.extent_deg()));
                }
            }
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn tempo_and_range_are_those_of_the_swing() {
        let angle = |frame: u64| 10.0 + 25.0 * (TAU * frame as f64 / 40.0).sin();
        let mut poses: Vec<[Option<f64>; COUNT]> = (0..100).map(|frame| [Some(angle(frame)); COUNT]).collect();
        poses[0..79].iter_mut().for_each(|pose| pose[5] = None);
        let series = AnatomicalSeries { frames: (0..100).collect(), angles_deg: poses, rate_hz: 60.0 };
        let found = repetitions(&series, &[[0.0, 40.0], [40.0, 40.0], [39.5, 79.5]]);
        assert_eq!(found.len(), 2);
        assert!((found[0].tempo_per_min - 90.0).abs() < 1.0e-9 && (found[1].start_s - 39.5 / 60.0).abs() < 1.0e-12);
        let range = found[1].ranges[4].unwrap();
        assert!((range.min_deg + 15.0).abs() < 1.0e-9 && (range.extent_deg() - 50.0).abs() < 1.0e-9, "{range:?}");
        assert_eq!(found[1].ranges[5], None, "one frame has no range");
        let csv = to_csv(&found);
        let lines: Vec<&str> = csv.lines().collect();
        assert!(lines[0].starts_with("repetition,start_s,duration_s,tempo_per_min,trunk_lean_min_deg"));
        assert!(lines[1].starts_with("1,0.0000,0.6667,90.000,-15.000,35.000,50.000"));
        assert!(lines.iter().all(|line| line.split(',').count() == 4 + 3 * COUNT));
    }
}
