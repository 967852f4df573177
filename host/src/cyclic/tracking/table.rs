//! The estimates as a CSV table: the columns of an angle table first, so that every tool for those
//! reads it.

use super::run::{Tracked, TrackedFrame};
use crate::cyclic::angle_table::{ANGLES, COLUMNS, SPACE_ANGLES, TIME_COLUMN, angle_columns, time_cell};
use crate::error::{Error, Result};
use crate::output::write_atomically;
use std::fmt::{Arguments, Write as _};
use std::io::Write;
use std::path::Path;

/// Columns after the angles.
pub const ESTIMATE_COLUMNS: [&str; 9] = [
    "cycle_position",
    "cycle_velocity_per_frame",
    "cadence_per_min",
    "log_likelihood",
    "outlier",
    "cadence_std_per_min",
    "cycles",
    "misfit",
    TIME_COLUMN,
];

/// Columns at the end where several motions were tracked.
pub const MOTION_COLUMNS: [&str; 2] = ["motion", "motion_probability"];
/// What stands in the column `motion` where it is none of them.
pub const NO_MOTION: &str = "none";

/// Name and probability of the motion of each row.
pub type MotionCells = Vec<(String, f64)>;

/// A table of estimates that grows row by row.
///
/// After [`ESTIMATE_COLUMNS`] come the angles' standard deviations. A model with two angles a joint
/// gives the angles out of the plane after those in it. Motions, if there are any, come last.
/// `cycle_velocity_per_frame` is per frame of the recording; `outlier` and `misfit` are 0 or 1. A
/// row about which nothing is known has its frame and time, and motions, alone.
#[derive(Debug)]
pub struct EstimateTable<W: Write> {
    writer: csv::Writer<W>,
    rate_hz: f64,
    step_frames: f64,
    /// The text of one cell.
    cell: String,
}

impl<W: Write> EstimateTable<W> {
    /// Begins a table with its header; rates as in [`Tracked`].
    ///
    /// # Errors
    /// It cannot be written.
    pub fn begin(
        mut writer: csv::Writer<W>,
        (rate_hz, step_frames): (f64, f64),
        is_spatial: bool,
        has_motions: bool,
    ) -> Result<Self> {
        let count = if is_spatial { SPACE_ANGLES } else { ANGLES };
        let columns = COLUMNS[..1].iter().copied().chain(angle_columns().take(count)).chain(ESTIMATE_COLUMNS);
        let std_columns = angle_columns().take(count).map(|name| name.replace("_rad", "_std_rad"));
        let motion_columns = MOTION_COLUMNS.into_iter().filter(|_| has_motions).map(str::to_owned);
        writer.write_record(columns.map(str::to_owned).chain(std_columns).chain(motion_columns))?;
        Ok(Self::go_on(writer, (rate_hz, step_frames)))
    }

    /// Goes on with a table that was begun.
    #[must_use]
    pub const fn go_on(writer: csv::Writer<W>, (rate_hz, step_frames): (f64, f64)) -> Self {
        Self { writer, rate_hz, step_frames, cell: String::new() }
    }

    /// Adds a row, with name and probability of its motion where several are told apart.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn add(&mut self, frame: &TrackedFrame, motion: Option<&(String, f64)>) -> Result<()> {
        self.put(format_args!("{}", frame.frame))?;
        let side = frame.side.as_ref();
        let side_angles = side.iter().flat_map(|side| side.angles_rad);
        for angle_rad in frame.angles_rad.into_iter().chain(side_angles) {
            self.put_known(frame, format_args!("{angle_rad:.6}"))?;
        }
        self.put_derived(frame)?;
        self.put(format_args!("{}", time_cell(frame.frame as f64 / self.rate_hz)))?;
        let side_variances = side.iter().flat_map(|side| &side.angle_variance_rad2);
        for variance_rad2 in frame.estimate.angle_variance_rad2.iter().chain(side_variances) {
            self.put_known(frame, format_args!("{:.6}", variance_rad2.max(0.0).sqrt()))?;
        }
        if let Some((name, probability)) = motion {
            self.put(format_args!("{name}"))?;
            self.put(format_args!("{probability:.6}"))?;
        }
        Ok(self.writer.write_record(None::<&[u8]>)?)
    }

    /// The cells of [`ESTIMATE_COLUMNS`] before the time.
    fn put_derived(&mut self, frame: &TrackedFrame) -> Result<()> {
        let estimate = &frame.estimate;
        let velocity = f64::from(estimate.cycle_velocity_per_frame) * self.step_frames;
        let velocity_std = f64::from(estimate.cycle_velocity_variance.max(0.0).sqrt()) * self.step_frames;
        let per_min = 60.0 * self.rate_hz;
        self.put_known(frame, format_args!("{:.6}", position_in_text(f64::from(estimate.cycle_position))))?;
        self.put_known(frame, format_args!("{velocity:.8}"))?;
        self.put_known(frame, format_args!("{:.4}", velocity * per_min))?;
        self.put_known(frame, format_args!("{:.4}", estimate.log_likelihood))?;
        self.put_known(frame, format_args!("{}", u8::from(estimate.outlier)))?;
        self.put_known(frame, format_args!("{:.4}", velocity_std * per_min))?;
        self.put_known(frame, format_args!("{:.5}", frame.cycles))?;
        self.put_known(frame, format_args!("{}", u8::from(estimate.misfit)))
    }

    /// A cell that is empty where nothing is known of the frame.
    fn put_known(&mut self, frame: &TrackedFrame, cell: Arguments<'_>) -> Result<()> {
        if frame.is_known { self.put(cell) } else { Ok(self.writer.write_field("")?) }
    }

    fn put(&mut self, cell: Arguments<'_>) -> Result<()> {
        self.cell.clear();
        // Writing to a string cannot fail.
        let _ = self.cell.write_fmt(cell);
        Ok(self.writer.write_field(&self.cell)?)
    }

    /// The writer beneath.
    pub const fn writer(&mut self) -> &mut csv::Writer<W> {
        &mut self.writer
    }

    /// The writer beneath, after the last row.
    pub fn into_writer(self) -> csv::Writer<W> {
        self.writer
    }
}

/// Writes the table of a whole run under a temporary name, then renames it.
///
/// # Errors
/// Names the path with what the operating system refused.
pub fn write(tracked: &Tracked, motions: Option<&MotionCells>, path: &Path) -> Result<()> {
    write_atomically(path, |writer| write_to(tracked, motions, writer))
}

/// The text of the table of a whole run.
///
/// # Errors
/// None in practice: text can always be written to memory.
pub fn to_csv(tracked: &Tracked, motions: Option<&MotionCells>) -> Result<String> {
    let mut bytes = Vec::new();
    write_to(tracked, motions, &mut bytes)?;
    String::from_utf8(bytes).map_err(Error::invalid)
}

fn write_to(tracked: &Tracked, motions: Option<&MotionCells>, writer: &mut dyn Write) -> Result<()> {
    let is_spatial = tracked.frames.iter().any(|frame| frame.side.is_some());
    let rates = (tracked.rate_hz, tracked.step_frames);
    let mut table = EstimateTable::begin(csv::Writer::from_writer(writer), rates, is_spatial, motions.is_some())?;
    for (index, frame) in tracked.frames.iter().enumerate() {
        table.add(frame, motions.and_then(|motions| motions.get(index)))?;
    }
    Ok(table.into_writer().flush()?)
}

/// What six decimals leave in [0, 1): what would round up to one is the start of the next cycle.
fn position_in_text(position: f64) -> f64 {
    if position < 0.999_999_5 { position } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_position_stays_below_one_in_text() {
        assert_eq!(
            [0.0, 0.25, 0.999_999_4, 0.999_999_9].map(|position| format!("{:.6}", position_in_text(position))),
            ["0.000000", "0.250000", "0.999999", "0.000000"]
        );
    }
}
