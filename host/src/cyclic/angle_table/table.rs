//! Angles over time.

use super::columns::{ANGLES, COLUMNS, MAX_FRAME, SPACE_ANGLES, TIME_COLUMN, angle_columns, time_cell};
use super::rows::{AngleRow, AngleRows};
use crate::cyclic::error::{CyclicError, read_text};
use crate::error::{Error, Result};
use crate::output::write_atomically;
use std::path::Path;

/// Angles over time.
///
/// Invariants: there is at least one row, and frame numbers rise from row to row. A number that is
/// left out is a frame without a measurement. Every angle is finite. Every row has as many extra
/// cells as there are extra columns. Either all rows have side angles or none.
#[derive(Debug, Clone, PartialEq)]
pub struct AngleTable {
    rows: Vec<AngleRow>,
    extra_columns: Vec<String>,
    /// Angles of [`SIDE_COLUMNS`], one entry a row.
    side_rad: Option<Vec<[Option<f64>; ANGLES]>>,
    /// Frames per second, if they are known.
    rate_hz: Option<f64>,
}

impl AngleTable {
    /// A table of `rows` with the extra columns of these names.
    ///
    /// # Errors
    /// Names the invariant of [`AngleTable`] that does not hold, and the frame.
    pub fn new(rows: Vec<AngleRow>, extra_columns: Vec<String>) -> Result<Self, CyclicError> {
        let refuse = |rule: String| Err(CyclicError::parameter("rows", rule));
        if rows.is_empty() {
            return refuse("need at least one frame".into());
        }
        if let Some(row) = rows.iter().find(|row| row.frame > MAX_FRAME) {
            return refuse(format!("need frame numbers up to {MAX_FRAME}, not {}", row.frame));
        }
        if let Some(pair) = rows.windows(2).find(|pair| pair[1].frame <= pair[0].frame) {
            return refuse(format!("have to rise in frame number: {} follows {}", pair[1].frame, pair[0].frame));
        }
        if let Some(row) = rows.iter().find(|row| row.angles_rad.iter().flatten().any(|angle| !angle.is_finite())) {
            return refuse(format!("need finite angles; frame {} has another", row.frame));
        }
        if let Some(row) = rows.iter().find(|row| row.extra.len() != extra_columns.len()) {
            let (found, wanted) = (row.extra.len(), extra_columns.len());
            return refuse(format!("need {wanted} extra cells; frame {} has {found}", row.frame));
        }
        Ok(Self { rows, extra_columns, side_rad: None, rate_hz: None })
    }

    /// The same with the angles out of the plane, one entry a row.
    ///
    /// # Errors
    /// As many entries as rows, all finite.
    pub fn with_side(mut self, side_rad: Vec<[Option<f64>; ANGLES]>) -> Result<Self, CyclicError> {
        if side_rad.len() != self.rows.len() || side_rad.iter().flatten().flatten().any(|angle| !angle.is_finite()) {
            let rule = format!("need {} rows of finite angles, found {}", self.rows.len(), side_rad.len());
            return Err(CyclicError::parameter("side angles", rule));
        }
        self.side_rad = Some(side_rad);
        Ok(self)
    }

    /// The same with its frames per second, which have to be greater than zero; they give each row
    /// its time.
    #[must_use]
    pub fn at_rate(mut self, rate_hz: Option<f64>) -> Self {
        self.rate_hz = rate_hz.filter(|rate| *rate > 0.0 && rate.is_finite());
        self
    }

    /// Frames per second; `None` where the table does not say.
    #[must_use]
    pub const fn rate_hz(&self) -> Option<f64> {
        self.rate_hz
    }

    /// The angles out of the plane, one entry a row; `None` for a motion in the plane.
    #[must_use]
    pub fn side_rad(&self) -> Option<&[[Option<f64>; ANGLES]]> {
        self.side_rad.as_deref()
    }

    /// Angles of a row: 13, or 26 of a motion in space.
    #[must_use]
    pub const fn angle_count(&self) -> usize {
        if self.side_rad.is_some() { SPACE_ANGLES } else { ANGLES }
    }

    /// Angle `angle` (of [`angle_columns`]) in `frame`; `None` where it is missing.
    #[must_use]
    pub fn angle_rad(&self, frame: u64, angle: usize) -> Option<f64> {
        let index = self.rows.binary_search_by_key(&frame, |row| row.frame).ok()?;
        self.row_angle_rad(index, angle)
    }

    /// Angle `angle` (of [`angle_columns`]) in the row at `index`; `None` where it is missing.
    #[must_use]
    pub fn row_angle_rad(&self, index: usize, angle: usize) -> Option<f64> {
        match angle.checked_sub(ANGLES) {
            None => *self.rows.get(index)?.angles_rad.get(angle)?,
            Some(side) => *self.side_rad.as_ref()?.get(index)?.get(side)?,
        }
    }

    /// A table without extra columns, frames counted from `first_frame`.
    ///
    /// # Errors
    /// As [`AngleTable::new`].
    pub fn from_angles(first_frame: u64, angles_rad: &[[Option<f64>; ANGLES]]) -> Result<Self, CyclicError> {
        let row = |(index, angles): (u64, &[Option<f64>; ANGLES])| AngleRow {
            frame: first_frame + index,
            angles_rad: *angles,
            extra: Vec::new(),
        };
        Self::new((0..).zip(angles_rad).map(row).collect(), Vec::new())
    }

    /// The rows, at least one, rising in frame number.
    #[must_use]
    pub fn rows(&self) -> &[AngleRow] {
        &self.rows
    }

    /// Names of the columns after the angles.
    #[must_use]
    pub fn extra_columns(&self) -> &[String] {
        &self.extra_columns
    }

    /// Number of the first frame.
    #[must_use]
    pub fn first_frame(&self) -> u64 {
        self.rows[0].frame
    }

    /// Number after the last frame.
    #[must_use]
    pub fn end_frame(&self) -> u64 {
        self.rows[self.rows.len() - 1].frame + 1
    }

    /// The row of `frame`, or `None` where the table leaves it out.
    #[must_use]
    pub fn row(&self, frame: u64) -> Option<&AngleRow> {
        let index = self.rows.binary_search_by_key(&frame, |row| row.frame).ok()?;
        self.rows.get(index)
    }

    /// Reads a table from a CSV file.
    ///
    /// # Errors
    /// Names the file, the line and the rule that it broke.
    pub fn read(path: &Path) -> Result<Self, CyclicError> {
        Self::parse(&read_text(path)?, path)
    }

    /// Parses the text of a table; `path` is for messages only.
    ///
    /// # Errors
    /// Names the file, the line and the rule that it broke.
    pub fn parse(text: &str, path: &Path) -> Result<Self, CyclicError> {
        let mut reader = AngleRows::new(text.as_bytes(), path)?;
        let mut side_rad = reader.is_spatial().then(Vec::new);
        let mut rows = Vec::new();
        while let Some(read) = reader.next_row()? {
            rows.push(read.row);
            if let (Some(all), Some(angles_rad)) = (&mut side_rad, read.side_rad) {
                all.push(angles_rad);
            }
        }
        let rate_hz = reader.rate_hz()?;
        Ok(Self { rows, extra_columns: reader.into_extra_columns(), side_rad, rate_hz })
    }

    /// The text of the CSV file, angles with six decimals.
    ///
    /// # Errors
    /// None in practice: text can always be written to memory.
    pub fn to_csv(&self) -> Result<String> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let columns = std::iter::once(COLUMNS[0]).chain(angle_columns().take(self.angle_count())).map(str::to_owned);
        let time = self.rate_hz.map(|_| TIME_COLUMN.to_owned());
        writer.write_record(columns.chain(time).chain(self.extra_columns.iter().cloned()))?;
        for (index, row) in self.rows.iter().enumerate() {
            let angle = |angle: Option<f64>| angle.map_or_else(String::new, |angle| format!("{angle:.6}"));
            let angles = (0..self.angle_count()).map(|column| angle(self.row_angle_rad(index, column)));
            let time = self.rate_hz.map(|rate_hz| time_cell(row.frame as f64 / rate_hz));
            let cells = std::iter::once(row.frame.to_string()).chain(angles).chain(time);
            writer.write_record(cells.chain(row.extra.iter().cloned()))?;
        }
        String::from_utf8(writer.into_inner()?).map_err(Error::invalid)
    }

    /// Writes the CSV file under a temporary name, then renames it.
    ///
    /// # Errors
    /// Names the path with what the operating system refused.
    pub fn write(&self, path: &Path) -> Result<()> {
        let text = self.to_csv()?;
        write_atomically(path, |writer| Ok(writer.write_all(text.as_bytes())?))
    }
}
