//! Any motion in space: joints of a skeleton, or markers.

use super::{DEFAULT_FRAMES_PER_SECOND, MarkerMotion, MotionError, ReadOptions, c3d, exponential_map, read, trc};
use std::path::Path;

/// Reads a motion by its file ending: `.trc` and `.c3d` markers, `.txt` of exponential maps with the whole body, `.bvh`, `.amc`.
///
/// `options.frames_per_second` also replaces the rate of a file that tells one.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn read_space(path: &Path, options: &ReadOptions<'_>) -> Result<MarkerMotion, MotionError> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
    let mut motion = match extension.as_str() {
        "trc" => trc::read(path)?,
        "c3d" => c3d::read(path)?,
        "txt" => {
            let rate = options.frames_per_second.unwrap_or(DEFAULT_FRAMES_PER_SECOND);
            MarkerMotion::from(&exponential_map::read_whole_body(path, rate)?)
        }
        _ => MarkerMotion::from(&read(path, options)?),
    };
    if let Some(rate) = options.frames_per_second {
        motion.frames_per_second = rate;
    }
    Ok(motion)
}
