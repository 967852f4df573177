//! The cyclic tracker of firmware: the phase-coupled filter and the count of cycles.
//!
//! It gives the numbers of [`super::step::CyclicTracker`] with that filter. It is a type of its
//! own, since its saved state, its 4.2 KiB instead of 5.4 and its flash hold no other filter. It
//! also begins in place in static memory.

use super::estimate::CyclicFrame;
use super::options::FirstPhase;
use crate::cyclic::events::{CycleCounter, CycleStep};
use crate::cyclic::{AngleMeasurement, CoupledFilter, CoupledModel};
use crate::error::ParameterError;
use crate::saved_state::{SavedState, StateVisitor};

/// State of a tracker for models of up to `N` angles.
///
/// ```
/// use sinew_core::cyclic::AngleMeasurement;
/// use sinew_core::cyclic::example::swing_pose_rad;
/// use sinew_core::tracker::cyclic::{CoupledTracker, FirstPhase};
/// # let table = sinew_core::cyclic::example::swing_table();
/// # let model = table.model().expect("the numbers agree");
///
/// // Two joints that swing once in 60 frames, seen with 0.05 rad of noise.
/// let seen = |frame: usize| AngleMeasurement::new(&swing_pose_rad(frame as f32 / 60.0).map(Some), 0.05);
/// let mut tracker = CoupledTracker::<2>::new(&model, &seen(0)?, FirstPhase::default())?;
/// let mut last = tracker.first_frame(&model, &seen(0)?);
/// for frame in 1..=210 {
///     last = tracker.step(&model, &seen(frame)?);
/// }
/// assert_eq!(last.cycles_completed, 3, "three and a half cycles");
/// assert!((last.cadence_per_min - 60.0).abs() < 1.0, "at 60 frames a second");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoupledTracker<const N: usize> {
    filter: CoupledFilter<N>,
    counter: CycleCounter,
}

const _: () = assert!(size_of::<CoupledTracker<13>>() <= 4280, "the tracker has to fit 4.2 KiB");

impl<const N: usize> CoupledTracker<N> {
    /// A tracker that begins with the frame `first`.
    ///
    /// # Errors
    /// Those of [`CoupledFilter::new`].
    pub fn new(
        model: &CoupledModel<'_>,
        first: &AngleMeasurement<N>,
        phase: FirstPhase,
    ) -> Result<Self, ParameterError> {
        let mut tracker = Self::empty();
        tracker.begin(model, first, phase)?;
        Ok(tracker)
    }

    /// A tracker before [`Self::begin`], for static memory: it takes no stack. Its estimates are
    /// meaningless.
    #[must_use]
    pub const fn empty() -> Self {
        Self { filter: CoupledFilter::empty(), counter: CycleCounter::zero() }
    }

    /// Begins, or begins anew, with the frame `first`, in place.
    ///
    /// # Errors
    /// Those of [`CoupledFilter::new`]; the tracker is as before then.
    pub fn begin(
        &mut self,
        model: &CoupledModel<'_>,
        first: &AngleMeasurement<N>,
        phase: FirstPhase,
    ) -> Result<(), ParameterError> {
        self.filter.begin(model, first, phase.position, phase.velocity_per_frame)?;
        self.counter = CycleCounter::new(self.filter.cycle().position);
        Ok(())
    }

    /// The estimate after the first frame.
    pub fn first_frame(&mut self, model: &CoupledModel<'_>, first: &AngleMeasurement<N>) -> CyclicFrame<N> {
        let estimate = self.filter.current_estimate(model, first);
        let from = estimate.cycle_position;
        CyclicFrame::new(model, estimate, &self.counter, CycleStep::none(from))
    }

    /// One frame: predict and correct, count.
    pub fn step(&mut self, model: &CoupledModel<'_>, measurement: &AngleMeasurement<N>) -> CyclicFrame<N> {
        let estimate = self.filter.step(model, measurement);
        let (position, velocity) = (estimate.cycle_position, estimate.cycle_velocity_per_frame);
        let cycle_step = self.counter.advance(position, velocity, measurement.step_frames());
        CyclicFrame::new(model, estimate, &self.counter, cycle_step)
    }

    /// The filter.
    #[must_use]
    pub const fn filter(&self) -> &CoupledFilter<N> {
        &self.filter
    }
}

impl<const N: usize> SavedState for CoupledTracker<N> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        self.filter.visit(visitor);
        self.counter.visit(visitor);
    }
}

#[cfg(test)]
mod tests {
    use super::super::step::CyclicTracker;
    use super::*;
    use crate::cyclic::synthetic;

    #[test]
    fn it_gives_the_numbers_of_the_tracker_with_a_choice_of_filters() {
        let table = synthetic::table(4.0e-3, 9);
        let model = table.model().unwrap();
        let seen = |frame: u16| {
            let angles: [_; 13] = core::array::from_fn(|i| {
                let angle = synthetic::mean_angle(i, f32::from(frame) / 65.0);
                (!(usize::from(frame) + i).is_multiple_of(7)).then_some(angle)
            });
            AngleMeasurement::new(&angles, 0.1).unwrap()
        };
        let mut both = CyclicTracker::new(&model, Default::default(), &seen(1).into(), FirstPhase::default()).unwrap();
        let mut coupled = CoupledTracker::new(&model, &seen(1), FirstPhase::default()).unwrap();
        let first = coupled.first_frame(&model, &seen(1));
        assert_eq!((first.cycles_completed, first.estimate.cycle_position), (0, both.filter().cycle_position()));
        for frame in 2..200 {
            assert_eq!(both.step(&model, &seen(frame).into()), coupled.step(&model, &seen(frame)));
        }
    }
}
