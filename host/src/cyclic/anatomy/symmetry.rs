//! Left against right: ranges, and curves half a cycle apart.

use super::angles::PAIRS;
use super::curves::{CycleCurves, POINTS};
use super::repetition::{Range, Repetition};
use crate::cyclic::turns::least_angle;
use serde::Serialize;

/// A joint hardly moves where both sides' ranges are below so many standard deviations of a
/// measured direction. Chosen: smoothing leaves about 0.45 of the noise, a joint's angle is the
/// difference of two directions, and 30 to 100 normal numbers range over 4.1 to 5.0 of their
/// standard deviations (Tippett, 1925). Together that is 2.6 to 3.2.
const STILL_NOISES: f64 = 3.0;

/// How alike the two sides of one joint move.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Symmetry {
    /// The angle, without its side.
    pub angle: &'static str,
    /// Mean range of motion of the left side, degrees.
    pub left_range_deg: Option<f64>,
    /// Mean range of motion of the right side, degrees.
    pub right_range_deg: Option<f64>,
    /// Symmetry index of the ranges: 200 (left - right) / (left + right) percent, 0 for equal sides
    /// (Robinson, Herzog and Nigg, 1987). `None`, as what follows, of a joint that moves no farther
    /// on either side than noise makes it.
    pub symmetry_index_percent: Option<f64>,
    /// By how much of a cycle the right side follows the left, in [0, 1): 0.5 for walking, 0 for
    /// sides that move together. The shift at which the mean curves about their means are most
    /// alike, or the directions of a winding joint. `None` where one side winds otherwise than the
    /// other.
    pub right_lag_cycles: Option<f64>,
    /// Root mean square difference of the mean curves at that shift, degrees; at most 180.
    pub curve_difference_deg: Option<f64>,
}

/// Symmetry of shoulders, elbows, hips and knees. `noise_rad` is the standard deviation of a
/// measured direction.
#[must_use]
pub fn symmetries(repetitions: &[Repetition], curves: &CycleCurves, noise_rad: f64) -> Vec<Symmetry> {
    let still_deg = STILL_NOISES * noise_rad.to_degrees();
    let symmetry = |(name, left, right): (&'static str, usize, usize)| {
        let (left_range_deg, right_range_deg) = (mean_range(repetitions, left), mean_range(repetitions, right));
        let moving = left_range_deg.zip(right_range_deg).filter(|(left, right)| left.max(*right) > still_deg);
        let symmetry_index_percent = moving.map(|(left, right)| 200.0 * (left - right) / (left + right));
        let shift = moving.and_then(|_| best_shift(&curves.means_deg(left), &curves.means_deg(right)));
        Symmetry {
            angle: name,
            left_range_deg,
            right_range_deg,
            symmetry_index_percent,
            right_lag_cycles: shift.map(|(lag, _)| lag),
            curve_difference_deg: shift.map(|(_, difference)| difference),
        }
    };
    PAIRS.into_iter().map(symmetry).collect()
}

/// As CSV, one row a joint.
#[must_use]
pub fn to_csv(symmetries: &[Symmetry]) -> String {
    let mut text =
        "angle,left_range_deg,right_range_deg,symmetry_index_percent,right_lag_cycles,curve_difference_deg\n"
            .to_owned();
    let cell = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.4}"));
    for row in symmetries {
        let values = [
            row.left_range_deg,
            row.right_range_deg,
            row.symmetry_index_percent,
            row.right_lag_cycles,
            row.curve_difference_deg,
        ];
        text.push_str(&format!("{},{}\n", row.angle, values.map(cell).join(",")));
    }
    text
}

fn mean_range(repetitions: &[Repetition], angle: usize) -> Option<f64> {
    let ranges: Vec<f64> =
        repetitions.iter().filter_map(|one| one.ranges[angle].as_ref().map(Range::extent_deg)).collect();
    (!ranges.is_empty()).then(|| ranges.iter().sum::<f64>() / ranges.len() as f64)
}

/// The shift of `right` in cycles that makes it most like `left`, and the root mean square
/// difference there. Curves that come back to their start are compared about their means. For
/// winding ones a shift is a constant, so their directions are compared.
fn best_shift(left: &[Option<f64>], right: &[Option<f64>]) -> Option<(f64, f64)> {
    const PERCENTS: usize = POINTS - 1;
    let known = |curve: &[Option<f64>]| curve.iter().take(PERCENTS).copied().collect::<Option<Vec<f64>>>();
    let (left, right) = (known(left)?, known(right)?);
    let turns = |curve: &[f64]| ((curve[PERCENTS - 1] - curve[0]) / 360.0).round();
    if turns(&left) != turns(&right) {
        return None;
    }
    let mean = |curve: &[f64]| curve.iter().sum::<f64>() / PERCENTS as f64;
    let offset = if turns(&left) == 0.0 { mean(&left) - mean(&right) } else { 0.0 };
    let difference = |shift: usize, offset: f64| {
        let square = |i: usize| {
            let off = left[i] - right[(i + shift) % PERCENTS] - offset;
            least_angle(off.to_radians()).to_degrees().powi(2)
        };
        (0..PERCENTS).map(square).sum::<f64>() / PERCENTS as f64
    };
    let best = (0..PERCENTS).min_by(|a, b| difference(*a, offset).total_cmp(&difference(*b, offset)))?;
    Some((best as f64 / PERCENTS as f64, difference(best, 0.0).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::super::{AnatomicalSeries, COUNT, repetition::repetitions};
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn equal_sides_half_a_cycle_apart_are_symmetric() {
        let pose = |frame: u64| {
            let phase = TAU * frame as f64 / 60.0;
            let mut pose = [Some(30.0 * phase.sin()); COUNT];
            pose[7] = Some(-30.0 * phase.sin());
            pose[8] = Some(20.0 * (phase - 0.25 * TAU).sin());
            pose[1] = None;
            pose
        };
        let series =
            AnatomicalSeries { frames: (0..200).collect(), angles_deg: (0..200).map(pose).collect(), rate_hz: 60.0 };
        let cycles = [[0.0, 60.0], [60.0, 120.0], [120.0, 180.0]];
        let found = symmetries(&repetitions(&series, &cycles), &CycleCurves::new(&series, &cycles), 0.0);
        let by_name = |name: &str| found.iter().find(|one| one.angle == name).unwrap().clone();
        let hip = by_name("hip_flexion");
        assert!(hip.symmetry_index_percent.unwrap().abs() < 1.0e-9);
        assert!(
            (hip.right_lag_cycles.unwrap() - 0.5).abs() < 1.0e-9 && hip.curve_difference_deg.unwrap() < 0.05,
            "{hip:?}"
        );
        let knee = by_name("knee_flexion");
        assert!((knee.symmetry_index_percent.unwrap() - 40.0).abs() < 1.0e-6, "{knee:?}");
        assert!((knee.right_lag_cycles.unwrap() - 0.25).abs() < 1.0e-9, "{knee:?}");
        assert!((knee.curve_difference_deg.unwrap() - 10.0 / 2.0_f64.sqrt()).abs() < 0.05, "{knee:?}");
        assert!(by_name("shoulder_flexion").symmetry_index_percent.is_none());
        assert_eq!(to_csv(&found).lines().count(), 5);
    }

    /// Knees that swing by 2 and 1 degrees.
    #[test]
    fn a_joint_that_moves_no_farther_than_noise_has_no_index() {
        let pose = |frame: u64| {
            let mut pose = [None; COUNT];
            let swing = (TAU * frame as f64 / 60.0).sin();
            (pose[4], pose[8]) = (Some(swing), Some(0.5 * swing));
            pose
        };
        let series =
            AnatomicalSeries { frames: (0..100).collect(), angles_deg: (0..100).map(pose).collect(), rate_hz: 60.0 };
        let cycles = [[0.0, 60.0]];
        let (found, curves) = (repetitions(&series, &cycles), CycleCurves::new(&series, &cycles));
        let knee = |noise_deg: f64| symmetries(&found, &curves, noise_deg.to_radians()).remove(3);
        assert!((knee(0.5).symmetry_index_percent.unwrap() - 200.0 / 3.0).abs() < 0.5, "{:?}", knee(0.5));
        let still = knee(0.8);
        assert!(still.left_range_deg.is_some() && still.right_lag_cycles.is_none(), "{still:?}");
        assert_eq!((still.symmetry_index_percent, still.curve_difference_deg), (None, None));
    }

    /// Lag and difference of arms that wind `turns` times in a cycle, with a swing of 12 degrees on
    /// top.
    fn of_circling_arms(turns: [f64; 2], lag: f64) -> (Option<f64>, Option<f64>) {
        let angle = |turns: f64, phase: f64| 40.0 + 360.0 * turns * phase + 12.0 * (TAU * phase).sin();
        let pose = |frame: u64| {
            let phase = frame as f64 / 60.0;
            let mut pose = [Some(0.0); COUNT];
            (pose[1], pose[5]) = (Some(angle(turns[0], phase)), Some(angle(turns[1], phase - lag)));
            pose
        };
        let series =
            AnatomicalSeries { frames: (0..200).collect(), angles_deg: (0..200).map(pose).collect(), rate_hz: 60.0 };
        let cycles = [[0.0, 60.0], [60.0, 120.0], [120.0, 180.0]];
        let found = symmetries(&repetitions(&series, &cycles), &CycleCurves::new(&series, &cycles), 0.0);
        (found[0].right_lag_cycles, found[0].curve_difference_deg)
    }

    #[test]
    fn winding_arms_have_the_lag_of_their_directions() {
        for turns in [1.0, -1.0] {
            for lag in [0.0, 0.25, 0.5, 0.6] {
                let (found, difference_deg) = of_circling_arms([turns; 2], lag);
                assert!((found.unwrap() - lag).abs() < 1.0e-9, "{found:?} instead of {lag}");
                assert!(difference_deg.unwrap() < 1.0, "{difference_deg:?} degrees at a lag of {lag}");
            }
        }
        assert_eq!(of_circling_arms([1.0, -1.0], 0.0), (None, None), "arms that wind against each other");
    }
}
