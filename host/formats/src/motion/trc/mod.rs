//! TRC marker files (OpenSim, Pose2Sim, Cortex): tab-separated positions of named markers.

mod frame_steps;
mod row;
#[cfg(test)]
mod tests;

use super::error::{MotionError, number, read_text};
use super::markers::{MarkerMotion, metres_per_unit};
use super::read_options::ReadOptions;
use super::shortfall::{Shortfall, check_positions, whole_rows};
use frame_steps::frame_indices;
use row::Row;
use std::path::Path;

/// Reads a TRC file.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn read(path: &Path) -> Result<MarkerMotion, MotionError> {
    read_with(path, &ReadOptions::default())
}

/// As [`read`], with `options` of which only `partial` counts.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn read_with(path: &Path, options: &ReadOptions<'_>) -> Result<MarkerMotion, MotionError> {
    parse_with(&read_text(path)?, path, options)
}

/// Parses the text of a TRC file; `path` is for messages only. Points of which a cell is empty or
/// NaN, or that lie exactly at the origin, were not seen. Frames that `Frame#` or `Time` leave out
/// are frames without points.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn parse(text: &str, path: &Path) -> Result<MarkerMotion, MotionError> {
    parse_with(text, path, &ReadOptions::default())
}

/// As [`parse`], with `options` of which only `partial` counts.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn parse_with(text: &str, path: &Path, options: &ReadOptions<'_>) -> Result<MarkerMotion, MotionError> {
    let head: Vec<&str> = text.lines().take(HEADER_LINES).map(|line| line.trim_end_matches('\r')).collect();
    let header = header(&head, path)?;
    let numbered = text.lines().enumerate().skip(HEADER_LINES).map(|(index, row)| (index + 1, row));
    let whole = whole_rows(numbered, text.ends_with('\n'), header.frames);
    let last = whole.last().map(|(line, _)| *line).filter(|_| !text.ends_with('\n'));
    let row = |&(line, row): &(usize, &str)| Row::parse(row, &header.names, last != Some(line), path, line);
    let rows = whole.iter().map(row).collect::<Result<Vec<_>, _>>()?;
    let indices = frame_indices(&rows, header.frames_per_second);
    let frames = indices.last().map_or(0, |last| last.saturating_add(1));
    // Some programs count rows, others all frames.
    let held = if header.frames == Some(frames) { frames } else { rows.len() };
    let shortfall = Shortfall::check(held, header.frames, options, path, 3)?;
    if rows.is_empty() {
        return Err(MotionError::broken(path, head.len(), "a motion needs at least one frame"));
    }
    check_positions(header.names.len(), frames, text.len(), path, 3)?;
    let mut positions_m = vec![vec![None; header.names.len()]; frames];
    let left_out = frames - rows.len();
    for (index, row) in indices.into_iter().zip(rows) {
        positions_m[index] = row.points;
    }
    let Header { frames_per_second, names, .. } = header;
    let mut motion = MarkerMotion { frames_per_second, names, positions_m, shortfall, ..MarkerMotion::default() };
    if left_out > 0 {
        motion
            .notes
            .push(format!("`Frame#` or `Time` leaves out {left_out} of {frames} frames: all points are missing there"));
    }
    match header.unit {
        Unit::Metres(metres_per_unit) => motion.scale(metres_per_unit),
        Unit::Pixels => motion.assume_a_person("`Units` is px"),
        Unit::Missing => {
            let scaled = motion.scale_to_a_person("the header has no value of `Units`");
            scaled.map_err(|rule| MotionError::broken(path, 3, rule))?;
        }
    }
    Ok(motion)
}

/// Lines before the first frame.
const HEADER_LINES: usize = 5;

/// The unit of places.
#[derive(Debug)]
enum Unit {
    /// Metres per unit.
    Metres(f32),
    /// Pixels of a picture.
    Pixels,
    /// The file does not say.
    Missing,
}

/// What the first lines say.
#[derive(Debug)]
struct Header {
    frames_per_second: f32,
    unit: Unit,
    /// How many frames are promised; `None` where the file does not say.
    frames: Option<usize>,
    names: Vec<String>,
}

fn header(lines: &[&str], path: &Path) -> Result<Header, MotionError> {
    let broken = |line: usize, rule: String| MotionError::broken(path, line, rule);
    let line = |index: usize, what: &str| {
        lines.get(index).copied().ok_or_else(|| broken(lines.len(), format!("the file ends where {what} was expected")))
    };
    if !line(0, "`PathFileType`")?.starts_with("PathFileType") {
        return Err(broken(1, "a TRC file has to begin with `PathFileType`".into()));
    }
    let (keys, values) = (line(1, "the header's names")?, line(2, "the header's values")?);
    let find = |key: &str| {
        let column = keys.split_whitespace().position(|name| name.eq_ignore_ascii_case(key));
        column.and_then(|column| values.split_whitespace().nth(column))
    };
    let value = |key: &str| find(key).ok_or_else(|| broken(3, format!("the header has no value of `{key}`")));
    let frames_per_second = number(path, 3, value("DataRate")?)?;
    if frames_per_second <= 0.0 {
        return Err(broken(3, "`DataRate` has to be greater than zero".into()));
    }
    let unit = match find("Units") {
        None => Unit::Missing,
        Some(unit) if ["px", "pixel", "pixels"].contains(&unit.to_ascii_lowercase().as_str()) => Unit::Pixels,
        Some(unit) => Unit::Metres(
            metres_per_unit(unit)
                .ok_or_else(|| broken(3, format!("`Units` is `{unit}`; m, cm, mm, in and px are read")))?,
        ),
    };
    let names: Vec<String> = line(3, "the markers' names")?
        .split('\t')
        .skip(2)
        .map(str::trim)
        .filter(|name| !name.is_empty())
        .map(str::to_owned)
        .collect();
    if names.is_empty() {
        return Err(broken(4, "no marker is named after `Frame#` and `Time`, with tabs between the names".into()));
    }
    // Some programs write the count as `238.0`.
    let frames = find("NumFrames").and_then(|count| count.parse::<f64>().ok()).map(|count| count as usize);
    Ok(Header { frames_per_second, unit, frames, names })
}
