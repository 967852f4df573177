//! One JSON file for all frames: COCO results (a list of detections), COCO annotations, MMPose
//! predictions, or bare lists of points.

use super::error::{KeypointError, json, read_text};
use super::layout::{self, DetectedFrame};
use super::openpose::{numbers, people};
use super::point_lists;
use serde_json::Value;
use serde_json::value::RawValue;
use std::collections::BTreeMap;
use std::path::Path;

/// Reads a JSON file: a list of results, an object with `annotations` (and `images`) or with
/// `instance_info` (MMPose), one OpenPose frame, or a list of lists of numbers ([`point_lists`]).
///
/// # Errors
/// Names the file, the entry and the rule that it broke.
pub fn read(path: &Path) -> Result<Vec<DetectedFrame>, KeypointError> {
    let text = read_text(path)?;
    let whole: &RawValue = json(&text, path)?;
    let mut names = BTreeMap::new();
    let list = match items(whole) {
        Some(list) if list.iter().any(|entry| entry.get().starts_with('[')) => {
            return each(list, path, |value, index| point_lists::frame(&value, index, path));
        }
        Some(list) => Some(list),
        None => {
            // Of a name that comes twice, the last value counts.
            let parts: BTreeMap<String, &RawValue> = serde_json::from_str(whole.get()).unwrap_or_default();
            if parts.contains_key("people") {
                return Ok(vec![DetectedFrame { frame: 0, people: people(&json(&text, path)?, path)? }]);
            }
            let part = |name: &str| parts.get(name).and_then(|part| items(part));
            if let Some(frames) = part("instance_info") {
                return each(frames, path, |value, index| mmpose_frame(&value, index, path));
            }
            names = image_names(part("images").unwrap_or_default());
            part("annotations")
        }
    };
    let list = list.ok_or_else(|| {
        KeypointError::unusable(path, "is neither a list of COCO results, nor has it `annotations` or `people`")
    })?;
    let entries = each(list, path, |value, index| result(&value, index, &names, path))?;
    drop(text);
    if entries.is_empty() {
        return Err(KeypointError::unusable(path, "has no entry"));
    }
    Ok(by_frame(entries, names.into_values()))
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
) -> Result<(String, Vec<layout::Keypoint>), KeypointError> {
    let broken = |rule: &str| KeypointError::broken(path, format!("entry {index}"), rule);
    let image = match entry.get("image_id") {
        Some(Value::String(name)) => name.clone(),
        Some(id) if id.is_u64() => names.get(&id.to_string()).cloned().unwrap_or_else(|| id.to_string()),
        _ => return Err(broken("`image_id` has to be a whole number or a name")),
    };
    let values = entry.get("keypoints").and_then(numbers);
    let values = values.ok_or_else(|| broken("`keypoints` has to be a list of numbers x, y, confidence"))?;
    let person = layout::person(&values).map_err(|rule| broken(&format!("image `{image}`: {rule}")))?;
    Ok((image, person))
}

/// One frame of an MMPose prediction file: points and scores in separate lists.
fn mmpose_frame(frame: &Value, index: usize, path: &Path) -> Result<DetectedFrame, KeypointError> {
    let place = format!("instance_info[{index}]");
    let broken = |rule: &str| KeypointError::broken(path, place.as_str(), rule);
    let number = frame.get("frame_id").and_then(Value::as_u64).unwrap_or(index as u64);
    let instances = frame.get("instances").and_then(Value::as_array);
    let mut people = Vec::new();
    for instance in instances.ok_or_else(|| broken("has no list `instances`"))? {
        let points = instance.get("keypoints").and_then(numbers);
        let points = points.ok_or_else(|| broken("`keypoints` has to be a list of points"))?;
        let scores = instance.get("keypoint_scores").and_then(numbers);
        let scores = scores.ok_or_else(|| broken("`keypoint_scores` has to be a list of numbers"))?;
        if points.len() != 2 * scores.len() {
            return Err(broken("`keypoints` and `keypoint_scores` have to be as many"));
        }
        let flat: Vec<f64> =
            points.chunks(2).zip(&scores).flat_map(|(point, &score)| [point[0], point[1], score]).collect();
        people.push(layout::person(&flat).map_err(|rule| broken(&rule))?);
    }
    Ok(DetectedFrame { frame: number, people })
}

/// File name of each image of an annotation file, by the text of its number.
fn image_names(images: Vec<&RawValue>) -> BTreeMap<String, String> {
    let name = |image: &RawValue| {
        let image: Value = serde_json::from_str(image.get()).ok()?;
        Some((image.get("id")?.to_string(), image.get("file_name")?.as_str()?.to_owned()))
    };
    images.into_iter().filter_map(name).collect()
}

/// Groups entries by image, images in natural order. The number at the end of each name is the
/// number of its frame if they rise; else images are counted from 0. Images of `listed` without an
/// entry are frames without a person.
fn by_frame(entries: Vec<(String, Vec<layout::Keypoint>)>, listed: impl Iterator<Item = String>) -> Vec<DetectedFrame> {
    let mut names: Vec<String> = entries.iter().map(|entry| entry.0.clone()).chain(listed).collect();
    names.sort_by(|a, b| natord::compare(a, b).then_with(|| a.cmp(b)));
    names.dedup();
    let number = |name: &String| -> Option<u64> {
        let stem = Path::new(name).file_stem()?.to_string_lossy().into_owned();
        let digits = stem.trim_end_matches(|letter: char| letter.is_ascii_digit()).len();
        stem.get(digits..)?.parse().ok()
    };
    let numbers: Option<Vec<u64>> = names.iter().map(number).collect();
    let numbers = match numbers {
        Some(numbers) if numbers.windows(2).all(|pair| pair[0] < pair[1]) => numbers,
        _ => (0..names.len() as u64).collect(),
    };
    let mut people: BTreeMap<String, Vec<Vec<layout::Keypoint>>> = BTreeMap::new();
    for (name, person) in entries {
        people.entry(name).or_default().push(person);
    }
    let frame =
        |(frame, name): (u64, &String)| DetectedFrame { frame, people: people.remove(name).unwrap_or_default() };
    numbers.into_iter().zip(&names).map(frame).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn keypoints(shift: f64) -> Vec<f64> {
        (0..17).flat_map(|i| [f64::from(i) + shift, 5.0, 2.0]).collect()
    }

    fn read_text(text: &str) -> Result<Vec<DetectedFrame>, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("k.json");
        std::fs::write(&path, text).unwrap();
        read(&path).map_err(|error| error.to_string())
    }

    fn counts(frames: &[DetectedFrame]) -> Vec<(u64, usize)> {
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
        assert_eq!((frames[0].people[0][5].position_px, frames[0].people[0][5].confidence), ([6.0, 5.0], 0.7));
        let text = json!({ "instance_info": [{ "instances": [{ "keypoints": points, "keypoint_scores": [1] }] }] });
        assert!(read_text(&text.to_string()).unwrap_err().contains("have to be as many"));
        let nested: Vec<[f64; 3]> = (0..17).map(|i| [f64::from(i) + 1.0, 5.0, 0.5]).collect();
        assert_eq!(counts(&read_text(&json!([{ "image_id": 3, "keypoints": nested }]).to_string()).unwrap()), [(3, 1)]);
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
        assert!(refusal(json!([{ "image_id": 1, "keypoints": [[1, 2]] }])).contains("2 numbers; each keypoint needs"));
        assert!(refusal(json!([{ "image_id": 1, "keypoints": ["x"] }])).contains("has to be a list of numbers"));
        assert!(read_text("[").unwrap_err().contains("k.json: line 1: this is no JSON"));
    }
}
