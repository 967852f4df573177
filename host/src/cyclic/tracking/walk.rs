//! One filter on its way over an angle table, row by row.

use super::filter::{Filter, Pass};
use super::measurements::Measurements;
use super::options::TrackingOptions;
use super::run::{TrackedFrame, cycles, tracked};
use super::saved_estimate::visit_estimate;
use crate::cyclic::AngleTable;
use crate::cyclic::smoothing::replace_estimates;
use crate::error::Result;
use crate::resume::{List, long_real};
use sinew_core::cyclic::events::CycleCounter;
use sinew_core::cyclic::{CyclicEstimate, MotionModel};
use sinew_core::saved_state::{SavedState, StateVisitor};

/// A filter for `N` angles that begins at the first row with an angle.
#[derive(Debug)]
pub(super) struct Walk<'a, const N: usize> {
    table: &'a AngleTable,
    measurements: Measurements<'a, N>,
    filter: Filter<'a, N>,
    /// The states for the way back, if there is one.
    pass: Option<Pass<'a, N>>,
    counter: CycleCounter,
    answers: Vec<Answer<N>>,
}

/// What the filter answered to a row.
#[derive(Debug, Clone, PartialEq)]
struct Answer<const N: usize> {
    estimate: CyclicEstimate<N>,
    /// Cycles since the first row with an angle.
    cycles: f64,
}

impl<'a, const N: usize> Walk<'a, N> {
    /// A filter that has answered the rows up to the first one with an angle.
    ///
    /// # Errors
    /// An option out of range, a rate so low that a step is too long, a table without any angle.
    pub fn begin(table: &'a AngleTable, view: MotionModel<'a>, options: &'a TrackingOptions) -> Result<Self> {
        let measurements = Measurements::new(table, &view, options)?;
        let filter = Filter::new(view, options, &measurements.first_angles_rad(), measurements.step_frames())?;
        // Rows before the first one with an angle are answered with the first state as well.
        let estimate = filter.first_estimate();
        let answers = vec![Answer { estimate, cycles: 0.0 }; measurements.first() + 1];
        let pass = if options.smooth { Pass::begin(&filter) } else { None };
        Ok(Self { table, measurements, filter, pass, counter: CycleCounter::new(estimate.cycle_position), answers })
    }

    /// The measurements.
    pub const fn measurements(&self) -> &Measurements<'a, N> {
        &self.measurements
    }

    /// Rows that are answered.
    pub fn finished(&self) -> usize {
        self.answers.len()
    }

    /// Answers the next row; there has to be one.
    ///
    /// # Errors
    /// None for rows of the table.
    pub fn step(&mut self) -> Result<()> {
        let measurement = self.measurements.at(self.answers.len())?;
        let estimate = self.filter.step(&measurement);
        if let Some(pass) = &mut self.pass {
            pass.add(&self.filter, measurement);
        }
        let velocity = estimate.cycle_velocity_per_frame;
        self.counter.advance(estimate.cycle_position, velocity, measurement.step_frames());
        self.answers.push(Answer { estimate, cycles: cycles(&self.counter) });
        Ok(())
    }

    /// The answers as if the table ended with the last row that is answered.
    pub fn frames(&self) -> Vec<TrackedFrame> {
        let rows = self.table.rows().iter().zip(&self.answers);
        let mut frames: Vec<TrackedFrame> =
            rows.map(|(row, answer)| tracked(row.frame, &answer.estimate, answer.cycles)).collect();
        if let Some(pass) = &self.pass {
            let first = self.measurements.first();
            replace_estimates(&mut frames[first..], &pass.smoothed());
            let start = frames[first].clone();
            for frame in &mut frames[..first] {
                *frame = TrackedFrame { frame: frame.frame, ..start.clone() };
            }
        }
        frames
    }
}

impl<const N: usize> SavedState for Walk<'_, N> {
    /// Without the states for the way back.
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        self.filter.visit(visitor);
        self.counter.visit(visitor);
        let fill = Answer { estimate: self.filter.first_estimate(), cycles: 0.0 };
        let mut answers = List::new(std::mem::take(&mut self.answers), fill);
        answers.visit(visitor);
        self.answers = answers.entries;
    }
}

impl<const N: usize> SavedState for Answer<N> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visit_estimate(&mut self.estimate, visitor);
        long_real(&mut self.cycles, visitor);
    }
}
