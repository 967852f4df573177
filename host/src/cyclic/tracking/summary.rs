//! What a run comes to: cycles, cadence, outliers.

use super::cycle_times::CycleTimes;
use super::run::{Tracked, TrackedFrame};
use crate::cyclic::stops::LONGEST_BRIDGE_CYCLES;
use crate::resume::{long_real, real};
use serde::Serialize;
use sinew_core::saved_state::{SavedState, StateVisitor};

/// Cycles without which there is no cadence: with less, what one cycle differs from the next
/// cannot be seen.
pub const MIN_CYCLES: f64 = 2.0;

/// Summary of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// Rows.
    pub frames: usize,
    /// Frame numbers between the first and the last row that the table leaves out.
    pub skipped_frames: u64,
    /// Seconds from the first to the last row.
    pub duration_s: f64,
    /// Seconds of these in which the person was seen.
    pub seen_s: f64,
    /// Cycles passed while the person was seen, with their fraction.
    pub cycles: f64,
    /// Cycles per minute, of the mean time of a cycle from each of sixteen phases on. Where the
    /// person was never seen for two cycles in a row, it is of all that was passed. `None` for less
    /// than [`MIN_CYCLES`].
    pub cadence_per_min: Option<f64>,
    /// Standard deviation of the cadence from cycle to cycle; `None` for less than three whole
    /// cycles.
    pub cadence_std_per_min: Option<f64>,
    /// Cycles per minute in the last row.
    pub last_cadence_per_min: f64,
    /// Standard deviation of [`Summary::last_cadence_per_min`].
    pub last_cadence_std_per_min: f64,
    /// Rows whose measurement did not belong to the prediction.
    pub outliers: usize,
    /// Rows in which the motion was not the model's.
    pub misfits: usize,
    /// Sum of the rows' log-likelihoods.
    pub log_likelihood: f64,
    /// When the cycle began anew, seconds from the first row, between frames by the velocity. A
    /// cycle that is taken back and begun again counts once.
    pub cycle_starts_s: Vec<f64>,
    /// Start and end of each whole cycle in which the person was seen, seconds from the first row.
    pub whole_cycles_s: Vec<[f64; 2]>,
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

    /// The same without any cycle or cadence, for a recording that is not of the model's motion.
    #[must_use]
    pub fn without_cycles(self) -> Self {
        Self {
            cycles: 0.0,
            cadence_per_min: None,
            cadence_std_per_min: None,
            last_cadence_per_min: 0.0,
            last_cadence_std_per_min: 0.0,
            cycle_starts_s: Vec::new(),
            whole_cycles_s: Vec::new(),
            ..self
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
    let velocity = [estimate.cycle_velocity_per_frame, estimate.cycle_velocity_variance];
    cadence(velocity, 60.0 * tracked.rate_hz * tracked.step_frames)
}

/// Mean and standard deviation of the cadence, of a velocity and its variance; `per_min` is a
/// minute in the velocity's frames.
#[must_use]
pub fn cadence([velocity, variance]: [f32; 2], per_min: f64) -> (f64, f64) {
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
    /// Whether the last row is known.
    is_known: bool,
    /// Cycles and frames between successive rows that are known.
    seen_cycles: f64,
    seen_frames: u64,
    /// Velocity at the last row and its variance.
    velocity: [f32; 2],
    outliers: u64,
    misfits: u64,
    log_likelihood: f64,
    times: CycleTimes,
}

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
            is_known: first.is_known,
            seen_cycles: 0.0,
            seen_frames: 0,
            velocity: [0.0; 2],
            outliers: 0,
            misfits: 0,
            log_likelihood: 0.0,
            times: CycleTimes::new(origin + first.cycles),
        };
        begun.count(first);
        begun
    }

    /// Adds the row after the last one.
    pub fn add(&mut self, row: &TrackedFrame) {
        // Rows that the table leaves out are not there to say that nothing is known.
        let is_bridged = (row.cycles - self.cycles).abs() <= LONGEST_BRIDGE_CYCLES;
        if self.is_known && row.is_known && is_bridged {
            self.pass(row);
        } else {
            self.times.lose(self.origin + row.cycles);
        }
        self.is_known = row.is_known;
        self.count(row);
    }

    /// Cycles from the last row to `row`.
    fn pass(&mut self, row: &TrackedFrame) {
        let [before, after] = [self.cycles, row.cycles].map(|cycles| cycles + self.origin);
        let step = row.frame - self.last_frame;
        self.seen_cycles += after - before;
        self.seen_frames += step;
        let at_s = |frame: u64| (frame - self.first_frame) as f64 / self.rate_hz;
        self.times.pass([before, after], [at_s(self.last_frame), at_s(row.frame)]);
    }

    fn count(&mut self, row: &TrackedFrame) {
        let estimate = &row.estimate;
        self.rows += 1;
        self.last_frame = row.frame;
        self.cycles = row.cycles;
        self.velocity = [estimate.cycle_velocity_per_frame, estimate.cycle_velocity_variance];
        self.outliers += u64::from(estimate.outlier);
        self.misfits += u64::from(estimate.misfit);
        self.log_likelihood += f64::from(estimate.log_likelihood);
    }

    fn cadence_per_min(&self) -> Option<f64> {
        let seen_s = self.seen_frames as f64 / self.rate_hz;
        // Backwards no cycle is timed.
        let mean_s = self.times.mean_s().filter(|_| self.seen_cycles > 0.0);
        let cycles_per_s = mean_s.map_or(self.seen_cycles / seen_s, f64::recip);
        (self.seen_cycles.abs() >= MIN_CYCLES).then_some(60.0 * cycles_per_s)
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
        let last_cadence = cadence(self.velocity, 60.0 * self.rate_hz * self.step_frames);
        let seen_s = self.seen_frames as f64 / self.rate_hz;
        let whole_cycles_s = self.times.whole_s();
        Summary {
            frames: self.rows as usize,
            skipped_frames: frame_numbers - self.rows,
            duration_s: (frame_numbers - 1) as f64 / self.rate_hz,
            seen_s,
            cycles: self.seen_cycles,
            cadence_per_min: self.cadence_per_min(),
            cadence_std_per_min: spread_per_min(&whole_cycles_s),
            last_cadence_per_min: last_cadence.0,
            last_cadence_std_per_min: last_cadence.1,
            outliers: self.outliers as usize,
            misfits: self.misfits as usize,
            log_likelihood: self.log_likelihood,
            cycle_starts_s: self.times.starts_s(),
            whole_cycles_s,
        }
    }
}

/// Standard deviation of the cadence of cycles, divided by their number less one.
fn spread_per_min(cycles_s: &[[f64; 2]]) -> Option<f64> {
    let cadences: Vec<f64> = cycles_s.iter().map(|[start, end]| 60.0 / (end - start)).collect();
    let count = cadences.len() as f64;
    let mean = cadences.iter().sum::<f64>() / count;
    let squares: f64 = cadences.iter().map(|cadence| (cadence - mean).powi(2)).sum();
    (cadences.len() >= 3).then(|| (squares / (count - 1.0)).sqrt())
}

impl SavedState for RunningSummary {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        for count in [
            &mut self.rows,
            &mut self.first_frame,
            &mut self.last_frame,
            &mut self.outliers,
            &mut self.misfits,
            &mut self.seen_frames,
        ] {
            visitor.long(count);
        }
        for value in [&mut self.origin, &mut self.cycles, &mut self.log_likelihood, &mut self.seen_cycles] {
            long_real(value, visitor);
        }
        self.velocity.iter_mut().for_each(|value| real(value, visitor));
        visitor.flag(&mut self.is_known);
        self.times.visit(visitor);
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
                misfit: index > 4,
            },
            angles_rad: [0.0; ANGLES],
            side: None,
            cycles: *cycles,
            is_known: true,
        };
        Tracked { frames: (0..).zip(cycles).map(frame).collect(), rate_hz: 2.0, step_frames: 0.5 }
    }

    #[test]
    fn starts_lie_between_frames_and_count_once() {
        let summary = Summary::of(&run(&[0.0, 0.75, 1.25, 0.75, 1.25, 2.0, 2.5]));
        assert_eq!(summary.cycle_starts_s, [0.75, 2.5]);
        assert_eq!((summary.frames, summary.outliers, summary.misfits), (7, 1, 2));
        assert!((summary.last_cadence_per_min - 15.0).abs() < 1.0e-5, "{summary:?}");
        assert!((summary.last_cadence_std_per_min - 6.0).abs() < 1.0e-5, "{summary:?}");
    }

    #[test]
    fn cadence_is_that_of_all_phases_and_backwards_that_of_what_was_passed() {
        let cadence = |cycles: &[f64]| Summary::of(&run(cycles)).cadence_per_min;
        assert_eq!(cadence(&[0.25, 0.75, 1.25, 1.75, 2.25]), Some(60.0));
        assert_eq!(cadence(&[0.25, 0.75, 1.25, 1.75]), None);
        assert_eq!(cadence(&[2.5, 1.5, 0.5]), Some(-120.0));
    }

    #[test]
    fn what_the_table_leaves_out_is_not_seen() {
        let mut tracked = run(&[0.0, 0.5, 1.0, 1.5, 2.0, 22.0, 22.5, 23.0, 23.5, 24.0]);
        tracked.frames[5..].iter_mut().for_each(|row| row.frame += 40);
        let summary = Summary::of(&tracked);
        assert_eq!((summary.cycles, summary.seen_s, summary.duration_s), (4.0, 4.0, 24.5));
        assert_eq!(summary.whole_cycles_s, [[1.0, 2.0], [23.5, 24.5]]);
        assert_eq!(summary.cadence_per_min, Some(60.0));
    }

    #[test]
    fn a_single_row_has_no_cadence_of_its_own() {
        let summary = Summary::of(&run(&[0.0]));
        assert_eq!((summary.duration_s, summary.cadence_per_min), (0.0, None));
        assert!(summary.cycle_starts_s.is_empty());
    }
}
