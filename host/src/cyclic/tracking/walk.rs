//! One filter on its way from row to row.

use super::TrackingOptions;
use super::filter::{Filter, Pass};
use super::run::cycles;
use super::saved_estimate::visit_estimate;
use super::steps::Steps;
use crate::cyclic::smoothing::Smoothed;
use crate::error::Result;
use crate::resume::long_real;
use sinew_core::cyclic::events::CycleCounter;
use sinew_core::cyclic::{CyclicEstimate, MotionModel};
use sinew_core::saved_state::{SavedState, StateVisitor};

/// A filter for `N` angles that begins at the first row with an angle.
#[derive(Debug)]
pub(super) struct Walk<'a, const N: usize> {
    steps: Steps<'a>,
    filter: Filter<'a, N>,
    /// The states for the way back, if there is one.
    pass: Option<Pass<'a, N>>,
    counter: CycleCounter,
    /// Numbers of the recording's first frame and of the last one that is answered.
    frames: [u64; 2],
}

/// What the filter answered to a row.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Answer<const N: usize> {
    pub estimate: CyclicEstimate<N>,
    /// Cycles since the first row with an angle.
    pub cycles: f64,
}

impl<'a, const N: usize> Walk<'a, N> {
    /// A filter that has answered `frame`, the first one with an angle, in a recording that begins
    /// at `first_frame`.
    ///
    /// # Errors
    /// An option out of range, a rate so low that a step is too long.
    pub fn begin(
        view: MotionModel<'a>,
        options: &'a TrackingOptions,
        [first_frame, frame]: [u64; 2],
        angles_rad: &[Option<f32>; N],
    ) -> Result<Self> {
        let steps = Steps::new(&view, options)?;
        let filter = Filter::new(view, options, angles_rad, steps.step_frames())?;
        let pass = if options.smooth { Pass::begin(&filter) } else { None };
        let counter = CycleCounter::new(filter.first_estimate().cycle_position);
        Ok(Self { steps, filter, pass, counter, frames: [first_frame, frame] })
    }

    /// Steps from row to row.
    pub const fn steps(&self) -> &Steps<'a> {
        &self.steps
    }

    /// The answer to the first row with an angle, and to those before it.
    pub const fn first_answer(&self) -> Answer<N> {
        Answer { estimate: self.filter.first_estimate(), cycles: 0.0 }
    }

    /// Answers `frame`, which follows the last one.
    ///
    /// # Errors
    /// None for rows of a table.
    pub fn step(&mut self, frame: u64, angles_rad: &[Option<f32>; N]) -> Result<Answer<N>> {
        let [first_frame, before] = self.frames;
        let measurement = self.steps.later(first_frame, before, frame, angles_rad)?;
        let estimate = self.filter.step(&measurement);
        if let Some(pass) = &mut self.pass {
            pass.add(&self.filter, measurement);
        }
        let velocity = estimate.cycle_velocity_per_frame;
        self.counter.advance(estimate.cycle_position, velocity, measurement.step_frames());
        self.frames[1] = frame;
        Ok(Answer { estimate, cycles: cycles(&self.counter) })
    }

    /// After a saved state: the number of the last frame that is answered.
    pub fn go_on_after(&mut self, frame: u64) {
        self.frames[1] = frame;
    }

    /// The estimates from the first row with an angle on, given all that are answered, each `None`
    /// where the forward one stays; no list unless the options ask for it.
    pub fn smoothed(&self) -> Option<Vec<Option<Smoothed<N>>>> {
        self.pass.as_ref().map(Pass::smoothed)
    }
}

impl<const N: usize> SavedState for Walk<'_, N> {
    /// Without the states for the way back.
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        self.filter.visit(visitor);
        self.counter.visit(visitor);
    }
}

impl<const N: usize> SavedState for Answer<N> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visit_estimate(&mut self.estimate, visitor);
        long_real(&mut self.cycles, visitor);
    }
}
