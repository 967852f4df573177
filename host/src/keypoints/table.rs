//! CSV tables of keypoints: for each point a column of x, of y and, perhaps, of its confidence, or
//! one point a row; DeepLabCut's tables with several rows of names.

use super::clock;
use super::columns::{Columns, PointId};
use super::detections::Detections;
use super::error::{KeypointError, read_lines};
use super::layout::{Part, check_position};
use super::orders::{self, PointFrame, Points};
use super::part_names::{self, nearest};
use super::sheet::Sheet;
use super::table_rows::{Row, grouped};
use std::path::Path;

/// Reads a table: one or several header rows, then one row a frame, a person or a point. Frames
/// have the number or the time of their column, or rows are counted from zero. An empty or NaN cell
/// and a point at exactly (0, 0) are missing.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn read(path: &Path) -> Result<Detections, KeypointError> {
    parse(&read_lines(path)?, path)
}

/// Parses the text of a table; `path` is for messages only.
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn parse(text: &str, path: &Path) -> Result<Detections, KeypointError> {
    let broken = |line: u64, rule: String| KeypointError::broken(path, format!("line {line}"), rule);
    let sheet = Sheet::of(text);
    let mut records = sheet.reader(text).into_records().enumerate();
    let mut next = || match records.next() {
        Some((_, Ok(record))) => Ok(Some(record)),
        Some((index, Err(error))) => Err(broken(index as u64 + 1, error.to_string())),
        None => Ok(None),
    };
    let header = next()?.ok_or_else(|| broken(1, "the table is empty".into()))?;
    let columns = match header_rows(&header, &mut next)? {
        Some(columns) => columns,
        None => Columns::of_header(header.iter()),
    };
    if columns.points.is_empty() {
        return Err(broken(1, no_points(&columns)));
    }
    let mut slots = Slots::of(&columns).map_err(|rule| broken(1, rule))?;
    let mut rows: Vec<Row> = Vec::new();
    while let Some(record) = next()? {
        let line = record.position().map_or(0, csv::Position::line);
        // Some programs end their rows, but not the header, with a comma.
        let width = columns.names.len();
        if record.len() < width || record.iter().skip(width).any(|cell| !cell.is_empty()) {
            let rule = format!("a row needs {width} columns as the header has, found {}", record.len());
            return Err(broken(line, rule));
        }
        rows.push(row(&record, &columns, sheet, &mut slots, rows.len()).map_err(|rule| broken(line, rule))?);
    }
    if rows.is_empty() {
        return Err(broken(2, "the table is empty; at least one frame has to follow the header".into()));
    }
    let grouped = grouped(rows, &columns).map_err(|(line, rule)| broken(line, rule))?;
    let found = slots.named(grouped.frames).map_err(|rule| broken(1, rule))?;
    Ok(grouped.times.applied_to(found))
}

/// The columns of a table with a header row each for scorers, individuals, body parts and
/// coordinates, as DeepLabCut writes it.
fn header_rows(
    first: &csv::StringRecord,
    next: &mut impl FnMut() -> Result<Option<csv::StringRecord>, KeypointError>,
) -> Result<Option<Columns>, KeypointError> {
    let is_named =
        |record: &csv::StringRecord, name: &str| record.get(0).is_some_and(|cell| cell.eq_ignore_ascii_case(name));
    if !["scorer", "individuals", "bodyparts"].iter().any(|name| is_named(first, name)) {
        return Ok(None);
    }
    let cells = |record: &csv::StringRecord| record.iter().map(str::to_owned).collect::<Vec<String>>();
    let (mut bodyparts, mut individuals) = (None, None);
    let mut record = first.clone();
    loop {
        if is_named(&record, "bodyparts") {
            bodyparts = Some(cells(&record));
        } else if is_named(&record, "individuals") {
            individuals = Some(cells(&record));
        } else if !is_named(&record, "scorer") {
            break;
        }
        match next()? {
            Some(following) => record = following,
            None => return Ok(Some(Columns::default())),
        }
    }
    let coords = cells(&record);
    let as_wide = |row: &Vec<String>| row.len() == coords.len();
    let Some(bodyparts) = bodyparts.filter(as_wide) else { return Ok(Some(Columns::default())) };
    Ok(Some(Columns::of_rows(&bodyparts, &coords, individuals.filter(as_wide).as_deref())))
}

fn no_points(columns: &Columns) -> String {
    let unlike = columns.names.iter().find(|name| name.len() > 2 && name.to_lowercase().contains(['x', 'u']));
    let proposal = unlike.map_or_else(String::new, |name| {
        let part = nearest(name.trim_end_matches(|letter: char| "xyuvp_.".contains(letter)));
        match format!("{part}_x_px") {
            wanted if wanted == *name => format!("; `{name}` needs `{part}_y_px` beside it"),
            wanted => format!("; the nearest to `{name}` is `{wanted}`"),
        }
    });
    format!("no column is a known joint's x and y (such as `l_knee_x_px`, `l_knee_y_px`, or `left_knee_x`){proposal}")
}

/// Where each point of a row goes.
#[derive(Debug)]
struct Slots {
    /// Index among a person's points of each entry of [`Columns::points`].
    indices: Vec<usize>,
    /// The parts of named points; empty for numbered ones.
    parts: Vec<Part>,
    /// How many points a person has.
    count: usize,
    /// Each row names its point.
    is_named_in_rows: bool,
    /// The table counts points from 1.
    first_number: usize,
}

impl Slots {
    fn of(columns: &Columns) -> Result<Self, String> {
        let mut slots =
            Self { indices: Vec::new(), parts: Vec::new(), count: 0, is_named_in_rows: false, first_number: 0 };
        let numbers: Vec<usize> = columns
            .points
            .iter()
            .filter_map(|point| match point.id {
                Some(PointId::Number(number)) => Some(number),
                _ => None,
            })
            .collect();
        if let (Some(&first), Some(&last)) = (numbers.iter().min(), numbers.iter().max()) {
            slots.first_number = usize::from(first == 1);
            slots.count = last + 1 - slots.first_number;
            orders::parts(slots.count).ok_or_else(|| orders::unknown_count(slots.count))?;
        }
        for point in &columns.points {
            match point.id {
                None => slots.is_named_in_rows = true,
                Some(PointId::Number(number)) => slots.indices.push(number.saturating_sub(slots.first_number)),
                Some(PointId::Part(part)) => {
                    let index = slots.index_of(part);
                    slots.indices.push(index);
                }
            }
        }
        Ok(slots)
    }

    fn index_of(&mut self, part: Part) -> usize {
        let index = self.parts.iter().position(|other| *other == part).unwrap_or_else(|| {
            self.parts.push(part);
            self.parts.len() - 1
        });
        self.count = self.count.max(self.parts.len());
        index
    }

    /// Index of the point that a row names; `None` for one that is not used.
    fn index_of_name(&mut self, name: &str) -> Option<usize> {
        if let Some(part) = part_names::part(name) {
            return Some(self.index_of(part));
        }
        // 136 points are the most that an order has.
        let number = part_names::number(name).filter(|number| *number < 136 && self.parts.is_empty())?;
        self.count = self.count.max(number + 1);
        Some(number)
    }

    fn named(&self, mut frames: Vec<PointFrame>) -> Result<Detections, String> {
        if !self.parts.is_empty() {
            return Ok(orders::named_by(&frames, &self.parts));
        }
        if self.count == 0 {
            return Err("no row names a known point, such as `l_knee` or `left_knee`".to_owned());
        }
        orders::parts(self.count).ok_or_else(|| orders::unknown_count(self.count))?;
        for person in frames.iter_mut().flat_map(|frame| &mut frame.people) {
            person.resize(self.count, [f64::NAN; 3]);
        }
        Ok(orders::name_points(&frames))
    }
}

fn row(
    record: &csv::StringRecord,
    columns: &Columns,
    sheet: Sheet,
    slots: &mut Slots,
    index: usize,
) -> Result<Row, String> {
    let number = |column: usize| {
        let wrong = |()| {
            let name = columns.names.get(column).map_or("", String::as_str);
            format!("`{name}` has to be a finite number or empty, found `{}`", &record[column])
        };
        sheet.number(&record[column]).map_err(wrong)
    };
    let frame = columns.frame.map(|column| frame_number(&record[column], sheet, &columns.names[column])).transpose()?;
    let time = columns.time.map(|(column, _)| {
        let found = clock::time(&record[column], sheet);
        found.map_err(|()| format!("`{}` has to be a time, found `{}`", columns.names[column], &record[column]))
    });
    let place = frame.unwrap_or(index as u64);
    let mut people: Vec<Points> = vec![Vec::new(); columns.people()];
    for (entry, point) in columns.points.iter().enumerate() {
        let slot = match columns.point_name {
            Some(column) => slots.index_of_name(&record[column]),
            None => slots.indices.get(entry).copied(),
        };
        let Some(slot) = slot else { continue };
        let of_frame = |rule: String| format!("frame {place}: {rule}");
        let confidence = point.confidence.map_or(Ok(Some(1.0)), number).map_err(of_frame)?.unwrap_or(0.0);
        let (Some(u), Some(v)) = (number(point.x).map_err(of_frame)?, number(point.y).map_err(of_frame)?) else {
            continue;
        };
        if u == 0.0 && v == 0.0 {
            continue;
        }
        let part = slots.parts.get(slot).copied().unwrap_or(Part::Other);
        check_position([u, v], part, &columns.names[point.x]).map_err(of_frame)?;
        let person = &mut people[point.person];
        if person.len() <= slot {
            person.resize(slot + 1, [f64::NAN; 3]);
        }
        person[slot] = [u, v, confidence];
    }
    let person = columns.person.map(|column| record[column].to_owned());
    Ok(Row {
        line: record.position().map_or(0, csv::Position::line),
        frame,
        time: time.transpose()?.flatten(),
        person,
        people,
    })
}

/// The number of a frame: whole, written `7` or `7.0`, or at the end of an image's name.
fn frame_number(cell: &str, sheet: Sheet, name: &str) -> Result<u64, String> {
    if let Ok(Some(number)) = sheet.number(cell)
        && number >= 0.0
        && number.fract() == 0.0
        && number < 1.0e15
    {
        return Ok(number as u64);
    }
    let image = sheet.number(cell).is_err().then(|| super::file_numbers::last_number(cell)).flatten();
    let is_image =
        [".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff"].iter().any(|end| cell.to_lowercase().ends_with(end));
    let name = if name.trim().is_empty() { "frame" } else { name };
    image.filter(|_| is_image).ok_or_else(|| format!("`{name}` has to be a whole number from 0, found `{cell}`"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keypoints::layout::{DetectedFrame, Keypoint};

    fn parsed(text: &str) -> Result<Vec<DetectedFrame>, String> {
        parse(text, Path::new("k.csv")).map(|found| found.frames).map_err(|error| error.to_string())
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

    #[test]
    fn a_name_that_is_none_has_a_proposal() {
        for (text, proposal) in [
            ("frame,l_hip_x_px\n0,1\n", "; `l_hip_x_px` needs `l_hip_y_px` beside it"),
            ("l_sholder_x,l_sholder_y\n1,2\n", "; the nearest to `l_sholder_x` is `l_shoulder_x_px`"),
        ] {
            let found = parsed(text).unwrap_err();
            assert!(found.ends_with(proposal), "{found}");
        }
    }
}
