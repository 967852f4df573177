//! TRC marker files (OpenSim, Pose2Sim, Cortex): tab-separated positions of named markers.

use super::error::{MotionError, number, read_text};
use super::markers::{MarkerMotion, metres_per_unit};
use sinew_core::math::Vec3;
use std::path::Path;

/// Reads a TRC file.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn read(path: &Path) -> Result<MarkerMotion, MotionError> {
    parse(&read_text(path)?, path)
}

/// Parses the text of a TRC file; `path` is for messages only. Empty or NaN cells are points that
/// were not seen.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn parse(text: &str, path: &Path) -> Result<MarkerMotion, MotionError> {
    let lines: Vec<&str> = text.lines().map(|line| line.trim_end_matches('\r')).collect();
    let broken = |line: usize, rule: String| MotionError::broken(path, line, rule);
    let line = |index: usize, what: &str| {
        lines.get(index).copied().ok_or_else(|| broken(lines.len(), format!("the file ends where {what} was expected")))
    };
    if !line(0, "`PathFileType`")?.starts_with("PathFileType") {
        return Err(broken(1, "a TRC file has to begin with `PathFileType`".into()));
    }
    let (keys, values) = (line(1, "the header's names")?, line(2, "the header's values")?);
    let header = |key: &str| {
        let column = keys.split_whitespace().position(|name| name.eq_ignore_ascii_case(key));
        column
            .and_then(|column| values.split_whitespace().nth(column))
            .ok_or_else(|| broken(3, format!("the header has no value of `{key}`")))
    };
    let frames_per_second = number(path, 3, header("DataRate")?)?;
    if frames_per_second <= 0.0 {
        return Err(broken(3, "`DataRate` has to be greater than zero".into()));
    }
    let unit = header("Units")?;
    let scale =
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
    let mut positions_m = Vec::new();
    for (index, row) in lines.iter().enumerate().skip(5).filter(|(_, row)| !row.trim().is_empty()) {
        positions_m.push(positions(row, names.len(), scale, path, index + 1)?);
    }
    if positions_m.is_empty() {
        return Err(broken(lines.len(), "a motion needs at least one frame".into()));
    }
    Ok(MarkerMotion { frames_per_second, names, positions_m })
}

fn positions(
    row: &str,
    markers: usize,
    scale: f32,
    path: &Path,
    line: usize,
) -> Result<Vec<Option<Vec3>>, MotionError> {
    let cells: Vec<&str> = row.split('\t').map(str::trim).collect();
    let wanted = 2 + 3 * markers;
    // Programs differ in tabs at the end of a row.
    let surplus_is_empty = cells.iter().skip(wanted).all(|cell| cell.is_empty());
    let missing_at_the_end = wanted.saturating_sub(cells.len());
    if !surplus_is_empty || missing_at_the_end > 0 {
        return Err(MotionError::broken(path, line, format!("a frame needs {wanted} columns, found {}", cells.len())));
    }
    let seen = |cell: &str| !cell.is_empty() && !cell.eq_ignore_ascii_case("nan");
    let mut positions = Vec::with_capacity(markers);
    for point in cells[2..wanted].chunks(3) {
        if point.iter().all(|cell| seen(cell)) {
            let [x, y, z] = [point[0], point[1], point[2]].map(|cell| number(path, line, cell));
            positions.push(Some(Vec3::new(x?, y?, z?) * scale));
        } else {
            positions.push(None);
        }
    }
    Ok(positions)
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
}
