//! C3D marker files, read with the crate `c3dio`.

use super::error::MotionError;
use super::markers::{MarkerMotion, metres_per_unit};
use sinew_core::math::Vec3;
use std::panic::catch_unwind;
use std::path::Path;

/// Second byte of every C3D file.
pub const MAGIC: u8 = 0x50;
/// A C3D file is made of blocks of this size; the header is the first.
const BLOCK_BYTES: usize = 512;

/// Reads the markers of a C3D file; points with a negative residual, or exactly at the origin, were
/// not seen.
///
/// # Errors
/// The file cannot be read, is no C3D file, is damaged, or names no unit that is known.
pub fn read(path: &Path) -> Result<MarkerMotion, MotionError> {
    let bytes = std::fs::read(path).map_err(|reason| MotionError::Unreadable { path: path.to_path_buf(), reason })?;
    let broken = |rule: String| MotionError::broken(path, 0, rule);
    if bytes.len() < 2 * BLOCK_BYTES || bytes[1] != MAGIC {
        return Err(broken("this is no C3D file".into()));
    }
    // The reader answers most damage by an error, but indexes past the end of some cut files.
    let parsed = catch_unwind(|| c3dio::C3d::from_bytes(&bytes).map_err(|error| error.to_string()))
        .map_err(|_| broken("the C3D file is damaged".into()))?;
    let points = parsed.map_err(|error| broken(format!("the C3D file is damaged ({error})")))?.points;
    let unit: String = points.units.iter().filter(|letter| letter.is_ascii_alphabetic()).collect();
    let scale =
        metres_per_unit(&unit).ok_or_else(|| broken(format!("POINT:UNITS is `{unit}`; m, cm, mm and in are read")))?;
    if !(points.frame_rate > 0.0 && points.frame_rate.is_finite()) {
        return Err(broken(format!("the frame rate is {}, but has to be greater than zero", points.frame_rate)));
    }
    let count = points.labels.len().min(points.cols());
    if points.rows() == 0 || count == 0 {
        return Err(broken("the file has no frame with labelled points".into()));
    }
    let seen = |row: usize, column: usize| {
        let marker = &points.points[row][column];
        let position = Vec3::from(marker.point);
        let there = marker.residual >= 0.0 && position != Vec3::zeros() && position.iter().all(|x| x.is_finite());
        there.then_some(position * scale)
    };
    Ok(MarkerMotion {
        frames_per_second: points.frame_rate,
        names: points.labels.iter().take(count).map(|label| label.trim().to_owned()).collect(),
        positions_m: (0..points.rows()).map(|row| (0..count).map(|column| seen(row, column)).collect()).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_c3d_file_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("m.c3d");
        std::fs::write(&path, b"no").unwrap();
        assert!(read(&path).unwrap_err().to_string().contains("no C3D file"));
        let mut damaged = vec![0_u8; 2048];
        (damaged[0], damaged[1]) = (2, MAGIC);
        std::fs::write(&path, damaged).unwrap();
        assert!(read(&path).is_err());
    }
}
