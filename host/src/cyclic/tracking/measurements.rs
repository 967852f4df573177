//! The rows of an angle table as a filter gets them.

use super::TrackingOptions;
use super::run::{first_seen, measured};
use super::steps::Steps;
use crate::cyclic::AngleTable;
use crate::error::Result;
use sinew_core::cyclic::{AngleMeasurement, MotionModel};

/// Measurements of `N` angles, from the first row with an angle on.
#[derive(Debug, Clone, Copy)]
pub struct Measurements<'a, const N: usize> {
    table: &'a AngleTable,
    steps: Steps<'a>,
    first: usize,
}

impl<'a, const N: usize> Measurements<'a, N> {
    /// Checks what does not depend on the number of angles.
    ///
    /// # Errors
    /// An option out of range, a rate so low that a step is too long, a table without any angle.
    pub fn new(table: &'a AngleTable, view: &MotionModel<'_>, options: &'a TrackingOptions) -> Result<Self> {
        Ok(Self { table, steps: Steps::new(view, options)?, first: first_seen(table)? })
    }

    /// Steps from row to row.
    #[must_use]
    pub const fn steps(&self) -> &Steps<'a> {
        &self.steps
    }

    /// Index of the first row with an angle.
    #[must_use]
    pub const fn first(&self) -> usize {
        self.first
    }

    /// The angles of the first row with an angle, used or not.
    #[must_use]
    pub fn first_angles_rad(&self) -> [Option<f32>; N] {
        measured(self.table, self.first)
    }

    /// The measurement of row `index` behind the first one.
    ///
    /// # Errors
    /// None for rows of the table.
    pub fn at(&self, index: usize) -> Result<AngleMeasurement<N>> {
        let rows = self.table.rows();
        let (before, frame) = (rows[index - 1].frame, rows[index].frame);
        self.steps.later(self.table.first_frame(), before, frame, &measured(self.table, index))
    }

    /// Frame number and measurement of each row from the first on.
    pub fn iter(&self) -> impl Iterator<Item = Result<(u64, AngleMeasurement<N>)>> + '_ {
        let frame = |index: usize| self.table.rows()[index].frame;
        let first = self.steps.first(&self.first_angles_rad()).map(|measurement| (frame(self.first), measurement));
        let later = (self.first + 1..self.table.rows().len()).map(move |index| Ok((frame(index), self.at(index)?)));
        std::iter::once(first).chain(later)
    }
}
