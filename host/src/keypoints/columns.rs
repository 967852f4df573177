//! What the columns of a table hold, by their names.

use super::layout::Part;
use super::part_names::{number, part};
use super::point_values::CONFIDENCE_NAMES;

/// What a column of a point holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Axis {
    X,
    Y,
    /// `v`: y beside `u`, visibility beside `y`.
    V,
    Confidence(usize),
}

/// Which point a column or row is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PointId {
    /// A named part.
    Part(Part),
    /// The number in a detector's order.
    Number(usize),
}

/// Columns of one point.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PointColumns {
    /// Which point; `None` where a column names it in each row.
    pub id: Option<PointId>,
    /// Which person, counted from 0.
    pub person: usize,
    /// Column of x.
    pub x: usize,
    /// Column of y.
    pub y: usize,
    /// Column of the confidence.
    pub confidence: Option<usize>,
}

/// What a header says.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Columns {
    /// The points; one without an id where each row names its point.
    pub points: Vec<PointColumns>,
    /// Names of the columns, for messages.
    pub names: Vec<String>,
    /// Column of the frame's number.
    pub frame: Option<usize>,
    /// Column of the time, and seconds of its unit where its name has one.
    pub time: Option<(usize, Option<f64>)>,
    /// Column of the person or track.
    pub person: Option<usize>,
    /// Column of the point's name.
    pub point_name: Option<usize>,
}

const FRAME_NAMES: [&str; 9] =
    ["frame", "frameidx", "frameid", "framenumber", "framenum", "frameno", "frameindex", "framecount", "imageid"];
/// What pandas calls rows without a name.
const INDEX_NAMES: [&str; 3] = ["", "unnamed0", "index"];
const PERSON_NAMES: [&str; 9] =
    ["person", "personid", "personidx", "track", "trackid", "individual", "instance", "subject", "pid"];
const POINT_NAMES: [&str; 14] = [
    "landmark",
    "landmarkname",
    "landmarkid",
    "landmarkindex",
    "keypoint",
    "keypointname",
    "keypointid",
    "bodypart",
    "joint",
    "jointname",
    "node",
    "part",
    "point",
    "name",
];
/// Names of a time, and the seconds of its unit; `None` where the name has no unit.
const TIME_NAMES: [(&str, Option<f64>); 18] = [
    ("time", None),
    ("timestamp", None),
    ("t", None),
    ("time_s", Some(1.0)),
    ("timestamp_s", Some(1.0)),
    ("t_s", Some(1.0)),
    ("time_sec", Some(1.0)),
    ("timestamp_sec", Some(1.0)),
    ("time_seconds", Some(1.0)),
    ("seconds", Some(1.0)),
    ("sec", Some(1.0)),
    ("time_ms", Some(1.0e-3)),
    ("timestamp_ms", Some(1.0e-3)),
    ("milliseconds", Some(1.0e-3)),
    ("ms", Some(1.0e-3)),
    ("time_us", Some(1.0e-6)),
    ("timestamp_us", Some(1.0e-6)),
    ("timestamp_ns", Some(1.0e-9)),
];

impl Columns {
    /// What a header of one row says.
    #[must_use]
    pub fn of_header<'a>(names: impl Iterator<Item = &'a str>) -> Self {
        let names: Vec<String> = names.map(str::to_owned).collect();
        let plain: Vec<String> = names.iter().map(|name| plain(name)).collect();
        let find = |known: &[&str]| known.iter().find_map(|known| plain.iter().position(|name| name == known));
        let snake: Vec<String> = names.iter().map(|name| snake(name)).collect();
        let time =
            TIME_NAMES.iter().find_map(|(known, unit)| Some((snake.iter().position(|name| name == known)?, *unit)));
        let mut columns = Self { frame: find(&FRAME_NAMES), time, person: find(&PERSON_NAMES), ..Self::default() };
        if columns.frame.is_none() && columns.time.is_none() {
            columns.frame = find(&INDEX_NAMES);
        }
        columns.points = named_points(&names);
        if columns.points.is_empty()
            && let (Some(point_name), Some(lone)) = (find(&POINT_NAMES), lone_point(&plain))
        {
            columns.point_name = Some(point_name);
            columns.points = vec![lone];
        }
        columns.names = names;
        columns
    }

    /// What a header of one row for each of body part, coordinate and, perhaps, individual says.
    #[must_use]
    pub fn of_rows(bodyparts: &[String], coords: &[String], individuals: Option<&[String]>) -> Self {
        let is_value = |index: &usize| axis_word(&coords[*index].to_lowercase()).is_some();
        let frame = (0..coords.len()).take_while(|index| !is_value(index)).last();
        let mut people: Vec<&str> = Vec::new();
        let mut points: Vec<PointColumns> = Vec::new();
        for x in (0..coords.len()).filter(|index| coords[*index].eq_ignore_ascii_case("x")) {
            let owner = individuals.map_or("", |names| names[x].as_str());
            let is_same = |index: &usize| {
                bodyparts[*index] == bodyparts[x] && individuals.is_none_or(|names| names[*index] == owner)
            };
            let same = |wanted: fn(Axis) -> bool| {
                (0..coords.len())
                    .filter(is_same)
                    .find(|index| axis_word(&coords[*index].to_lowercase()).is_some_and(wanted))
            };
            let y = same(|axis| axis == Axis::Y);
            if let (Some(id), Some(y)) = (part(&bodyparts[x]).map(PointId::Part), y) {
                let person = people.iter().position(|name| *name == owner).unwrap_or_else(|| {
                    people.push(owner);
                    people.len() - 1
                });
                let confidence = same(|axis| matches!(axis, Axis::Confidence(_)));
                points.push(PointColumns { id: Some(id), person, x, y, confidence });
            }
        }
        let names = bodyparts.iter().zip(coords).map(|(part, coord)| format!("{part} {coord}")).collect();
        Self { points, names, frame, ..Self::default() }
    }

    /// How many people a row has columns for.
    #[must_use]
    pub fn people(&self) -> usize {
        self.points.iter().map(|point| point.person + 1).max().unwrap_or(0)
    }
}

fn plain(name: &str) -> String {
    name.to_lowercase().chars().filter(|letter| letter.is_ascii_alphanumeric()).collect()
}

/// Lower case, words joined by one `_`, brackets left out.
fn snake(name: &str) -> String {
    let lower = name.to_lowercase();
    let words = lower.split(|letter: char| !letter.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("_")
}

fn axis_word(word: &str) -> Option<Axis> {
    match word {
        "x" | "u" => Some(Axis::X),
        "y" => Some(Axis::Y),
        "v" => Some(Axis::V),
        "c" | "s" => Some(Axis::Confidence(CONFIDENCE_NAMES.len())),
        _ => CONFIDENCE_NAMES.iter().position(|name| *name == word).map(Axis::Confidence),
    }
}

fn identity(stem: &str) -> Option<PointId> {
    part(stem).map(PointId::Part).or_else(|| number(stem).map(PointId::Number))
}

/// The point and the axis of a column: `l_knee_x_px`, `LEFT_KNEE.x`, `x_left_knee`, `kneeLX`,
/// `x12`.
fn point_axis(name: &str) -> Option<(PointId, Axis)> {
    let mut words = snake(name);
    for unit in ["_px", "_pixel", "_pixels"] {
        words = words.strip_suffix(unit).unwrap_or(&words).to_owned();
    }
    let split = [words.rsplit_once('_'), words.split_once('_').map(|(first, rest)| (rest, first))];
    let parts = split.into_iter().flatten().map(|(stem, axis)| (stem.to_owned(), axis.to_owned()));
    // One letter without a space: the last of `kneeLX`, the first of `x12`.
    let joined = words.char_indices().next_back().map(|(end, _)| (words[..end].to_owned(), words[end..].to_owned()));
    let first = words.chars().next().filter(char::is_ascii).map(|_| (words[1..].to_owned(), words[..1].to_owned()));
    let first = first.filter(|(stem, _)| number(stem).is_some());
    parts.chain(joined).chain(first).find_map(|(stem, axis)| Some((identity(&stem)?, axis_word(&axis)?)))
}

fn named_points(names: &[String]) -> Vec<PointColumns> {
    let axes: Vec<Option<(PointId, Axis)>> = names.iter().map(|name| point_axis(name)).collect();
    let mut points: Vec<PointColumns> = Vec::new();
    for (x, id) in
        axes.iter().enumerate().filter_map(|(index, found)| Some((index, found.filter(|f| f.1 == Axis::X)?.0)))
    {
        let find = |wanted: Axis| axes.iter().position(|found| *found == Some((id, wanted)));
        let (y, v) = (find(Axis::Y), find(Axis::V));
        let confidence = (0..=CONFIDENCE_NAMES.len()).find_map(|rank| find(Axis::Confidence(rank)));
        let confidence = confidence.or(y.and(v));
        if let (Some(y), true) = (y.or(v), points.iter().all(|other| other.id != Some(id))) {
            points.push(PointColumns { id: Some(id), person: 0, x, y, confidence });
        }
    }
    // Where parts are named, a number belongs to something else.
    if points.iter().any(|point| matches!(point.id, Some(PointId::Part(_)))) {
        points.retain(|point| matches!(point.id, Some(PointId::Part(_))));
    }
    points
}

/// The columns `x`, `y` and a confidence of a table with one point a row.
fn lone_point(plain: &[String]) -> Option<PointColumns> {
    let find = |known: &[&str]| known.iter().find_map(|known| plain.iter().position(|name| name == known));
    let (x, y) = (find(&["x", "xpx", "u"])?, find(&["y", "ypx", "v"])?);
    Some(PointColumns { id: None, person: 0, x, y, confidence: find(&CONFIDENCE_NAMES) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keypoints::layout::Side;

    fn columns(header: &str) -> Columns {
        Columns::of_header(header.split(','))
    }

    fn knee(header: &str) -> Option<(usize, usize, Option<usize>)> {
        let found = columns(header);
        let point = found.points.iter().find(|point| point.id == Some(PointId::Part(Part::Joint(9))))?;
        Some((point.x, point.y, point.confidence))
    }

    #[test]
    fn columns_are_known_by_many_names() {
        for end in ["visibility", "conf", "prob", "p", "likelihood", "score", "confidence", "c"] {
            assert_eq!(knee(&format!("l_knee_x,l_knee_y,l_knee_z,l_knee_{end}")), Some((0, 1, Some(3))), "{end}");
        }
        assert_eq!(knee("left_knee.x,left_knee.y,left_knee.score"), Some((0, 1, Some(2))));
        assert_eq!(knee("x_left_knee,y_left_knee"), Some((0, 1, None)));
        assert_eq!(knee("LEFT KNEE X (px),LEFT KNEE Y (px)"), Some((0, 1, None)));
        assert_eq!(knee("l_knee_u_px,l_knee_v_px"), Some((0, 1, None)));
        assert_eq!(knee("LKneeX,LKneeY"), Some((0, 1, None)));
        assert_eq!(columns("left_heel_x,left_heel_y").points[0].id, Some(PointId::Part(Part::Heel(Side::Left))));
    }

    #[test]
    fn numbers_stand_for_points_where_no_part_is_named() {
        let found = columns("frame,x0,y0,z0,v0,x1,y1,z1,v1");
        assert_eq!(
            found.points[1],
            PointColumns { id: Some(PointId::Number(1)), person: 0, x: 5, y: 6, confidence: Some(8) }
        );
        assert_eq!(columns("landmark_0_x,landmark_0_y,landmark_0_visibility").points[0].confidence, Some(2));
    }

    #[test]
    fn frame_time_and_person_have_columns() {
        let found = columns("track,frame_idx,instance.score,nose.x,nose.y,nose.score");
        assert_eq!((found.person, found.frame, found.points.len()), (Some(0), Some(1), 1));
        assert_eq!(columns("Time (s),nose_x,nose_y").time, Some((0, Some(1.0))));
        assert_eq!(columns("timestamp,nose_x,nose_y").time, Some((0, None)));
        assert_eq!(columns("time_ms,nose_x,nose_y").time, Some((0, Some(1.0e-3))));
        assert_eq!(columns(",nose_x,nose_y").frame, Some(0));
        let long = columns("frame,landmark,x,y,z,visibility");
        assert_eq!((long.point_name, long.points[0].x, long.points[0].confidence), (Some(1), 2, Some(5)));
    }
}
