//! The cyclic paper's particle filter for firmware: it begins in place, needs no table beside the
//! model, and counts cycles.

use super::estimate::CyclicFrame;
use super::options::FirstPhase;
use crate::cyclic::events::{CycleCounter, CycleStep};
use crate::cyclic::particle::propose::ParticleOptions;
use crate::cyclic::{AngleMeasurement, CycleStart, MotionModel, ParticleTracker};
use crate::error::ParameterError;
use crate::saved_state::{SavedState, StateVisitor};

/// State of a tracker for models of up to `N` angles, with up to `P` particles (cyclic paper,
/// section 3.3).
///
/// ```
/// use sinew_core::cyclic::AngleMeasurement;
/// use sinew_core::cyclic::example::swing_pose_rad;
/// use sinew_core::cyclic::particle::propose::ParticleOptions;
/// use sinew_core::tracker::cyclic::{FirstPhase, ParticleCycleTracker};
/// # let table = sinew_core::cyclic::example::swing_table();
/// # let model = table.model().expect("the numbers agree");
///
/// // Two joints that swing once in 60 frames, seen with 0.05 rad of noise; a hundred particles under seed 1.
/// let seen = |frame: usize| AngleMeasurement::new(&swing_pose_rad(frame as f32 / 60.0).map(Some), 0.05);
/// let start = FirstPhase { position: Some(0.0), velocity_per_frame: None };
/// let mut tracker = ParticleCycleTracker::<2, 100>::empty();
/// tracker.configure(ParticleOptions::default(), 100)?;
/// tracker.begin(&model, &seen(0)?, start, 1)?;
/// let mut last = tracker.first_frame(&model);
/// for frame in 1..=210 {
///     last = tracker.step(&model, &seen(frame)?);
/// }
/// assert_eq!(last.cycles_completed, 3, "three and a half cycles");
/// assert!((last.cadence_per_min - 60.0).abs() < 6.0, "at 60 frames a second: {last:?}");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
pub struct ParticleCycleTracker<const N: usize, const P: usize> {
    filter: ParticleTracker<N, P>,
    counter: CycleCounter,
}

impl<const N: usize, const P: usize> ParticleCycleTracker<N, P> {
    /// A tracker before [`Self::begin`], for static memory: all zeros. Its estimates are
    /// meaningless.
    #[must_use]
    pub const fn empty() -> Self {
        Self { filter: ParticleTracker::empty(), counter: CycleCounter::zero() }
    }

    /// Takes over options and a number of particles for the next [`Self::begin`] or saved state.
    ///
    /// # Errors
    /// From 1 to `P` particles; the tracker is as before then.
    pub fn configure(&mut self, options: ParticleOptions, particles: usize) -> Result<(), ParameterError> {
        self.filter.configure(options, particles)
    }

    /// Begins, or begins anew, with the frame `first`, in place; particles are drawn under `seed`.
    ///
    /// # Errors
    /// Those of [`CycleStart::standard`] and [`ParticleTracker::begin`]; the tracker is as before
    /// then.
    pub fn begin(
        &mut self,
        model: &MotionModel<'_>,
        first: &AngleMeasurement<N>,
        phase: FirstPhase,
        seed: u64,
    ) -> Result<(), ParameterError> {
        let start = CycleStart::standard(model, first.angles_rad(), phase.position, phase.velocity_per_frame)?;
        self.filter.begin(model, &start, seed)?;
        self.counter = CycleCounter::new(start.cycle_position);
        Ok(())
    }

    /// The estimate after the first frame.
    #[must_use]
    pub fn first_frame(&self, model: &MotionModel<'_>) -> CyclicFrame<N> {
        let estimate = *self.filter.estimate();
        CyclicFrame::new(model, estimate, &self.counter, CycleStep::none(estimate.cycle_position))
    }

    /// One frame: predict, weigh, estimate, resample, count.
    pub fn step(&mut self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>) -> CyclicFrame<N> {
        let estimate = self.filter.step_without_table(model, measurement);
        let (position, velocity) = (estimate.cycle_position, estimate.cycle_velocity_per_frame);
        let cycle_step = self.counter.advance(position, velocity, measurement.step_frames());
        CyclicFrame::new(model, estimate, &self.counter, cycle_step)
    }

    /// The filter.
    #[must_use]
    pub const fn filter(&self) -> &ParticleTracker<N, P> {
        &self.filter
    }
}

impl<const N: usize, const P: usize> SavedState for ParticleCycleTracker<N, P> {
    /// A state is for a tracker with as many particles that has begun.
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        self.filter.visit(visitor);
        self.counter.visit(visitor);
    }
}
