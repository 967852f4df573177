//! Angle tables: one row a frame, the 13 angles of the stick figure in radians, an empty cell where
//! one is missing.

use super::error::{CyclicError, read_text};
use crate::csv_text::csv_reader;
use crate::error::{Error, Result};
use crate::output::write_atomically;
use std::path::Path;

/// Angles of the stick figure.
pub const ANGLES: usize = 13;
/// First columns of every table: the frame, then the angles in the order of the stick figure's
/// joints.
pub const COLUMNS: [&str; ANGLES + 1] = [
    "frame",
    "neck_rad",
    "l_shoulder_rad",
    "l_elbow_rad",
    "l_wrist_rad",
    "r_shoulder_rad",
    "r_elbow_rad",
    "r_wrist_rad",
    "l_hip_rad",
    "l_knee_rad",
    "l_ankle_rad",
    "r_hip_rad",
    "r_knee_rad",
    "r_ankle_rad",
];

/// Columns of a motion in space, right after [`COLUMNS`]: how far each segment points out of the
/// side view's plane, to the person's left, radians.
pub const SIDE_COLUMNS: [&str; ANGLES] = [
    "neck_side_rad",
    "l_shoulder_side_rad",
    "l_elbow_side_rad",
    "l_wrist_side_rad",
    "r_shoulder_side_rad",
    "r_elbow_side_rad",
    "r_wrist_side_rad",
    "l_hip_side_rad",
    "l_knee_side_rad",
    "l_ankle_side_rad",
    "r_hip_side_rad",
    "r_knee_side_rad",
    "r_ankle_side_rad",
];

/// Two angles a joint.
pub const SPACE_ANGLES: usize = 2 * ANGLES;

/// Columns of all angles: in the plane, then out of it.
pub fn angle_columns() -> impl Iterator<Item = &'static str> {
    COLUMNS[1..].iter().chain(&SIDE_COLUMNS).copied()
}

/// Largest number of a frame; more is taken for a mistake.
pub const MAX_FRAME: u64 = 1_000_000_000_000;

/// One frame of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct AngleRow {
    /// Number of the frame in the recording.
    pub frame: u64,
    /// Angle of each joint about its parent in image axes (x right, y down), radians; `None` is a
    /// missing measurement.
    pub angles_rad: [Option<f64>; ANGLES],
    /// Cells of [`AngleTable::extra_columns`], as they stand in the file.
    pub extra: Vec<String>,
}

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
        Ok(Self { rows, extra_columns, side_rad: None })
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
        let mut reader = csv_reader(text);
        let mut records = reader.records();
        let Some(header) = records.next() else {
            return Err(CyclicError::broken(
                path,
                1,
                format!("the table is empty; its first line has to be {}", COLUMNS.join(",")),
            ));
        };
        let header = header.map_err(|error| csv_error(path, &error))?;
        let mut extra_columns = extra_columns(&header, path)?;
        let mut side_rad: Option<Vec<[Option<f64>; ANGLES]>> = is_spatial(&extra_columns, path)?.then(Vec::new);
        extra_columns.drain(..if side_rad.is_some() { ANGLES } else { 0 });
        let mut rows: Vec<AngleRow> = Vec::new();
        for record in records {
            let record = record.map_err(|error| csv_error(path, &error))?;
            let mut row = row(&record, header.len(), path)?;
            if let Some(side_rad) = &mut side_rad {
                let cells: Vec<String> = row.extra.drain(..ANGLES).collect();
                side_rad.push(angles(cells.iter().map(String::as_str), &SIDE_COLUMNS, line_of(&record), path)?);
            }
            if let Some(before) = rows.last().filter(|before| row.frame <= before.frame) {
                let rule = format!("frame {} follows frame {}; frame numbers have to rise", row.frame, before.frame);
                return Err(CyclicError::broken(path, line_of(&record), rule));
            }
            rows.push(row);
        }
        if rows.is_empty() {
            return Err(CyclicError::broken(
                path,
                2,
                "the table is empty; at least one frame has to follow the header",
            ));
        }
        Ok(Self { rows, extra_columns, side_rad })
    }

    /// The text of the CSV file, angles with six decimals.
    ///
    /// # Errors
    /// None in practice: text can always be written to memory.
    pub fn to_csv(&self) -> Result<String> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let columns = std::iter::once(COLUMNS[0]).chain(angle_columns().take(self.angle_count())).map(str::to_owned);
        writer.write_record(columns.chain(self.extra_columns.iter().cloned()))?;
        for (index, row) in self.rows.iter().enumerate() {
            let angle = |angle: Option<f64>| angle.map_or_else(String::new, |angle| format!("{angle:.6}"));
            let angles = (0..self.angle_count()).map(|column| angle(self.row_angle_rad(index, column)));
            writer
                .write_record(std::iter::once(row.frame.to_string()).chain(angles).chain(row.extra.iter().cloned()))?;
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

fn line_of(record: &csv::StringRecord) -> u64 {
    record.position().map_or(0, csv::Position::line)
}

fn csv_error(path: &Path, error: &csv::Error) -> CyclicError {
    CyclicError::broken(path, error.position().map_or(0, csv::Position::line), error.to_string())
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
pub(crate) fn finite_cell(cell: &str) -> Result<Option<f64>, String> {
    if cell.is_empty() {
        return Ok(None);
    }
    match cell.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(Some(value)),
        Ok(_) => Err(format!("is `{cell}`, but has to be finite; leave the cell empty if it is missing")),
        Err(_) => Err(format!("has to be a number, found `{cell}`; leave the cell empty if it is missing")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn parsed(rows: &str) -> Result<AngleTable, CyclicError> {
        AngleTable::parse(&format!("{}\n{rows}", COLUMNS.join(",")), Path::new("t.csv"))
    }

    #[test]
    fn empty_cells_and_left_out_frames_are_missing() {
        let table = parsed("3,1,,3,4,5,6,7,8,9,10,11,12,13\n7,1,2,3,4,5,6,7,8,9,10,11,12,-13.5\n").unwrap();
        assert_eq!((table.first_frame(), table.end_frame()), (3, 8));
        assert_eq!(table.row(3).unwrap().angles_rad[1], None);
        assert_eq!(table.row(7).unwrap().angles_rad[12], Some(-13.5));
        assert!(table.row(4).is_none());
    }

    #[test]
    fn extra_columns_are_kept() {
        let text =
            format!("\u{feff}{},hip_center_u_px\r\n0,1,2,3,4,5,6,7,8,9,10,11,12,13,320.5\r\n", COLUMNS.join(","));
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("t.csv");
        std::fs::write(&path, text).unwrap();
        let table = AngleTable::read(&path).unwrap();
        assert_eq!(
            (table.extra_columns(), table.rows()[0].extra.as_slice()),
            (&["hip_center_u_px".to_owned()][..], &["320.5".to_owned()][..])
        );
        table.write(&path).unwrap();
        assert_eq!(AngleTable::read(&path).unwrap(), table);
    }

    #[test]
    fn two_angles_a_joint_are_read_and_written_and_all_or_none() {
        let header = [&COLUMNS[..], &SIDE_COLUMNS[..], &["speed"]].concat().join(",");
        let row = (1..=26).map(|i| format!("{:.6}", f64::from(i))).collect::<Vec<_>>().join(",");
        let text = format!("{header}\n5,{row},9.5\n");
        let table = AngleTable::parse(&text, Path::new("t.csv")).unwrap();
        assert_eq!((table.angle_count(), table.extra_columns()), (26, &["speed".to_owned()][..]));
        assert_eq!(
            (table.angle_rad(5, 0), table.angle_rad(5, 13), table.angle_rad(5, 25)),
            (Some(1.0), Some(14.0), Some(26.0))
        );
        assert_eq!((table.angle_rad(5, 26), table.angle_rad(4, 0)), (None, None));
        assert_eq!(table.to_csv().unwrap(), text);
        let broken = text.replace(",20.000000,", ",x,");
        let message = AngleTable::parse(&broken, Path::new("t.csv")).unwrap_err().to_string();
        assert!(message.starts_with("t.csv:2: `r_wrist_side_rad` has to be a number"), "{message}");
        let some = text.replace("neck_side_rad,", "");
        let message = AngleTable::parse(&some, Path::new("t.csv")).unwrap_err().to_string();
        assert!(message.starts_with("t.csv:1: side angles have to be all 13"), "{message}");
    }

    #[test]
    fn broken_tables_name_file_line_and_rule() {
        let row = "0,1,2,3,4,5,6,7,8,9,10,11,12,13\n";
        let cases = [
            (format!("{row}1,NaN,2,3,4,5,6,7,8,9,10,11,12,13"), "t.csv:3: `neck_rad` is `NaN`, but has to be finite"),
            ("0,1,2,3,4,5,6,7,inf,9,10,11,12,13".into(), "t.csv:2: `l_hip_rad` is `inf`"),
            ("0,1,2,3,4,5,6,7,x,9,10,11,12,13".into(), "t.csv:2: `l_hip_rad` has to be a number, found `x`"),
            ("0,1,2,3".into(), "t.csv:2: a row needs 14 columns as the header has, found 4"),
            (
                format!("{row}1,1,2,3,4,5,6,7,8,9,10,11,12,13,14"),
                "t.csv:3: a row needs 14 columns as the header has, found 15",
            ),
            (format!("{row}{row}"), "t.csv:3: frame 0 follows frame 0"),
            ("-1,1,2,3,4,5,6,7,8,9,10,11,12,13".into(), "t.csv:2: `frame` has to be a whole number"),
            ("18446744073709551615,1,2,3,4,5,6,7,8,9,10,11,12,13".into(), "t.csv:2: `frame` has to be a whole number"),
            (String::new(), "t.csv:2: the table is empty"),
        ];
        for (rows, message) in cases {
            let found = parsed(&rows).unwrap_err().to_string();
            assert!(found.starts_with(message), "{found} does not start with {message}");
        }
        let header = AngleTable::parse("frame,neck\n", Path::new("t.csv")).unwrap_err().to_string();
        assert!(header.starts_with("t.csv:1: column 2 has to be `neck_rad`, found `neck`"), "{header}");
        let empty = AngleTable::parse("", Path::new("t.csv")).unwrap_err().to_string();
        assert!(empty.starts_with("t.csv:1: the table is empty"), "{empty}");
    }

    proptest! {
        #[test]
        fn a_table_survives_its_file(
            frames in prop::collection::btree_set(0_u64..1_000_000, 1..20),
            angle in -100.0..100.0_f64,
            missing in 0..ANGLES,
        ) {
            let mut angles_rad = [Some((angle * 1.0e6).round() / 1.0e6); ANGLES];
            angles_rad[missing] = None;
            let rows = frames.into_iter().map(|frame| AngleRow { frame, angles_rad, extra: Vec::new() }).collect();
            let table = AngleTable::new(rows, Vec::new()).unwrap();
            prop_assert_eq!(AngleTable::parse(&table.to_csv().unwrap(), Path::new("t.csv")).unwrap(), table);
        }
    }
}
