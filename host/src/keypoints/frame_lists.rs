//! JSON files with one entry a frame, each with everybody in it: MMPose, tools around MediaPipe and
//! ultralytics.

use super::columns::Columns;
use super::error::KeypointError;
use super::orders::{self, PointFrame, Points};
use super::point_values::triples;
use super::table_rows::Row;
use serde_json::Value;
use std::path::Path;

/// Names of a list of frames in an object.
pub const LIST_NAMES: [&str; 4] = ["instance_info", "frames", "predictions", "results"];
/// Names of a list of people in a frame.
const PEOPLE_NAMES: [&str; 6] = ["instances", "people", "persons", "predictions", "poses", "detections"];
/// Names of a person's points.
const POINT_NAMES: [&str; 5] = ["keypoints", "landmarks", "pose_landmarks", "pose_keypoints_2d", "joints"];
/// Names of confidences that stand apart from the points.
const SCORE_NAMES: [&str; 3] = ["keypoint_scores", "keypoints_scores", "scores"];
/// Names of a frame's number.
const NUMBER_NAMES: [&str; 6] = ["frame_id", "frame", "frame_number", "frame_index", "frame_idx", "image_id"];

fn first<'a>(object: &'a Value, names: &[&str]) -> Option<&'a Value> {
    names.iter().find_map(|name| object.get(name))
}

/// Whether an entry of a list is a frame with people in it, not a person.
#[must_use]
pub fn is_frame(entry: &Value) -> bool {
    first(entry, &PEOPLE_NAMES).is_some_and(Value::is_array) || first(entry, &NUMBER_NAMES[..5]).is_some()
}

/// Reads the frame `index` of a list, counted from 0, which is its number where it has no other.
///
/// # Errors
/// Names the entry and the rule that it broke.
pub fn frame(entry: &Value, index: usize, path: &Path) -> Result<PointFrame, KeypointError> {
    let place = format!("frame {index} of the list");
    let broken = |rule: &str| KeypointError::broken(path, place.as_str(), rule);
    let number = match first(entry, &NUMBER_NAMES) {
        None => index as u64,
        Some(number) => whole(number).ok_or_else(|| broken("its number has to be whole, from 0"))?,
    };
    let is_own_person = first(entry, &POINT_NAMES).is_some();
    let people = match first(entry, &PEOPLE_NAMES) {
        Some(people) => people.as_array().ok_or_else(|| broken("its people have to be a list"))?.iter().collect(),
        None if is_own_person => vec![entry],
        None => return Err(broken("has no list of people, such as `instances` or `people`, and no `keypoints`")),
    };
    let mut found: Vec<Points> = Vec::new();
    for entry in people {
        for values in person(entry).map_err(broken)? {
            if !values.is_empty() {
                found.push(orders::points(&values).map_err(|rule| broken(&rule))?);
            }
        }
    }
    Ok(PointFrame { frame: number, people: found })
}

/// Which entries of a frame hold its number and its time.
#[must_use]
pub fn columns(entry: &Value) -> Columns {
    let names = entry.as_object().into_iter().flat_map(serde_json::Map::keys);
    let has_number = first(entry, &NUMBER_NAMES).is_some();
    Columns { frame: has_number.then_some(0), ..Columns::of_header(names.map(String::as_str)) }
}

/// The frame `index` of a list with times, as a row of a table.
///
/// # Errors
/// As [`frame`]; a time that is no number.
pub fn row(entry: &Value, index: usize, columns: &Columns, path: &Path) -> Result<Row, KeypointError> {
    let PointFrame { frame: number, people } = frame(entry, index, path)?;
    let name = columns.time.map_or("", |(column, _)| columns.names[column].as_str());
    let time = match entry.get(name) {
        None | Some(Value::Null) => None,
        Some(time) => Some(time.as_f64().ok_or_else(|| {
            let rule = format!("`{name}` has to be a number");
            KeypointError::broken(path, format!("frame {index} of the list"), rule)
        })?),
    };
    Ok(Row { line: index as u64, frame: columns.frame.map(|_| number), time, person: None, people })
}

fn whole(number: &Value) -> Option<u64> {
    let value = number.as_f64().filter(|value| value.fract() == 0.0 && *value >= 0.0 && *value < 1.0e15);
    value.map(|value| value as u64)
}

/// The points of one person, or of several in a list of lists of objects, as MediaPipe's tasks
/// give.
fn person(entry: &Value) -> Result<Vec<Vec<f64>>, &'static str> {
    let points = first(entry, &POINT_NAMES).unwrap_or(entry);
    if points.is_null() {
        return Ok(Vec::new());
    }
    let scores = first(entry, &SCORE_NAMES);
    let is_nested =
        |value: &Value| value.as_array().and_then(|list| list.first()).is_some_and(|inner| !inner.is_number());
    if let Some(list) = points.as_array().filter(|list| list.first().is_some_and(is_nested)) {
        let each = list.iter().map(|points| triples(points, None)).collect::<Option<Vec<_>>>();
        return each.ok_or("its landmarks have to be lists of points");
    }
    let values = triples(points, scores);
    values.map(|values| vec![values]).ok_or(match scores {
        Some(_) => "`keypoints` have to be a list of points, and their scores have to be as many",
        None => "`keypoints` have to be a list of points x, y, confidence",
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn points() -> Vec<[f64; 2]> {
        (0..17).map(|i| [f64::from(i) + 1.0, 5.0]).collect()
    }

    fn read(entry: &Value) -> Result<PointFrame, String> {
        frame(entry, 3, Path::new("k.json")).map_err(|error| error.to_string())
    }

    #[test]
    fn frames_of_several_programs_are_read() {
        let instance = json!({ "keypoints": points(), "keypoint_scores": vec![0.7; 17], "bbox": [[1, 2, 3, 4]] });
        let found = read(&json!({ "frame_id": 5, "instances": [instance, instance] })).unwrap();
        assert_eq!((found.frame, found.people.len(), found.people[1][5]), (5, 2, [6.0, 5.0, 0.7]));
        assert_eq!(read(&json!({ "instances": [] })).unwrap(), PointFrame { frame: 3, people: vec![] });
        let landmarks: Vec<Value> = (0..33).map(|i| json!({ "x": i + 1, "y": 2, "z": 0, "visibility": 0.6 })).collect();
        let found = read(&json!({ "frame": 7, "landmarks": landmarks })).unwrap();
        assert_eq!((found.frame, found.people[0].len(), found.people[0][4]), (7, 33, [5.0, 2.0, 0.6]));
        let found = read(&json!({ "frame": 7, "pose_landmarks": [landmarks, landmarks] })).unwrap();
        assert_eq!(found.people.len(), 2);
        assert!(read(&json!({ "frame": 7, "landmarks": null })).unwrap().people.is_empty());
        let lists = json!({ "x": vec![4.0; 17], "y": vec![5.0; 17], "visible": vec![0.5; 17] });
        assert_eq!(
            read(&json!({ "frame": 1, "people": [{ "keypoints": lists }] })).unwrap().people[0][0],
            [4.0, 5.0, 0.5]
        );
    }

    #[test]
    fn broken_frames_are_named() {
        let message = read(&json!({ "instances": [{ "keypoints": points(), "keypoint_scores": [1] }] })).unwrap_err();
        assert!(
            message.starts_with("k.json: frame 3 of the list:") && message.contains("have to be as many"),
            "{message}"
        );
        assert!(read(&json!({ "frame": 1 })).unwrap_err().contains("no list of people"));
        assert!(read(&json!({ "frame": -1, "instances": [] })).unwrap_err().contains("whole"));
        assert!(read(&json!({ "instances": 5 })).unwrap_err().contains("have to be a list"));
    }
}
