//! One JSON file for all frames: COCO results (a list of detections), COCO annotations, lists of
//! frames, or bare lists of points.

use super::error::{KeypointError, json, read_text};
use super::openpose::people;
use super::orders::{self, PointFrame, Points};
use super::point_values::triples;
use super::table_rows::{FrameTimes, grouped};
use super::{file_numbers, frame_lists, point_lists};
use serde_json::Value;
use serde_json::value::RawValue;
use std::collections::BTreeMap;
use std::path::Path;

/// Frames of a JSON file, and the size of its pictures where it says so.
#[derive(Debug, Clone, PartialEq)]
pub struct JsonFrames {
    /// The frames, points not named yet.
    pub frames: Vec<PointFrame>,
    /// When they were taken.
    pub times: FrameTimes,
    /// Width and height of the pictures, pixels.
    pub image_size_px: Option<[f64; 2]>,
}

/// Reads a JSON file: a list of results or of frames, one OpenPose frame, or a list of lists of
/// numbers ([`point_lists`]). It may also be an object with `annotations` (and `images`) or with a
/// list of frames ([`frame_lists`]).
///
/// # Errors
/// Names the file, the entry and the rule that it broke.
pub fn read(path: &Path) -> Result<JsonFrames, KeypointError> {
    let text = read_text(path)?;
    let whole: &RawValue = json(&text, path)?;
    let frames_alone = |frames| Ok(JsonFrames { frames, times: FrameTimes::default(), image_size_px: None });
    let mut images = Images::default();
    let list = match items(whole) {
        Some(list) if list.iter().any(|entry| entry.get().starts_with('[')) => {
            return frames_alone(each(list, path, |value, index| point_lists::frame(&value, index, path))?);
        }
        Some(list) => {
            let first = list.first().and_then(|entry| serde_json::from_str(entry.get()).ok());
            if first.is_some_and(|entry: Value| frame_lists::is_frame(&entry)) {
                return list_of_frames(list, path);
            }
            Some(list)
        }
        None => {
            // Of a name that comes twice, the last value counts.
            let parts: BTreeMap<String, &RawValue> = serde_json::from_str(whole.get()).unwrap_or_default();
            if parts.contains_key("people") {
                return frames_alone(vec![PointFrame { frame: 0, people: people(&json(&text, path)?, path)? }]);
            }
            let part = |name: &str| parts.get(name).and_then(|part| items(part));
            if let Some(frames) = frame_lists::LIST_NAMES.iter().find_map(|name| part(name)) {
                return list_of_frames(frames, path);
            }
            images = Images::of(part("images").unwrap_or_default());
            part("annotations")
        }
    };
    let list = list.ok_or_else(|| {
        KeypointError::unusable(
            path,
            "is neither a list of COCO results or frames, nor has it `annotations`, `instance_info`, `frames` or `people`",
        )
    })?;
    let entries = each(list, path, |value, index| result(&value, index, &images.names, path))?;
    drop(text);
    if entries.is_empty() {
        return Err(KeypointError::unusable(path, "has no entry"));
    }
    let frames = by_frame(entries, images.names.into_values());
    Ok(JsonFrames { frames, times: FrameTimes::default(), image_size_px: images.size_px })
}

/// Frames with everybody in each; where the first one has a time, all of them need one.
fn list_of_frames(list: Vec<&RawValue>, path: &Path) -> Result<JsonFrames, KeypointError> {
    let first = list.first().and_then(|entry| serde_json::from_str::<Value>(entry.get()).ok()).unwrap_or_default();
    let columns = frame_lists::columns(&first);
    if columns.time.is_none() {
        let frames = each(list, path, |value, index| frame_lists::frame(&value, index, path))?;
        return Ok(JsonFrames { frames, times: FrameTimes::default(), image_size_px: None });
    }
    let rows = each(list, path, |value, index| frame_lists::row(&value, index, &columns, path))?;
    let broken = |(index, rule)| KeypointError::broken(path, format!("frame {index} of the list"), rule);
    let found = grouped(rows, &columns).map_err(broken)?;
    Ok(JsonFrames { frames: found.frames, times: found.times, image_size_px: None })
}

/// The items of a list, each as its text: as values, all of them together take ten times the memory
/// of the file.
fn items(value: &RawValue) -> Option<Vec<&RawValue>> {
    serde_json::from_str(value.get()).ok()
}

/// What `read` makes of each item, one after the other.
fn each<T>(
    items: Vec<&RawValue>,
    path: &Path,
    read: impl Fn(Value, usize) -> Result<T, KeypointError>,
) -> Result<Vec<T>, KeypointError> {
    let value = |(index, item): (usize, &RawValue)| {
        let value = serde_json::from_str(item.get());
        let broken =
            |error| KeypointError::broken(path, format!("entry {index}"), format!("this is no JSON ({error})"));
        read(value.map_err(broken)?, index)
    };
    items.into_iter().enumerate().map(value).collect()
}

/// Name of the image and the person of one COCO result or annotation.
fn result(
    entry: &Value,
    index: usize,
    names: &BTreeMap<String, String>,
    path: &Path,
) -> Result<(String, Points), KeypointError> {
    let broken = |rule: &str| KeypointError::broken(path, format!("entry {index}"), rule);
    let image = match entry.get("image_id") {
        Some(Value::String(name)) => name.clone(),
        Some(id) if id.is_u64() => names.get(&id.to_string()).cloned().unwrap_or_else(|| id.to_string()),
        _ => return Err(broken("`image_id` has to be a whole number or a name")),
    };
    let values = entry.get("keypoints").and_then(|points| triples(points, entry.get("keypoint_scores")));
    let values = values.ok_or_else(|| broken("`keypoints` has to be a list of numbers x, y, confidence"))?;
    let person = orders::points(&values).map_err(|rule| broken(&format!("image `{image}`: {rule}")))?;
    Ok((image, person))
}

/// The pictures of an annotation file.
#[derive(Debug, Default)]
struct Images {
    /// File name of each, by the text of its number.
    names: BTreeMap<String, String>,
    /// Width and height where all have the same.
    size_px: Option<[f64; 2]>,
}

impl Images {
    fn of(images: Vec<&RawValue>) -> Self {
        let parsed = |image: &RawValue| serde_json::from_str::<Value>(image.get()).ok();
        let images: Vec<Value> = images.into_iter().filter_map(parsed).collect();
        let name = |image: &Value| Some((image.get("id")?.to_string(), image.get("file_name")?.as_str()?.to_owned()));
        let size = |image: &Value| Some([image.get("width")?.as_f64()?, image.get("height")?.as_f64()?]);
        let first = images.first().and_then(size).filter(|size| size.iter().all(|side| *side >= 1.0));
        Self {
            names: images.iter().filter_map(name).collect(),
            size_px: first.filter(|_| images.iter().all(|image| size(image) == first)),
        }
    }
}

/// Groups entries by image ([`file_numbers`]). Images of `listed` without an entry are frames
/// without a person.
fn by_frame(entries: Vec<(String, Points)>, listed: impl Iterator<Item = String>) -> Vec<PointFrame> {
    let mut names: Vec<String> = entries.iter().map(|entry| entry.0.clone()).chain(listed).collect();
    names.sort_unstable();
    names.dedup();
    let mut people: BTreeMap<String, Vec<Points>> = BTreeMap::new();
    for (name, person) in entries {
        people.entry(name).or_default().push(person);
    }
    let frame =
        |(frame, index): (u64, usize)| PointFrame { frame, people: people.remove(&names[index]).unwrap_or_default() };
    file_numbers::frames(&names).frames.into_iter().map(frame).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn keypoints(shift: f64) -> Vec<f64> {
        (0..17).flat_map(|i| [f64::from(i) + shift, 5.0, 2.0]).collect()
    }

    fn read_text(text: &str) -> Result<Vec<PointFrame>, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("k.json");
        std::fs::write(&path, text).unwrap();
        read(&path).map(|found| found.frames).map_err(|error| error.to_string())
    }

    fn counts(frames: &[PointFrame]) -> Vec<(u64, usize)> {
        frames.iter().map(|frame| (frame.frame, frame.people.len())).collect()
    }

    #[test]
    fn results_are_grouped_by_image() {
        let entry = |id: Value| json!({ "image_id": id, "category_id": 1, "keypoints": keypoints(1.0), "score": 0.9 });
        let frames =
            read_text(&json!([entry(4.into()), entry(11.into()), entry(4.into()), entry(5.into())]).to_string());
        assert_eq!(counts(&frames.unwrap()), [(4, 2), (5, 1), (11, 1)]);
        let frames = read_text(&json!([entry("10.jpg".into()), entry("9.jpg".into())]).to_string()).unwrap();
        assert_eq!(counts(&frames), [(9, 1), (10, 1)]);
    }

    #[test]
    fn annotations_know_images_without_people() {
        let text = json!({
            "images": [{ "id": 70, "file_name": "f_2.png" }, { "id": 71, "file_name": "f_3.png" }],
            "annotations": [{ "image_id": 71, "keypoints": keypoints(1.0) }],
        });
        assert_eq!(counts(&read_text(&text.to_string()).unwrap()), [(2, 0), (3, 1)]);
    }

    #[test]
    fn predictions_with_scores_apart_are_read() {
        let points: Vec<[f64; 2]> = (0..17).map(|i| [f64::from(i) + 1.0, 5.0]).collect();
        let instance = json!({ "keypoints": points, "keypoint_scores": vec![0.7; 17], "bbox": [] });
        let text = json!({ "instance_info": [{ "frame_id": 1, "instances": [instance] }, { "frame_id": 2, "instances": [] }] });
        let frames = read_text(&text.to_string()).unwrap();
        assert_eq!(counts(&frames), [(1, 1), (2, 0)]);
        assert_eq!(frames[0].people[0][5], [6.0, 5.0, 0.7]);
        let text = json!({ "instance_info": [{ "instances": [{ "keypoints": points, "keypoint_scores": [1] }] }] });
        assert!(read_text(&text.to_string()).unwrap_err().contains("have to be as many"));
        let nested: Vec<[f64; 3]> = (0..17).map(|i| [f64::from(i) + 1.0, 5.0, 0.5]).collect();
        assert_eq!(counts(&read_text(&json!([{ "image_id": 3, "keypoints": nested }]).to_string()).unwrap()), [(3, 1)]);
    }

    #[test]
    fn times_of_frames_give_their_rate_and_their_gaps() {
        let points: Vec<[f64; 2]> = (0..17).map(|i| [f64::from(i) + 1.0, 5.0]).collect();
        let frame = |time: f64| json!({ "timestamp_ms": time, "people": [{ "keypoints": points }] });
        let times = (0..60).filter(|frame| frame % 20 != 7).map(|frame| f64::from(frame) * 40.0);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("k.json");
        std::fs::write(&path, json!({ "frames": times.map(frame).collect::<Vec<_>>() }).to_string()).unwrap();
        let found = read(&path).unwrap();
        assert_eq!((found.times.rate_hz, found.frames.len(), found.frames[56].frame), (Some(25.0), 57, 59));
        let message = read_text(&json!({ "frames": [frame(0.0), { "timestamp_ms": "x", "people": [] }] }).to_string());
        assert!(message.unwrap_err().contains("frame 1 of the list: `timestamp_ms` has to be a number"));
        let message = read_text(&json!({ "frames": [frame(40.0), frame(0.0)] }).to_string());
        assert!(message.unwrap_err().contains("times have to rise"));
    }

    #[test]
    fn broken_files_are_named() {
        let refusal = |value: Value| read_text(&value.to_string()).unwrap_err();
        assert!(refusal(json!({ "a": 1 })).contains("neither a list of COCO results"));
        assert!(refusal(json!([])).contains("has no entry"));
        let mut beyond = keypoints(1.0);
        beyond[1] = 1.0e308;
        let message = refusal(json!([{ "image_id": "f_7.png", "keypoints": beyond }]));
        assert!(message.contains("k.json: entry 0: image `f_7.png`: keypoint `0` (nose) lies at"), "{message}");
        assert!(refusal(json!([{ "keypoints": [] }])).contains("entry 0: `image_id`"));
        assert!(refusal(json!([{ "image_id": 1 }])).contains("entry 0: `keypoints`"));
        assert!(refusal(json!([{ "image_id": 1, "keypoints": [1, 2] }])).contains("2 numbers; each keypoint needs"));
        assert!(refusal(json!([{ "image_id": 1, "keypoints": ["x"] }])).contains("has to be a list of numbers"));
        assert!(read_text("[").unwrap_err().contains("k.json: line 1: this is no JSON"));
    }
}
