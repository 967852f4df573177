//! What a run comes to: cycles, cadence, outliers.

use super::run::Tracked;
use serde::Serialize;

/// Summary of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// Rows.
    pub frames: usize,
    /// Frame numbers between the first and the last row that the table leaves out.
    pub skipped_frames: u64,
    /// Seconds from the first to the last row.
    pub duration_s: f64,
    /// Cycles passed, with their fraction.
    pub cycles: f64,
    /// Cycles per minute over the whole run: cycles passed over the time that they took.
    pub cadence_per_min: f64,
    /// Cycles per minute in the last row.
    pub last_cadence_per_min: f64,
    /// Standard deviation of [`Summary::last_cadence_per_min`].
    pub last_cadence_std_per_min: f64,
    /// Rows whose measurement did not belong to the prediction.
    pub outliers: usize,
    /// Sum of the rows' log-likelihoods.
    pub log_likelihood: f64,
    /// When the cycle began anew, seconds from the first row, between frames by the velocity. A
    /// cycle that is taken back and begun again counts once.
    pub cycle_starts_s: Vec<f64>,
}

impl Summary {
    /// Summarises a run.
    #[must_use]
    pub fn of(tracked: &Tracked) -> Self {
        let frames = &tracked.frames;
        let (first, last) = (&frames[0], &frames[frames.len() - 1]);
        let duration_s = (last.frame - first.frame) as f64 / tracked.rate_hz;
        let cadence = cadence_per_min(tracked, frames.len() - 1);
        Self {
            frames: frames.len(),
            skipped_frames: last.frame - first.frame + 1 - frames.len() as u64,
            duration_s,
            cycles: last.cycles,
            cadence_per_min: if duration_s > 0.0 { 60.0 * last.cycles / duration_s } else { 0.0 },
            last_cadence_per_min: cadence.0,
            last_cadence_std_per_min: cadence.1,
            outliers: frames.iter().filter(|frame| frame.estimate.outlier).count(),
            log_likelihood: frames.iter().map(|frame| f64::from(frame.estimate.log_likelihood)).sum(),
            cycle_starts_s: cycle_starts_s(tracked),
        }
    }
}

/// Cycles per minute at the row `index` and their standard deviation.
///
/// # Panics
/// If there is no such row.
#[must_use]
pub fn cadence_per_min(tracked: &Tracked, index: usize) -> (f64, f64) {
    let estimate = &tracked.frames[index].estimate;
    let per_min = 60.0 * tracked.rate_hz * tracked.step_frames;
    let std = f64::from(estimate.cycle_velocity_variance).max(0.0).sqrt();
    (f64::from(estimate.cycle_velocity_per_frame) * per_min, std * per_min)
}

fn cycle_starts_s(tracked: &Tracked) -> Vec<f64> {
    let first = &tracked.frames[0];
    let origin = f64::from(first.estimate.cycle_position);
    let mut next = origin.floor() + 1.0;
    let mut starts = Vec::new();
    for pair in tracked.frames.windows(2) {
        let [before, after] = [&pair[0], &pair[1]].map(|frame| frame.cycles + origin);
        // A step holds more than one start only where many frames were skipped; then the first one
        // is reported.
        if after >= next && after > before {
            let share = ((next - before) / (after - before)).clamp(0.0, 1.0);
            let frame = (pair[0].frame - first.frame) as f64 + share * (pair[1].frame - pair[0].frame) as f64;
            starts.push(frame / tracked.rate_hz);
            next = after.floor() + 1.0;
        }
    }
    starts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::angle_table::ANGLES;
    use crate::cyclic::tracking::TrackedFrame;
    use sinew_core::cyclic::CyclicEstimate;

    /// A run through these cycles, one a frame, at two frames a second.
    fn run(cycles: &[f64]) -> Tracked {
        let frame = |(index, cycles): (u64, &f64)| TrackedFrame {
            frame: 100 + index,
            estimate: CyclicEstimate {
                angles_rad: [0.0; ANGLES],
                turns: [0; ANGLES],
                angle_variance_rad2: [0.0; ANGLES],
                cycle_position: cycles.rem_euclid(1.0) as f32,
                cycle_position_variance: 0.0,
                cycle_velocity_per_frame: 0.25,
                cycle_velocity_variance: 0.01,
                log_likelihood: -1.0,
                outlier: index == 1,
            },
            angles_rad: [0.0; ANGLES],
            side: None,
            cycles: *cycles,
        };
        Tracked { frames: (0..).zip(cycles).map(frame).collect(), rate_hz: 2.0, step_frames: 0.5 }
    }

    #[test]
    fn starts_lie_between_frames_and_count_once() {
        let summary = Summary::of(&run(&[0.0, 0.75, 1.25, 0.75, 1.25, 2.0, 2.5]));
        assert_eq!(summary.cycle_starts_s, [0.75, 2.5]);
        assert_eq!((summary.frames, summary.skipped_frames, summary.outliers), (7, 0, 1));
        assert!((summary.cadence_per_min - 60.0 * 2.5 / 3.0).abs() < 1.0e-12);
        assert!((summary.last_cadence_per_min - 15.0).abs() < 1.0e-5, "{summary:?}");
        assert!((summary.last_cadence_std_per_min - 6.0).abs() < 1.0e-5, "{summary:?}");
    }

    #[test]
    fn a_single_row_has_no_cadence_of_its_own() {
        let summary = Summary::of(&run(&[0.0]));
        assert_eq!((summary.duration_s, summary.cadence_per_min), (0.0, 0.0));
        assert!(summary.cycle_starts_s.is_empty());
    }
}
