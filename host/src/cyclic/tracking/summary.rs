//! What a run comes to: cycles, cadence, outliers.

use super::run::{Tracked, TrackedFrame};
use crate::resume::{List, long_real, real};
use serde::Serialize;
use sinew_core::saved_state::{SavedState, StateVisitor};

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
    ///
    /// # Panics
    /// If it has no row.
    #[must_use]
    pub fn of(tracked: &Tracked) -> Self {
        let mut running = RunningSummary::new(&tracked.frames[0], tracked.rate_hz, tracked.step_frames);
        tracked.frames[1..].iter().for_each(|frame| running.add(frame));
        running.summary()
    }
}

/// Cycles per minute at the row `index` and their standard deviation.
///
/// # Panics
/// If there is no such row.
#[must_use]
pub fn cadence_per_min(tracked: &Tracked, index: usize) -> (f64, f64) {
    let estimate = &tracked.frames[index].estimate;
    let velocity = [estimate.cycle_velocity_per_frame, estimate.cycle_velocity_variance];
    cadence(velocity, 60.0 * tracked.rate_hz * tracked.step_frames)
}

/// Mean and standard deviation of the cadence, of a velocity and its variance.
fn cadence([velocity, variance]: [f32; 2], per_min: f64) -> (f64, f64) {
    (f64::from(velocity) * per_min, f64::from(variance).max(0.0).sqrt() * per_min)
}

/// The summary of the rows so far.
#[derive(Debug, Clone)]
pub struct RunningSummary {
    rate_hz: f64,
    step_frames: f64,
    rows: u64,
    first_frame: u64,
    last_frame: u64,
    /// Position at the first row.
    origin: f64,
    /// Cycles at the last row.
    cycles: f64,
    /// Velocity at the last row and its variance.
    velocity: [f32; 2],
    /// Where the next cycle begins, in cycles from position 0 before the first row.
    next_start: f64,
    outliers: u64,
    log_likelihood: f64,
    starts_s: Vec<Seconds>,
}

/// A time, seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Seconds(f64);

impl RunningSummary {
    /// Begins with the first row; rates as in [`Tracked`].
    #[must_use]
    pub fn new(first: &TrackedFrame, rate_hz: f64, step_frames: f64) -> Self {
        let origin = f64::from(first.estimate.cycle_position);
        let mut begun = Self {
            rate_hz,
            step_frames,
            rows: 0,
            first_frame: first.frame,
            last_frame: first.frame,
            origin,
            cycles: first.cycles,
            velocity: [0.0; 2],
            next_start: origin.floor() + 1.0,
            outliers: 0,
            log_likelihood: 0.0,
            starts_s: Vec::new(),
        };
        begun.count(first);
        begun
    }

    /// Adds the row after the last one.
    pub fn add(&mut self, row: &TrackedFrame) {
        let [before, after] = [self.cycles, row.cycles].map(|cycles| cycles + self.origin);
        // A step holds more than one start only where many frames were skipped; then the first one
        // is reported.
        if after >= self.next_start && after > before {
            let share = ((self.next_start - before) / (after - before)).clamp(0.0, 1.0);
            let step = (row.frame - self.last_frame) as f64;
            let frame = (self.last_frame - self.first_frame) as f64 + share * step;
            self.starts_s.push(Seconds(frame / self.rate_hz));
            self.next_start = after.floor() + 1.0;
        }
        self.count(row);
    }

    fn count(&mut self, row: &TrackedFrame) {
        let estimate = &row.estimate;
        self.rows += 1;
        self.last_frame = row.frame;
        self.cycles = row.cycles;
        self.velocity = [estimate.cycle_velocity_per_frame, estimate.cycle_velocity_variance];
        self.outliers += u64::from(estimate.outlier);
        self.log_likelihood += f64::from(estimate.log_likelihood);
    }

    /// Rows so far.
    #[must_use]
    pub const fn rows(&self) -> u64 {
        self.rows
    }

    /// The summary, as if the last row ended the recording.
    #[must_use]
    pub fn summary(&self) -> Summary {
        let frame_numbers = self.last_frame - self.first_frame + 1;
        let duration_s = (frame_numbers - 1) as f64 / self.rate_hz;
        let last_cadence = cadence(self.velocity, 60.0 * self.rate_hz * self.step_frames);
        Summary {
            frames: self.rows as usize,
            skipped_frames: frame_numbers - self.rows,
            duration_s,
            cycles: self.cycles,
            cadence_per_min: if duration_s > 0.0 { 60.0 * self.cycles / duration_s } else { 0.0 },
            last_cadence_per_min: last_cadence.0,
            last_cadence_std_per_min: last_cadence.1,
            outliers: self.outliers as usize,
            log_likelihood: self.log_likelihood,
            cycle_starts_s: self.starts_s.iter().map(|start| start.0).collect(),
        }
    }
}

impl SavedState for RunningSummary {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        for count in [&mut self.rows, &mut self.first_frame, &mut self.last_frame, &mut self.outliers] {
            visitor.long(count);
        }
        for value in [&mut self.origin, &mut self.cycles, &mut self.next_start, &mut self.log_likelihood] {
            long_real(value, visitor);
        }
        self.velocity.iter_mut().for_each(|value| real(value, visitor));
        let mut starts_s = List::new(std::mem::take(&mut self.starts_s), Seconds(0.0));
        starts_s.visit(visitor);
        self.starts_s = starts_s.entries;
    }
}

impl SavedState for Seconds {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        long_real(&mut self.0, visitor);
    }
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
