//! The cyclic tracker: a filter of the pose and the phase, the cycles counted, the cadence.

use crate::cyclic::events::{CycleCounter, CycleStep};
use crate::cyclic::{AngleMeasurement, CycleStart, CyclicEstimate, KalmanFilter, KalmanOptions, MotionModel};
use crate::error::ParameterError;

/// State of a tracker for models of up to `N` angles, with the filter `paper` or `paper-cut` as its options say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CyclicTracker<const N: usize> {
    options: KalmanOptions,
    filter: KalmanFilter<N>,
    counter: CycleCounter,
}

/// What the tracker says after a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CyclicFrame<const N: usize> {
    /// Pose, phase and how sure they are.
    pub estimate: CyclicEstimate<N>,
    /// Whole cycles since the start.
    pub cycles_completed: i32,
    /// Cycles per minute.
    pub cadence_per_min: f32,
    /// Standard deviation of the cadence.
    pub cadence_std_per_min: f32,
    /// The way through the cycle since the last frame; asks it for the time at which a phase was passed.
    pub cycle_step: CycleStep,
}

impl<const N: usize> CyclicTracker<N> {
    /// A tracker at its start.
    ///
    /// # Errors
    /// Those of [`KalmanFilter::new`].
    pub fn new(model: &MotionModel<'_>, options: KalmanOptions, start: &CycleStart<N>) -> Result<Self, ParameterError> {
        let filter = KalmanFilter::new(model, &options, start)?;
        Ok(Self { options, filter, counter: CycleCounter::new(start.cycle_position) })
    }

    /// Begins anew with the same options; cycles are counted from zero.
    ///
    /// # Errors
    /// Those of [`KalmanFilter::new`]; the tracker is as before then.
    pub fn reset(&mut self, model: &MotionModel<'_>, start: &CycleStart<N>) -> Result<(), ParameterError> {
        *self = Self::new(model, self.options, start)?;
        Ok(())
    }

    /// One frame: predict and correct, then count.
    pub fn step(&mut self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>) -> CyclicFrame<N> {
        let estimate = self.filter.step(model, &self.options, measurement);
        let cycle_step =
            self.counter.advance(estimate.cycle_position, estimate.cycle_velocity_per_frame, measurement.step_frames());
        let (cadence_per_min, cadence_std_per_min) = estimate.cadence_per_min(model.rate_hz());
        let cycles_completed = self.counter.completed();
        CyclicFrame { estimate, cycles_completed, cadence_per_min, cadence_std_per_min, cycle_step }
    }

    /// The filter.
    #[must_use]
    pub const fn filter(&self) -> &KalmanFilter<N> {
        &self.filter
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::synthetic;

    #[test]
    fn cycles_cadence_and_phases_come_out_of_a_steady_motion() {
        let table = synthetic::table(4.0e-3, 9);
        let model = table.model().unwrap();
        let first: [_; 13] = core::array::from_fn(|i| Some(synthetic::mean_angle(i, 0.0)));
        let start = CycleStart::standard(&model, &first, Some(0.0), None).unwrap();
        let mut tracker = CyclicTracker::new(&model, KalmanOptions::default(), &start).unwrap();
        let mut passages = 0;
        for frame in 1..=200_u8 {
            let seen = core::array::from_fn(|i| Some(synthetic::mean_angle(i, f32::from(frame) / 65.0)));
            let answer = tracker.step(&model, &AngleMeasurement::new(&seen, 0.1).unwrap());
            passages += i32::from(answer.cycle_step.passed(0.5).is_some());
            assert_eq!(answer.cycles_completed, i32::from(frame) * 100 / 6500, "frame {frame}");
            assert!((answer.cadence_per_min - 3600.0 / 65.0).abs() < 1.0e-3);
            assert!(answer.cadence_std_per_min > 0.0);
        }
        assert_eq!(passages, 3);
        tracker.reset(&model, &start).unwrap();
        let answer = tracker.step(&model, &AngleMeasurement::nothing());
        assert_eq!(answer.cycles_completed, 0);
    }
}
