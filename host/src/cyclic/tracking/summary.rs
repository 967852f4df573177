//! What a run comes to: cycles, cadence, outliers.

use super::run::Tracked;
use serde::Serialize;

/// Summary of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// Rows.
    pub frames: usize,
    /// Seconds from the first to the last row.
    pub duration_s: f64,
    /// Cycles passed, with their fraction.
    pub cycles: f64,
    /// Cycles per minute over the whole run: cycles passed over the time that they took.
    pub cadence_per_min: f64,
    /// Rows whose measurement did not belong to the prediction.
    pub outliers: usize,
    /// Sum of the rows' log-likelihoods.
    pub log_likelihood: f64,
    /// When the cycle began anew, seconds from the first row, between frames by the velocity.
    pub cycle_starts_s: Vec<f64>,
}

impl Summary {
    /// Summarises a run.
    #[must_use]
    pub fn of(tracked: &Tracked) -> Self {
        let frames = &tracked.frames;
        let (first, last) = (&frames[0], &frames[frames.len() - 1]);
        let seconds = |frame: f64| (frame - first.frame as f64) / tracked.rate_hz;
        let duration_s = seconds(last.frame as f64);
        let mut cycle_starts_s = Vec::new();
        let origin = f64::from(first.estimate.cycle_position);
        for pair in frames.windows(2) {
            let [before, after] = [&pair[0], &pair[1]].map(|frame| frame.cycles + origin);
            let start = before.floor() + 1.0;
            if after >= start && after > before {
                let share = (start - before) / (after - before);
                let frame = pair[0].frame as f64 + share * (pair[1].frame - pair[0].frame) as f64;
                cycle_starts_s.push(seconds(frame));
            }
        }
        Self {
            frames: frames.len(),
            duration_s,
            cycles: last.cycles,
            cadence_per_min: if duration_s > 0.0 { 60.0 * last.cycles / duration_s } else { 0.0 },
            outliers: frames.iter().filter(|frame| frame.estimate.outlier).count(),
            log_likelihood: frames.iter().map(|frame| f64::from(frame.estimate.log_likelihood)).sum(),
            cycle_starts_s,
        }
    }
}
