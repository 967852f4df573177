//! Curves over the cycle, 0 to 100 %: mean and spread over all cycles.

use super::angles::{ANATOMICAL_ANGLES, AnatomicalSeries, COUNT, Place};
use crate::cyclic::turns::circular_mean;
use serde::Serialize;

/// Points of a curve: each whole percent, both ends included.
pub const POINTS: usize = 101;

/// One point of one curve.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct CyclePointStatistics {
    /// Mean over the cycles, degrees; `None` where no cycle has the angle.
    pub mean_deg: Option<f64>,
    /// Standard deviation over the cycles (divided by their number less one), degrees; `None` with
    /// less than two cycles.
    pub std_deg: Option<f64>,
    /// Cycles that have the angle here.
    pub cycles: usize,
}

/// The curve of each anatomical angle.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CycleCurves {
    /// For each angle its points from 0 % to 100 %.
    pub curves: Vec<Vec<CyclePointStatistics>>,
}

impl CycleCurves {
    /// Curves of `series` over the frames `[start, end]` of each cycle. Whole turns are taken from
    /// a winding angle in each cycle, so that all cycles start near the same angle.
    #[must_use]
    pub fn new(series: &AnatomicalSeries, cycles: &[[f64; 2]]) -> Self {
        let places: Vec<Vec<Option<Place>>> = (0..POINTS)
            .map(|percent| {
                let share = percent as f64 / (POINTS - 1) as f64;
                cycles.iter().map(|&[start, end]| series.place(start + share * (end - start))).collect()
            })
            .collect();
        let curve = |angle: usize| {
            let starts_deg: Vec<Option<f64>> =
                cycles.iter().map(|&[start, end]| first_in(series, angle, start, end)).collect();
            let directions: Vec<(f64, f64)> =
                starts_deg.iter().flatten().map(|start_deg| (start_deg.to_radians(), 1.0)).collect();
            let mean_deg = circular_mean(&directions).map_or(0.0, f64::to_degrees);
            let turns_deg = |start_deg: Option<f64>| Some(whole_turns_deg(start_deg? - mean_deg));
            let turns_deg: Vec<Option<f64>> = starts_deg.into_iter().map(turns_deg).collect();
            places.iter().map(|places| point(series, angle, places, &turns_deg)).collect()
        };
        Self { curves: (0..COUNT).map(curve).collect() }
    }

    /// Means of one angle, degrees.
    #[must_use]
    pub fn means_deg(&self, angle: usize) -> Vec<Option<f64>> {
        self.curves[angle].iter().map(|point| point.mean_deg).collect()
    }

    /// As CSV: `percent`, then mean, standard deviation and number of cycles of each angle.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let mut text = "percent".to_owned();
        for name in ANATOMICAL_ANGLES {
            text.push_str(&format!(",{name}_mean_deg,{name}_std_deg,{name}_cycles"));
        }
        text.push('\n');
        let cell = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.4}"));
        for percent in 0..POINTS {
            text.push_str(&percent.to_string());
            for curve in &self.curves {
                let point = &curve[percent];
                text.push_str(&format!(",{},{},{}", cell(point.mean_deg), cell(point.std_deg), point.cycles));
            }
            text.push('\n');
        }
        text
    }
}

/// A point of a curve: its place in each cycle, and the whole turns that each cycle starts with.
fn point(
    series: &AnatomicalSeries,
    angle: usize,
    places: &[Option<Place>],
    turns_deg: &[Option<f64>],
) -> CyclePointStatistics {
    let value =
        |(place, turns_deg): (&Option<Place>, &Option<f64>)| Some(series.between(angle, (*place)?)? - (*turns_deg)?);
    let values: Vec<f64> = places.iter().zip(turns_deg).filter_map(value).collect();
    let count = values.len();
    if count == 0 {
        return CyclePointStatistics::default();
    }
    let mean = values.iter().sum::<f64>() / count as f64;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    let std_deg = (count > 1).then(|| (squares / (count - 1) as f64).sqrt());
    CyclePointStatistics { mean_deg: Some(mean), std_deg, cycles: count }
}

/// First value of an angle in a cycle.
fn first_in(series: &AnatomicalSeries, angle: usize, start: f64, end: f64) -> Option<f64> {
    let from = series.frames.partition_point(|frame| (*frame as f64) < start - 1.0);
    let inside =
        series.frames[from..].iter().zip(&series.angles_deg[from..]).take_while(|(frame, _)| **frame as f64 <= end);
    inside.filter_map(|(_, pose)| pose[angle]).next()
}

fn whole_turns_deg(angle_deg: f64) -> f64 {
    (angle_deg / 360.0).round() * 360.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn mean_and_spread_are_those_of_the_cycles() {
        // Three cycles of 50 frames with amplitudes 20, 30, 40; the last angle winds.
        let pose = |frame: u64| {
            let amplitude = 20.0 + 10.0 * (frame / 50) as f64;
            let mut pose = [Some(amplitude * (TAU * frame as f64 / 50.0).sin()); COUNT];
            pose[1] = Some(5.0 + 7.2 * frame as f64);
            pose[2] = None;
            pose
        };
        let series =
            AnatomicalSeries { frames: (0..151).collect(), angles_deg: (0..151).map(pose).collect(), rate_hz: 60.0 };
        let curves = CycleCurves::new(&series, &[[0.0, 50.0], [50.0, 100.0], [100.0, 150.0]]);
        let quarter = curves.curves[0][25];
        let sine = (30.0 * (TAU * 0.24).sin() + 30.0 * (TAU * 0.26).sin()) / 2.0;
        assert!((quarter.mean_deg.unwrap() - sine).abs() < 1.0e-6, "{quarter:?}");
        assert!((quarter.std_deg.unwrap() - sine / 3.0).abs() < 1.0e-6 && quarter.cycles == 3);
        let winding = curves.curves[1][100];
        assert!((winding.mean_deg.unwrap() - 365.0).abs() < 1.0e-6 && winding.std_deg.unwrap() < 1.0e-6, "{winding:?}");
        assert_eq!(curves.curves[2][10], CyclePointStatistics::default());
        let csv = curves.to_csv();
        assert_eq!(csv.lines().count(), 102);
        assert!(csv.lines().all(|line| line.split(',').count() == 1 + 3 * COUNT));
    }

    /// Cycles of an arm that circle from a degree before and after the top.
    #[test]
    fn a_winding_angle_starts_near_half_a_turn() {
        let start_deg = |cycle: u64| if cycle.is_multiple_of(2) { 179.0 } else { 181.0 };
        let pose = |frame: u64| [Some(start_deg(frame / 50) + 7.2 * frame as f64); COUNT];
        let series =
            AnatomicalSeries { frames: (0..200).collect(), angles_deg: (0..200).map(pose).collect(), rate_hz: 60.0 };
        let cycles = [0.0, 50.0, 100.0, 150.0].map(|start| [start, start + 49.0]);
        let middle = CycleCurves::new(&series, &cycles).curves[1][50];
        let off_deg = (middle.mean_deg.unwrap() - 180.0 - 24.5 * 7.2).rem_euclid(360.0);
        assert!(off_deg.min(360.0 - off_deg) < 1.0e-6 && middle.std_deg.unwrap() < 1.2, "{middle:?}");
    }
}
