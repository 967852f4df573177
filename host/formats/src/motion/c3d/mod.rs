//! C3D marker files. The crate `c3dio` reads their names, unit and rate. Their frames are read
//! here, since it counts frames beyond 65,535 wrong.

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
use crate::quiet_panic::catch_quietly;
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
    let layout = Layout::check(bytes).map_err(damaged)?;
    let shortfall = Shortfall::check(layout.held, layout.promised, options, path, 0)?;
    let names = layout.without_frames(bytes);
    let parsed = catch_quietly(|| c3dio::C3d::from_bytes(&names).map_err(|error| error.to_string()));
    let points = parsed.ok_or_else(|| broken("the C3D file is damaged".into()))?.map_err(damaged)?.points;
    let unit: String = points.units.iter().filter(|letter| letter.is_ascii_alphabetic()).collect();
    let scale =
        metres_per_unit(&unit).ok_or_else(|| broken(format!("POINT:UNITS is `{unit}`; m, cm, mm and in are read")))?;
    if !(points.frame_rate > 0.0 && points.frame_rate.is_finite()) {
        return Err(broken(format!("the frame rate is {}, but has to be greater than zero", points.frame_rate)));
    }
    let count = points.labels.len().min(layout.points);
    if layout.frames == 0 || count == 0 {
        return Err(broken("the file has no frame with labelled points".into()));
    }
    let position = |row: usize, column: usize| {
        let seen = layout.place(bytes, row, column);
        let Some(position) = seen.filter(|place| *place != Vec3::zeros() && !place.iter().any(|x| x.is_nan())) else {
            return Ok(None);
        };
        if let Some(beyond) = position.iter().find(|x| x.abs() > MAX_NUMBER) {
            let name = points.labels[column].trim();
            return Err(broken(format!("frame {row}, marker `{name}`: {beyond} is beyond {MAX_NUMBER:e}")));
        }
        Ok(Some(position * scale))
    };
    let frame = |row: usize| (0..count).map(|column| position(row, column)).collect::<Result<Vec<_>, _>>();
    Ok(MarkerMotion {
        frames_per_second: points.frame_rate,
        names: points.labels.iter().take(count).map(|label| label.trim().to_owned()).collect(),
        positions_m: (0..layout.frames).map(frame).collect::<Result<Vec<_>, _>>()?,
        shortfall,
    })
}
