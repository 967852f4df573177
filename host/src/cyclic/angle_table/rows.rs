//! The rows of an angle table, read one after another.

use super::clock::Clock;
use super::columns::{ANGLES, COLUMNS, MAX_FRAME, SIDE_COLUMNS, TIME_COLUMN};
use super::own_sides::OwnSides;
use crate::csv_text::{RecordError, RecordReader};
use crate::cyclic::error::CyclicError;
use crate::file::open;
use std::collections::VecDeque;
use std::io::Read;
use std::path::{Path, PathBuf};

/// What is said of a table without rows.
const EMPTY: &str = "the table is empty; at least one frame has to follow the header";

/// One frame of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct AngleRow {
    /// Number of the frame in the recording.
    pub frame: u64,
    /// Angle of each joint about its parent in image axes (x right, y down), radians; `None` is a
    /// missing measurement.
    pub angles_rad: [Option<f64>; ANGLES],
    /// Cells of [`super::AngleTable::extra_columns`], as they stand in the file.
    pub extra: Vec<String>,
}

/// A row with its angles out of the plane, if the table has them.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadRow {
    /// The frame with the angles in the plane.
    pub row: AngleRow,
    /// The angles out of the plane.
    pub side_rad: Option<[Option<f64>; ANGLES]>,
}

impl ReadRow {
    /// Angle `angle` (of [`super::angle_columns`]); `None` where it is missing.
    #[must_use]
    pub fn angle_rad(&self, angle: usize) -> Option<f64> {
        match angle.checked_sub(ANGLES) {
            None => *self.row.angles_rad.get(angle)?,
            Some(side) => *self.side_rad.as_ref()?.get(side)?,
        }
    }
}

/// Reads the rows of a table, of which only one is in memory. Frame numbers rise.
#[derive(Debug)]
pub struct AngleRows<R> {
    path: PathBuf,
    records: RecordReader<R>,
    width: usize,
    extra_columns: Vec<String>,
    is_spatial: bool,
    /// Where the time stands among the extra columns.
    time: Option<usize>,
    own_sides: Option<OwnSides>,
    clock: Clock,
    last_frame: Option<u64>,
    /// Rows that were read ahead.
    ahead: VecDeque<ReadRow>,
}

impl AngleRows<Box<dyn Read>> {
    /// The rows of a file, or of standard input.
    ///
    /// # Errors
    /// As [`AngleRows::new`].
    pub fn open(path: &Path) -> Result<Self, CyclicError> {
        let table = open(path).map_err(|reason| CyclicError::Unreadable { path: path.to_path_buf(), reason })?;
        Self::new(table, path)
    }
}

impl<R: Read> AngleRows<R> {
    /// Reads the header; `path` is for messages only.
    ///
    /// # Errors
    /// The table cannot be read, or its columns are not those of an angle table.
    pub fn new(table: R, path: &Path) -> Result<Self, CyclicError> {
        let mut records = RecordReader::new(table);
        let Some(header) = records.next().map_err(|error| unread(path, error))? else {
            let rule = format!("the table is empty; its first line has to be {}", COLUMNS.join(","));
            return Err(CyclicError::broken(path, 1, rule));
        };
        let mut extra_columns = extra_columns(&header, path)?;
        let is_spatial = is_spatial(&extra_columns, path)?;
        extra_columns.drain(..if is_spatial { ANGLES } else { 0 });
        let time = extra_columns.iter().position(|name| name == TIME_COLUMN);
        time.map(|index| extra_columns.remove(index));
        let own_sides = OwnSides::of_old_table(&mut extra_columns);
        let (path, width) = (path.to_path_buf(), header.len());
        let (clock, ahead) = (Clock::default(), VecDeque::new());
        Ok(Self { path, records, width, extra_columns, is_spatial, time, own_sides, clock, last_frame: None, ahead })
    }

    /// Whether there are more rows than `count`, of which so many are read.
    ///
    /// # Errors
    /// As [`AngleRows::next_row`].
    pub fn has_more_than(mut self, count: usize) -> Result<bool, CyclicError> {
        for _ in 0..=count {
            if self.next_row()?.is_none() {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Whether there are two angles a joint.
    #[must_use]
    pub const fn is_spatial(&self) -> bool {
        self.is_spatial
    }

    /// Frames per second, of the times of the rows so far, or of the first two where less were
    /// read; `None` where the table has no times.
    ///
    /// # Errors
    /// As [`AngleRows::next_row`].
    pub fn rate_hz(&mut self) -> Result<Option<f64>, CyclicError> {
        while self.time.is_some() && self.clock.rate_hz().is_none() {
            let Some(row) = self.read_row()? else { break };
            self.ahead.push_back(row);
        }
        Ok(self.clock.rate_hz())
    }

    /// Names of the columns after the angles, without the time.
    #[must_use]
    pub fn into_extra_columns(self) -> Vec<String> {
        self.extra_columns
    }

    /// The next row; `None` after the last, of which there is at least one.
    ///
    /// # Errors
    /// The row breaks a rule, which is named with file and line, or cannot be read.
    pub fn next_row(&mut self) -> Result<Option<ReadRow>, CyclicError> {
        match self.ahead.pop_front() {
            Some(row) => Ok(Some(row)),
            None => self.read_row(),
        }
    }

    fn read_row(&mut self) -> Result<Option<ReadRow>, CyclicError> {
        let path = &self.path;
        let Some(record) = self.records.next().map_err(|error| unread(path, error))? else {
            let is_empty = self.last_frame.is_none();
            return if is_empty { Err(CyclicError::broken(path, 2, EMPTY)) } else { Ok(None) };
        };
        let mut row = row(&record, self.width, path)?;
        let mut side_rad = None;
        if self.is_spatial {
            let cells: Vec<String> = row.extra.drain(..ANGLES).collect();
            side_rad = Some(angles(cells.iter().map(String::as_str), &SIDE_COLUMNS, line_of(&record), path)?);
        }
        if let Some(before) = self.last_frame.filter(|before| row.frame <= *before) {
            let rule = format!("frame {} follows frame {before}; frame numbers have to rise", row.frame);
            return Err(CyclicError::broken(path, line_of(&record), rule));
        }
        self.last_frame = Some(row.frame);
        let time_s = match self.time {
            Some(index) => finite_cell(&row.extra.remove(index))
                .map_err(|rule| CyclicError::broken(path, line_of(&record), format!("`{TIME_COLUMN}` {rule}")))?,
            None => None,
        };
        if let Some(time_s) = time_s {
            let checked = self.clock.add(row.frame, time_s);
            checked.map_err(|rule| CyclicError::broken(path, line_of(&record), rule))?;
        }
        if let Some(own_sides) = &self.own_sides {
            own_sides.restore(&mut row.angles_rad, &mut row.extra);
        }
        Ok(Some(ReadRow { row, side_rad }))
    }
}

fn unread(path: &Path, error: RecordError) -> CyclicError {
    match error {
        RecordError::Io(reason) => CyclicError::Unreadable { path: path.to_path_buf(), reason },
        RecordError::TooLong { line } | RecordError::Broken { line, .. } => {
            CyclicError::broken(path, line, error.to_string())
        }
    }
}

fn line_of(record: &csv::StringRecord) -> u64 {
    record.position().map_or(0, csv::Position::line)
}

fn extra_columns(header: &csv::StringRecord, path: &Path) -> Result<Vec<String>, CyclicError> {
    for (index, wanted) in COLUMNS.iter().enumerate() {
        let found = header.get(index).unwrap_or("nothing");
        if found != *wanted {
            let rule = format!(
                "column {} has to be `{wanted}`, found `{found}`; an angle table begins with {}",
                index + 1,
                COLUMNS.join(",")
            );
            return Err(CyclicError::broken(path, line_of(header).max(1), rule));
        }
    }
    Ok(header.iter().skip(COLUMNS.len()).map(str::to_owned).collect())
}

fn row(record: &csv::StringRecord, width: usize, path: &Path) -> Result<AngleRow, CyclicError> {
    let line = line_of(record);
    if record.len() != width {
        let rule = format!("a row needs {width} columns as the header has, found {}", record.len());
        return Err(CyclicError::broken(path, line, rule));
    }
    let frame = record[0].parse().ok().filter(|frame| *frame <= MAX_FRAME).ok_or_else(|| {
        let rule = format!("`frame` has to be a whole number from 0 to {MAX_FRAME}, found `{}`", &record[0]);
        CyclicError::broken(path, line, rule)
    })?;
    let angles_rad = angles(record.iter().skip(1), &COLUMNS[1..], line, path)?;
    Ok(AngleRow { frame, angles_rad, extra: record.iter().skip(COLUMNS.len()).map(str::to_owned).collect() })
}

/// Angles of the cells under `names`.
fn angles<'a>(
    cells: impl Iterator<Item = &'a str>,
    names: &[&str],
    line: u64,
    path: &Path,
) -> Result<[Option<f64>; ANGLES], CyclicError> {
    let mut angles_rad = [None; ANGLES];
    for ((angle, cell), name) in angles_rad.iter_mut().zip(cells).zip(names) {
        *angle = finite_cell(cell).map_err(|rule| CyclicError::broken(path, line, format!("`{name}` {rule}")))?;
    }
    Ok(angles_rad)
}

/// Whether the columns after the first angles are [`SIDE_COLUMNS`]: all of them in their order, or
/// none.
fn is_spatial(extra_columns: &[String], path: &Path) -> Result<bool, CyclicError> {
    let is_side = |name: &String| SIDE_COLUMNS.contains(&name.as_str());
    if !extra_columns.iter().any(is_side) {
        return Ok(false);
    }
    if extra_columns.len() >= ANGLES && extra_columns[..ANGLES] == SIDE_COLUMNS {
        return Ok(true);
    }
    let rule = format!("side angles have to be all 13 right after `{}`: {}", COLUMNS[ANGLES], SIDE_COLUMNS.join(","));
    Err(CyclicError::broken(path, 1, rule))
}

/// A cell that is empty (missing) or a finite number.
fn finite_cell(cell: &str) -> Result<Option<f64>, String> {
    if cell.is_empty() {
        return Ok(None);
    }
    match cell.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(Some(value)),
        Ok(_) => Err(format!("is `{cell}`, but has to be finite; leave the cell empty if it is missing")),
        Err(_) => Err(format!("has to be a number, found `{cell}`; leave the cell empty if it is missing")),
    }
}
