//! One row of a TRC file.

use crate::motion::error::{MotionError, parsed_number};
use sinew_core::math::Vec3;
use std::path::Path;

/// Columns before the markers: `Frame#` and `Time`.
const LEADING: usize = 2;
/// What programs write where a marker was not seen, lower case, beside empty cells and all that
/// begins with `nan`.
const MISSING: [&str; 7] = ["na", "n/a", "null", "none", "-", "--", "*"];
/// Numbers that C programs on Windows write for NaN: `-1.#IND`, `1.#QNAN`, `1.#SNAN`, some of them
/// cut (`-1.#J`).
const WINDOWS_NAN: [&str; 4] = ["#qnan", "#snan", "#ind", "#j"];
/// The place of a marker without data in files of Motion Analysis (EVaRT, Cortex), in any unit.
const EMPTY: f32 = 9_999_999.0;

/// A frame.
#[derive(Debug)]
pub struct Row {
    /// `Frame#`, where it is a whole number.
    pub frame: Option<u64>,
    /// `Time`, seconds.
    pub time_s: Option<f64>,
    /// Places of the markers `names`, in the file's unit.
    pub points: Vec<Option<Vec3>>,
}

impl Row {
    /// Parses a row of the markers `names`. Where it `ends` with its line, markers at its end may
    /// be left out: programs that trim tabs do so with empty cells.
    ///
    /// # Errors
    /// Columns are too many or too few, or a cell is no number.
    pub fn parse(row: &str, names: &[String], ends: bool, path: &Path, line: usize) -> Result<Self, MotionError> {
        let cells: Vec<&str> = row.split('\t').map(str::trim).collect();
        let wanted = LEADING + 3 * names.len();
        // Programs differ in tabs at the end of a row.
        let surplus_is_empty = cells.iter().skip(wanted).all(|cell| cell.is_empty());
        let is_trimmed = ends && cells.len() >= LEADING && (cells.len() - LEADING).is_multiple_of(3);
        if !surplus_is_empty || (cells.len() < wanted && !is_trimmed) {
            let rule = format!("a frame needs {wanted} columns, found {}", cells.len());
            return Err(MotionError::broken(path, line, rule));
        }
        let broken = |rule: String| MotionError::broken(path, line, rule);
        let mut points = vec![None; names.len()];
        for ((point, cells), name) in points.iter_mut().zip(cells[LEADING..].chunks_exact(3)).zip(names) {
            *point = place(cells).map_err(|rule| broken(format!("{rule} (marker `{name}`)")))?;
        }
        let frame = cells[0].parse::<f64>().ok().filter(|frame| frame.fract() == 0.0 && *frame >= 0.0);
        let time_s = cells[1].parse::<f64>().ok().filter(|time_s| time_s.is_finite());
        Ok(Self { frame: frame.map(|frame| frame as u64), time_s, points })
    }
}

/// A place of three cells; `None` where it was not seen.
fn place(cells: &[&str]) -> Result<Option<Vec3>, String> {
    if cells.iter().any(|cell| is_missing(cell)) {
        return Ok(None);
    }
    let place = Vec3::new(parsed_number(cells[0])?, parsed_number(cells[1])?, parsed_number(cells[2])?);
    let is_empty = place == Vec3::zeros() || place.iter().all(|value| *value >= EMPTY);
    Ok((!is_empty).then_some(place))
}

fn is_missing(cell: &str) -> bool {
    if cell.is_empty() {
        return true;
    }
    let is_digit = cell.as_bytes()[cell.len() - 1].is_ascii_digit() && !cell.contains('#');
    if is_digit {
        return false;
    }
    let lower = cell.to_ascii_lowercase();
    let unsigned = lower.trim_start_matches(['-', '+']);
    unsigned.starts_with("nan")
        || MISSING.contains(&lower.as_str())
        || WINDOWS_NAN.iter().any(|ending| lower.contains(ending))
}
