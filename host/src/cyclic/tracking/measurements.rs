//! The rows of an angle table as a filter gets them.

use super::TrackingOptions;
use super::run::{first_seen, measured, step_of};
use crate::cyclic::AngleTable;
use crate::error::{Result, ensure};
use sinew_core::cyclic::measurement::MAX_STEP_FRAMES;
use sinew_core::cyclic::{AngleMeasurement, MotionModel};

/// Measurements of `N` angles, from the first row with an angle on.
#[derive(Debug, Clone, Copy)]
pub struct Measurements<'a, const N: usize> {
    table: &'a AngleTable,
    options: &'a TrackingOptions,
    rate_hz: f64,
    step_frames: f64,
    first: usize,
}

impl<'a, const N: usize> Measurements<'a, N> {
    /// Checks what does not depend on the number of angles.
    ///
    /// # Errors
    /// An option out of range, a rate so low that a step is too long, a table without any angle.
    pub fn new(table: &'a AngleTable, view: &MotionModel<'_>, options: &'a TrackingOptions) -> Result<Self> {
        options.check()?;
        let model_hz = f64::from(view.rate_hz());
        let rate_hz = options.rate_hz.unwrap_or(model_hz);
        let step_frames = model_hz / rate_hz;
        ensure!(
            step_frames <= f64::from(MAX_STEP_FRAMES),
            "`--rate {rate_hz}`: one frame is {step_frames:.0} of the model's; at most {MAX_STEP_FRAMES} can be bridged"
        );
        Ok(Self { table, options, rate_hz, step_frames, first: first_seen(table)? })
    }

    /// Frames per second of the recording.
    #[must_use]
    pub const fn rate_hz(&self) -> f64 {
        self.rate_hz
    }

    /// Frames of the model's rate in one of the recording's.
    #[must_use]
    pub const fn step_frames(&self) -> f64 {
        self.step_frames
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
        let (before, row) = (&rows[index - 1], &rows[index]);
        let used = self.options.updates.uses(self.table.first_frame(), row.frame);
        let angles_rad = if used { measured(self.table, index) } else { [None; N] };
        let step = step_of(before, row, self.step_frames);
        Ok(AngleMeasurement::new(&angles_rad, self.options.sigma_rad as f32)?.after(step as f32)?)
    }

    /// Frame number and measurement of each row from the first on.
    pub fn iter(&self) -> impl Iterator<Item = Result<(u64, AngleMeasurement<N>)>> + '_ {
        let frame = |index: usize| self.table.rows()[index].frame;
        let first = AngleMeasurement::new(&self.first_angles_rad(), self.options.sigma_rad as f32);
        let first = first.map(|measurement| (frame(self.first), measurement)).map_err(Into::into);
        let later = (self.first + 1..self.table.rows().len()).map(move |index| Ok((frame(index), self.at(index)?)));
        std::iter::once(first).chain(later)
    }
}
