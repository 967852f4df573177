//! A filter over a table that keeps all its answers.

use super::TrackingOptions;
use super::measurements::Measurements;
use super::run::{TrackedFrame, measured, tracked};
use super::walk::{Answer, Walk};
use crate::cyclic::AngleTable;
use crate::cyclic::smoothing::replace_estimates;
use crate::error::Result;
use crate::resume::List;
use sinew_core::cyclic::MotionModel;
use sinew_core::saved_state::{SavedState, StateVisitor};

/// A filter with its answers to the rows of a table.
#[derive(Debug)]
pub(super) struct Kept<'a, const N: usize> {
    table: &'a AngleTable,
    /// Index of the first row with an angle.
    first: usize,
    walk: Walk<'a, N>,
    answers: Vec<Answer<N>>,
}

impl<'a, const N: usize> Kept<'a, N> {
    /// A filter that has answered the rows up to the first one with an angle.
    ///
    /// # Errors
    /// An option out of range, a rate so low that a step is too long, a table without any angle.
    pub fn begin(table: &'a AngleTable, view: MotionModel<'a>, options: &'a TrackingOptions) -> Result<Self> {
        let measurements = Measurements::new(table, &view, options)?;
        let first = measurements.first();
        let frames = [table.first_frame(), table.rows()[first].frame];
        let walk = Walk::begin(view, options, frames, &measurements.first_angles_rad())?;
        // Rows before the first one with an angle are answered with the first state as well.
        let answers = vec![walk.first_answer(); first + 1];
        Ok(Self { table, first, walk, answers })
    }

    /// Frames per second of the recording, and frames of the model in one of these.
    pub const fn rates(&self) -> (f64, f64) {
        (self.walk.steps().rate_hz(), self.walk.steps().step_frames())
    }

    /// Index of the first row with an angle.
    pub const fn first(&self) -> usize {
        self.first
    }

    /// Rows that are answered.
    pub const fn finished(&self) -> usize {
        self.answers.len()
    }

    /// Answers the next row; there has to be one.
    ///
    /// # Errors
    /// None for rows of the table.
    pub fn step(&mut self) -> Result<()> {
        let index = self.answers.len();
        let answer = self.walk.step(self.table.rows()[index].frame, &measured(self.table, index))?;
        self.answers.push(answer);
        Ok(())
    }

    /// After a saved state: goes on behind the last answer.
    pub fn go_on(&mut self) {
        if let Some(row) = self.table.rows().get(self.answers.len().saturating_sub(1)) {
            self.walk.go_on_after(row.frame);
        }
    }

    /// The answers as if the table ended with the last row that is answered.
    pub fn frames(&self) -> Vec<TrackedFrame> {
        let rows = self.table.rows().iter().zip(&self.answers);
        let mut frames: Vec<TrackedFrame> =
            rows.map(|(row, answer)| tracked(row.frame, &answer.estimate, answer.cycles)).collect();
        // Before its first measurement a filter knows nothing.
        frames[..self.first].iter_mut().for_each(|frame| frame.is_known = false);
        if let Some(smoothed) = self.walk.smoothed() {
            replace_estimates(&mut frames[self.first..], &smoothed);
            let start = frames[self.first].clone();
            for frame in &mut frames[..self.first] {
                *frame = TrackedFrame { frame: frame.frame, is_known: false, ..start.clone() };
            }
        }
        frames
    }
}

impl<const N: usize> SavedState for Kept<'_, N> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        self.walk.visit(visitor);
        let mut answers = List::new(std::mem::take(&mut self.answers), self.walk.first_answer());
        answers.visit(visitor);
        self.answers = answers.entries;
    }
}
