//! TRC marker files (OpenSim, Pose2Sim, Cortex): tab-separated positions of named markers.

use super::error::{MotionError, number, parsed_number, read_text};
use super::markers::{MarkerMotion, metres_per_unit};
use super::read_options::ReadOptions;
use super::shortfall::{Shortfall, whole_rows};
use sinew_core::math::Vec3;
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

/// Parses the text of a TRC file; `path` is for messages only. Empty or NaN cells are points that
/// were not seen.
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
    let rows = whole_rows(numbered, text.ends_with('\n'), header.frames);
    let shortfall = Shortfall::check(rows.len(), header.frames, options, path, 3)?;
    if rows.is_empty() {
        return Err(MotionError::broken(path, head.len(), "a motion needs at least one frame"));
    }
    let mut positions_m = Vec::with_capacity(rows.len());
    for (line, row) in rows {
        positions_m.push(positions(row, &header, path, line)?);
    }
    Ok(MarkerMotion { frames_per_second: header.frames_per_second, names: header.names, positions_m, shortfall })
}

/// Lines before the first frame.
const HEADER_LINES: usize = 5;

/// What the first lines say.
#[derive(Debug)]
struct Header {
    frames_per_second: f32,
    metres_per_unit: f32,
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
    let unit = value("Units")?;
    let metres_per_unit =
        metres_per_unit(unit).ok_or_else(|| broken(3, format!("`Units` is `{unit}`; m, cm, mm and in are read")))?;
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
    Ok(Header { frames_per_second, metres_per_unit, frames, names })
}

fn positions(row: &str, header: &Header, path: &Path, line: usize) -> Result<Vec<Option<Vec3>>, MotionError> {
    let cells: Vec<&str> = row.split('\t').map(str::trim).collect();
    let wanted = 2 + 3 * header.names.len();
    // Programs differ in tabs at the end of a row.
    let surplus_is_empty = cells.iter().skip(wanted).all(|cell| cell.is_empty());
    let missing_at_the_end = wanted.saturating_sub(cells.len());
    if !surplus_is_empty || missing_at_the_end > 0 {
        return Err(MotionError::broken(path, line, format!("a frame needs {wanted} columns, found {}", cells.len())));
    }
    let seen = |cell: &str| !cell.is_empty() && !cell.eq_ignore_ascii_case("nan");
    let position = |(point, name): (&[&str], &String)| {
        if !point.iter().all(|cell| seen(cell)) {
            return Ok(None);
        }
        let value = |cell: &str| {
            parsed_number(cell).map_err(|rule| MotionError::broken(path, line, format!("{rule} (marker `{name}`)")))
        };
        Ok(Some(Vec3::new(value(point[0])?, value(point[1])?, value(point[2])?) * header.metres_per_unit))
    };
    cells[2..wanted].chunks(3).zip(&header.names).map(position).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRC: &str = "PathFileType\t4\t(X/Y/Z)\tm.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n\
        60\t60\t2\t2\tmm\t60\t1\t2\nFrame#\tTime\tRHip\t\t\tLHip\t\t\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\n\
        1\t0.0\t1000\t2000\t3000\t\t\t\n2\t0.016\tNaN\tNaN\tNaN\t4\t5\t6\t\n";

    #[test]
    fn positions_come_in_metres_and_empty_ones_are_missing() {
        let motion = parse(TRC, Path::new("m.trc")).unwrap();
        assert_eq!(
            (motion.frames_per_second, motion.names.as_slice()),
            (60.0, &["RHip".to_owned(), "LHip".to_owned()][..])
        );
        let near = |found: Option<Vec3>, wanted: [f32; 3]| (found.unwrap() - Vec3::from(wanted)).norm() < 1.0e-6;
        assert!(near(motion.positions_m[0][0], [1.0, 2.0, 3.0]) && motion.positions_m[0][1].is_none());
        assert!(near(motion.positions_m[1][1], [0.004, 0.005, 0.006]) && motion.positions_m[1][0].is_none());
    }

    #[test]
    fn broken_files_name_file_line_and_rule() {
        let changes = [
            ("PathFileType", "Path", "m.trc:1: a TRC file has to begin"),
            ("DataRate\tCamera", "Rate\tCamera", "m.trc:3: the header has no value of `DataRate`"),
            ("60\t60\t2\t2\tmm", "0\t60\t2\t2\tmm", "m.trc:3: `DataRate` has to be"),
            ("\tmm\t", "\tpx\t", "m.trc:3: `Units` is `px`"),
            ("1000\t2000", "x\t2000", "m.trc:7: a number was expected, found `x`"),
            ("1000\t2000", "inf\t2000", "m.trc:7: `inf` is not finite; every value has to be (marker `RHip`)"),
            ("1000\t2000", "-1e30\t2000", "m.trc:7: `-1e30` is beyond 1e9"),
            ("\t4\t5\t6\t", "\t4\t5", "m.trc:8: a frame needs 8 columns, found 7"),
            ("\tRHip\t\t\tLHip\t\t", "", "m.trc:4: no marker"),
        ];
        for (from, to, message) in changes {
            let found = parse(&TRC.replacen(from, to, 1), Path::new("m.trc")).unwrap_err().to_string();
            assert!(found.starts_with(message), "{found} does not start with {message}");
        }
        let end = parse("PathFileType\n", Path::new("m.trc")).unwrap_err().to_string();
        assert!(end.contains("the file ends where"), "{end}");
    }
    #[test]
    fn fewer_frames_than_promised_are_an_error_or_noted() {
        let text = TRC.replace("60\t60\t2\t2", "60\t60\t5.0\t2");
        let partial = ReadOptions { partial: true, ..ReadOptions::default() };
        for (cut, frames) in [(&text[..], 2), (&text[..text.len() - 4], 1)] {
            let message = parse(cut, Path::new("m.trc")).unwrap_err().to_string();
            let wanted = format!("m.trc:3: the recording ends early: {frames} of the 5 frames");
            assert!(message.starts_with(&wanted) && message.contains("--partial"), "{message}");
            let motion = parse_with(cut, Path::new("m.trc"), &partial).unwrap();
            assert_eq!((motion.positions_m.len(), motion.shortfall), (frames, Some(Shortfall { frames, promised: 5 })));
        }
        let more = TRC.replace("60\t60\t2\t2", "60\t60\t1\t2");
        assert_eq!(parse(&more, Path::new("m.trc")).unwrap().shortfall, None);
    }
}
