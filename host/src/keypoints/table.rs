//! CSV tables of keypoints: for each joint the columns `JOINT_x_px` and `JOINT_y_px`, and
//! `JOINT_confidence` if there is one.

use super::error::{KeypointError, read_lines};
use super::layout::{DetectedFrame, Keypoint, Part, Side, check_position};
use crate::csv_text::csv_reader;
use crate::motion::joint_names::{HIP_CENTER, NECK};
use sinew_core::skeleton::stick_figure::HUMAN;
use std::path::Path;

/// Columns of one point.
#[derive(Debug, Clone, Copy)]
struct Columns {
    part: Part,
    x: usize,
    y: usize,
    confidence: Option<usize>,
}

/// Reads a table: a header, then one row a frame. `frame` is a column, or
/// rows are counted from zero. An empty or NaN cell is a missing point.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn read(path: &Path) -> Result<Vec<DetectedFrame>, KeypointError> {
    parse(&read_lines(path)?, path)
}

/// Parses the text of a table; `path` is for messages only.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn parse(text: &str, path: &Path) -> Result<Vec<DetectedFrame>, KeypointError> {
    let broken = |line: u64, rule: String| KeypointError::broken(path, format!("line {line}"), rule);
    let mut reader = csv_reader(text);
    let mut records = reader.records().enumerate();
    let header = match records.next() {
        Some((_, Ok(header))) => header,
        Some((_, Err(error))) => return Err(broken(1, error.to_string())),
        None => return Err(broken(1, "the table is empty".into())),
    };
    let columns = columns(&header);
    if columns.is_empty() {
        let rule = "no column is a known joint's x and y (such as `l_knee_x_px`, `l_knee_y_px`, or `left_knee_x`)";
        return Err(broken(1, rule.into()));
    }
    let frame_column = header.iter().position(|name| name.eq_ignore_ascii_case("frame"));
    let mut frames: Vec<DetectedFrame> = Vec::new();
    for (index, record) in records {
        let record = record.map_err(|error| broken(index as u64 + 1, error.to_string()))?;
        let line = record.position().map_or(0, csv::Position::line);
        // Some programs end their rows, but not the header, with a comma.
        if record.len() < header.len() || record.iter().skip(header.len()).any(|cell| !cell.is_empty()) {
            return Err(broken(
                line,
                format!("a row needs {} columns as the header has, found {}", header.len(), record.len()),
            ));
        }
        let frame = match frame_column {
            None => frames.len() as u64,
            Some(column) => record[column].parse().map_err(|_| {
                broken(line, format!("`frame` has to be a whole number from 0, found `{}`", &record[column]))
            })?,
        };
        if let Some(before) = frames.last().filter(|before| before.frame >= frame) {
            return Err(broken(
                line,
                format!("frame {frame} follows frame {}; frame numbers have to rise", before.frame),
            ));
        }
        let person = person(&record, &header, &columns);
        let person = person.map_err(|rule| broken(line, format!("frame {frame}: {rule}")))?;
        frames.push(DetectedFrame { frame, people: vec![person] });
    }
    if frames.is_empty() {
        return Err(broken(2, "the table is empty; at least one frame has to follow the header".into()));
    }
    Ok(frames)
}

fn person(
    record: &csv::StringRecord,
    header: &csv::StringRecord,
    columns: &[Columns],
) -> Result<Vec<Keypoint>, String> {
    let number = |column: usize| -> Result<Option<f64>, String> {
        let cell = &record[column];
        if cell.is_empty() || cell.eq_ignore_ascii_case("nan") {
            return Ok(None);
        }
        match cell.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(Some(value)),
            _ => Err(format!("`{}` has to be a finite number or empty, found `{cell}`", &header[column])),
        }
    };
    let mut person = Vec::new();
    for point in columns {
        let confidence = point.confidence.map_or(Ok(Some(1.0)), number)?.unwrap_or(0.0);
        if let (Some(u), Some(v)) = (number(point.x)?, number(point.y)?) {
            check_position([u, v], point.part, &header[point.x])?;
            person.push(Keypoint { part: point.part, position_px: [u, v], confidence });
        }
    }
    Ok(person)
}

fn columns(header: &csv::StringRecord) -> Vec<Columns> {
    let plain: Vec<String> = header.iter().map(str::to_ascii_lowercase).collect();
    let find = |stem: &str, ends: &[&str]| {
        ends.iter().find_map(|end| plain.iter().position(|name| name.strip_suffix(end) == Some(stem)))
    };
    let mut columns: Vec<Columns> = Vec::new();
    for name in &plain {
        let Some(stem) = ["_x_px", "_u_px", "_x", "_u"].iter().find_map(|end| name.strip_suffix(end)) else { continue };
        let x = find(stem, &["_x_px", "_u_px", "_x", "_u"]);
        let y = find(stem, &["_y_px", "_v_px", "_y", "_v"]);
        let confidence = find(stem, &["_confidence", "_score", "_likelihood", "_c"]);
        if let (Some(part), Some(x), Some(y)) = (part(stem), x, y)
            && columns.iter().all(|other| other.part != part)
        {
            columns.push(Columns { part, x, y, confidence });
        }
    }
    columns
}

/// The part of this name: `l_knee`, `left_knee`, `leftknee`, `LKnee`.
fn part(name: &str) -> Option<Part> {
    let plain: String = name.chars().filter(|letter| letter.is_ascii_alphanumeric()).collect();
    match plain.as_str() {
        "neck" => return Some(Part::Joint(NECK)),
        "hipcenter" | "hipcentre" | "midhip" | "pelvis" | "root" => return Some(Part::Joint(HIP_CENTER)),
        "nose" => return Some(Part::Nose),
        _ => {}
    }
    let (side, rest) = if let Some(rest) = plain.strip_prefix("left") {
        (Side::Left, rest)
    } else if let Some(rest) = plain.strip_prefix("right") {
        (Side::Right, rest)
    } else if let Some(rest) = plain.strip_prefix('l') {
        (Side::Left, rest)
    } else {
        (Side::Right, plain.strip_prefix('r')?)
    };
    match rest {
        "bigtoe" | "toe" => return Some(Part::Toe(side)),
        "heel" => return Some(Part::Heel(side)),
        _ => {}
    }
    let letter = if side == Side::Left { "l" } else { "r" };
    HUMAN.joint_index(&format!("{letter}_{rest}")).map(Part::Joint)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Result<Vec<DetectedFrame>, String> {
        parse(text, Path::new("k.csv")).map_err(|error| error.to_string())
    }

    #[test]
    fn missing_cells_are_missing_points() {
        let frames = parsed(
            "head_x,head_y,right_shoulder_x,right_shoulder_y,left_wrist_x,left_wrist_y\n1,2, , ,3,4\n , ,5.5,6, , \n",
        )
        .unwrap();
        assert_eq!(frames[0].people[0], [Keypoint { part: Part::Joint(4), position_px: [3.0, 4.0], confidence: 1.0 }]);
        assert_eq!(frames[1].people[0][0].part, Part::Joint(5));
        let frames = parsed("frame,l_knee_x_px,l_knee_y_px,l_knee_confidence\n7,1,2,0.2\n9,1,NaN,0.9\n").unwrap();
        assert_eq!((frames[0].frame, frames[0].people[0][0].confidence), (7, 0.2));
        assert!(frames[1].people[0].is_empty());
    }

    #[test]
    fn the_usual_names_are_known() {
        for (name, wanted) in [
            ("l_elbow", Part::Joint(3)),
            ("RAnkle", Part::Joint(13)),
            ("left_hip", Part::Joint(8)),
            ("hip_center", Part::Joint(0)),
            ("MidHip", Part::Joint(0)),
            ("LBigToe", Part::Toe(Side::Left)),
            ("right_heel", Part::Heel(Side::Right)),
        ] {
            assert_eq!(part(&name.to_ascii_lowercase()), Some(wanted), "{name}");
        }
        assert_eq!(part("head"), None);
        assert_eq!(part("rear"), None);
    }

    #[test]
    fn broken_tables_name_file_line_and_rule() {
        let cases = [
            ("", "k.csv: line 1: the table is empty"),
            ("a,b\n1,2\n", "k.csv: line 1: no column is a known joint's"),
            ("neck_x,neck_y\n", "k.csv: line 2: the table is empty"),
            ("neck_x,neck_y\n1\n", "k.csv: line 2: a row needs 2 columns as the header has, found 1"),
            (
                "neck_x,neck_y\n1,inf\n",
                "k.csv: line 2: frame 0: `neck_y` has to be a finite number or empty, found `inf`",
            ),
            (
                "frame,neck_x,neck_y\n7,1,-1e308\n",
                "k.csv: line 2: frame 7: keypoint `neck_x` (neck) lies at (1e0, -1e308)",
            ),
            ("frame,neck_x,neck_y\n3,1,2\n3,1,2\n", "k.csv: line 3: frame 3 follows frame 3"),
            ("frame,neck_x,neck_y\nx,1,2\n", "k.csv: line 2: `frame` has to be"),
        ];
        for (text, message) in cases {
            let found = parsed(text).unwrap_err();
            assert!(found.starts_with(message), "{found}");
        }
    }
}
