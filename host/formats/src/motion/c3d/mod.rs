//! C3D marker files: names, unit, rate and places of markers. Analog channels are not read.

mod labels;
mod layout;
mod parameters;
mod points;
#[cfg(test)]
mod tests;
mod words;

use super::error::MotionError;
use super::markers::{MarkerMotion, metres_per_unit};
use super::read_options::ReadOptions;
use super::shortfall::Shortfall;
use crate::file::read_bytes;
use crate::limits::{MAX_FILE_BYTES, MAX_NUMBER};
use layout::{BLOCK_BYTES, Layout};
use sinew_core::math::Vec3;
use std::path::Path;

/// Second byte of every C3D file.
pub const MAGIC: u8 = 0x50;

/// Reads the markers of a C3D file; see [`read_with`].
///
/// # Errors
/// As [`read_with`].
pub fn read(path: &Path) -> Result<MarkerMotion, MotionError> {
    read_with(path, &ReadOptions::default())
}

/// Reads the markers of a C3D file; points with a negative residual, with NaN, or exactly at the
/// origin, were not seen. Of `options` only `partial` counts.
///
/// # Errors
/// The file cannot be read, is no C3D file, is damaged or cut, or names no unit that is known.
pub fn read_with(path: &Path, options: &ReadOptions<'_>) -> Result<MarkerMotion, MotionError> {
    let bytes = read_bytes(path, MAX_FILE_BYTES).map_err(|error| MotionError::of_file(path, error))?;
    parse(&bytes, path, options)
}

/// Parses the content of a C3D file; `path` is for messages only.
fn parse(bytes: &[u8], path: &Path, options: &ReadOptions<'_>) -> Result<MarkerMotion, MotionError> {
    let broken = |rule: String| MotionError::broken(path, 0, rule);
    if bytes.len() < 2 * BLOCK_BYTES || bytes[1] != MAGIC {
        return Err(broken("this is no C3D file".into()));
    }
    let damaged = |rule: String| broken(format!("the C3D file is damaged ({rule})"));
    let (layout, parameters) = Layout::check(bytes).map_err(damaged)?;
    let shortfall = Shortfall::check(layout.held, layout.promised, options, path, 0)?;
    let names = labels::read(&parameters, layout.points);
    let units = parameters.texts("POINT", "UNITS");
    let unit: String = units.iter().take(1).flat_map(|unit| unit.chars()).filter(char::is_ascii_alphabetic).collect();
    let known_scale = metres_per_unit(&unit);
    if known_scale.is_none() && !unit.is_empty() {
        return Err(broken(format!("POINT:UNITS is `{unit}`; m, cm, mm and in are read")));
    }
    let rate_hz = labels::rate_hz(&parameters, layout.rate_hz);
    if !(rate_hz > 0.0 && rate_hz.is_finite()) {
        return Err(broken(format!("the frame rate is {rate_hz}, but has to be greater than zero")));
    }
    let count = names.len();
    if layout.frames == 0 || count == 0 {
        return Err(broken("the file has no frame with labelled points".into()));
    }
    let position = |row: usize, column: usize| {
        let seen = layout.place(bytes, row, column);
        let Some(position) = seen.filter(|place| *place != Vec3::zeros() && !place.iter().any(|x| x.is_nan())) else {
            return Ok(None);
        };
        if let Some(beyond) = position.iter().find(|x| x.abs() > MAX_NUMBER) {
            let name = &names[column];
            return Err(broken(format!("frame {row}, marker `{name}`: {beyond} is beyond {MAX_NUMBER:e}")));
        }
        Ok(Some(position))
    };
    let frame = |row: usize| (0..count).map(|column| position(row, column)).collect::<Result<Vec<_>, _>>();
    let positions_m = (0..layout.frames).map(frame).collect::<Result<Vec<_>, _>>()?;
    let mut motion =
        MarkerMotion { frames_per_second: rate_hz, positions_m, shortfall, names, ..MarkerMotion::default() };
    match known_scale {
        Some(metres_per_unit) => motion.scale(metres_per_unit),
        None => motion.scale_to_a_person("POINT:UNITS is missing").map_err(broken)?,
    }
    Ok(motion)
}
