//! Estimate of the cyclic tracker for a frame.

use crate::cyclic::events::{CycleCounter, CycleStep};
use crate::cyclic::{CoupledModel, CyclicEstimate};

/// Estimate, cycles and cadence after a frame.
///
/// ```
/// use sinew_core::cyclic::AngleMeasurement;
/// use sinew_core::cyclic::example::swing_pose_rad;
/// use sinew_core::tracker::cyclic::{CoupledTracker, FirstPhase};
/// # let table = sinew_core::cyclic::example::swing_table();
/// # let model = table.model().expect("the numbers agree");
///
/// // A beep at the middle of every cycle, at its time between two frames.
/// let seen = |frame: usize| AngleMeasurement::new(&swing_pose_rad(frame as f32 / 60.0).map(Some), 0.05);
/// let mut tracker = CoupledTracker::<2>::new(&model, &seen(0)?, FirstPhase::default())?;
/// let (mut beeps, mut at_frame) = (0, 0.0);
/// for frame in 1..=120 {
///     let answer = tracker.step(&model, &seen(frame)?);
///     if let Some(after_frames) = answer.cycle_step.passed(0.5) {
///         beeps += 1;
///         at_frame = (frame - 1) as f32 + after_frames;
///     }
/// }
/// assert_eq!(beeps, 2);
/// assert!((at_frame - 90.0).abs() < 1.0, "in the middle of the second cycle: {at_frame}");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CyclicFrame<const N: usize> {
    /// Pose and phase with their variances; likelihood and outlier.
    pub estimate: CyclicEstimate<N>,
    /// Whole cycles since the first frame.
    pub cycles_completed: i32,
    /// Cycles per minute.
    pub cadence_per_min: f32,
    /// Standard deviation of the cadence.
    pub cadence_std_per_min: f32,
    /// Progress through the cycle since the last frame; it gives the time at which a phase was
    /// passed.
    pub cycle_step: CycleStep,
}

impl<const N: usize> CyclicFrame<N> {
    /// From the filter's estimate and the counter after it.
    pub(super) fn new(
        model: &CoupledModel<'_>,
        estimate: CyclicEstimate<N>,
        counter: &CycleCounter,
        cycle_step: CycleStep,
    ) -> Self {
        let (cadence_per_min, cadence_std_per_min) = estimate.cadence_per_min(model.rate_hz());
        let cycles_completed = counter.completed();
        Self { estimate, cycles_completed, cadence_per_min, cadence_std_per_min, cycle_step }
    }
}
