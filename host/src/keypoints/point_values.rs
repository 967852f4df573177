//! The forms in which JSON files write the points of one person.

use serde_json::Value;

/// Names of a confidence, the first that is there counts.
pub const CONFIDENCE_NAMES: [&str; 10] =
    ["confidence", "visibility", "score", "likelihood", "conf", "prob", "probability", "visible", "vis", "p"];

/// A flat list of numbers, or one list a point; null is NaN.
#[must_use]
pub fn numbers(value: &Value) -> Option<Vec<f64>> {
    let mut flat = Vec::new();
    for entry in value.as_array()? {
        match entry.as_array() {
            Some(point) => flat.extend(point.iter().map(number).collect::<Option<Vec<f64>>>()?),
            None => flat.push(number(entry)?),
        }
    }
    Some(flat)
}

fn number(value: &Value) -> Option<f64> {
    if value.is_null() { Some(f64::NAN) } else { value.as_f64() }
}

/// x, y and confidence of each point, flat. `value` is a flat list of x, y, confidence, or a list
/// of points (x, y; x, y, confidence; or x, y, z, visibility). It may also be a list of objects
/// with `x` and `y`, or an object of the lists `x`, `y` and a confidence. `scores` are confidences
/// that stand apart. `None` if it is none of these, or if there are not as many scores as points.
#[must_use]
pub fn triples(value: &Value, scores: Option<&Value>) -> Option<Vec<f64>> {
    if let Some(lists) = value.as_object() {
        let list = |name: &str| numbers(lists.get(name)?);
        let (x, y) = (list("x")?, list("y")?);
        let confidences = CONFIDENCE_NAMES.iter().find_map(|name| list(name));
        let confidences = confidences.unwrap_or_else(|| vec![1.0; x.len()]);
        let is_whole = x.len() == y.len() && x.len() == confidences.len();
        let points = x.iter().zip(&y).zip(&confidences);
        return is_whole.then(|| points.flat_map(|((x, y), c)| [*x, *y, *c]).collect());
    }
    let list = value.as_array()?;
    if list.first().is_some_and(Value::is_object) {
        return list.iter().map(point).collect::<Option<Vec<_>>>().map(|points| points.concat());
    }
    let flat = numbers(value)?;
    if let Some(scores) = scores {
        let scores = numbers(scores)?;
        let width = if flat.len() == 3 * scores.len() { 3 } else { 2 };
        let points = flat.chunks(width).zip(&scores);
        return (flat.len() == width * scores.len())
            .then(|| points.flat_map(|(point, &score)| [point[0], point[1], score]).collect());
    }
    let width = list.first().and_then(Value::as_array).map_or(3, Vec::len);
    let is_even = list.iter().all(|point| point.as_array().is_none_or(|point| point.len() == width));
    match width {
        _ if !is_even => None,
        2 => Some(flat.chunks(2).flat_map(|point| [point[0], point[1], 1.0]).collect()),
        4 => Some(flat.chunks(4).flat_map(|point| [point[0], point[1], point[3]]).collect()),
        _ => Some(flat),
    }
}

fn point(value: &Value) -> Option<[f64; 3]> {
    if value.is_null() {
        return Some([f64::NAN; 3]);
    }
    let confidence = CONFIDENCE_NAMES.iter().find_map(|name| value.get(name)?.as_f64());
    Some([number(value.get("x")?)?, number(value.get("y")?)?, confidence.unwrap_or(1.0)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn points_are_read_in_each_form() {
        let wanted = Some(vec![1.0, 2.0, 0.5, 3.0, 4.0, 0.6]);
        assert_eq!(triples(&json!([1, 2, 0.5, 3, 4, 0.6]), None), wanted);
        assert_eq!(triples(&json!([[1, 2, 0.5], [3, 4, 0.6]]), None), wanted);
        assert_eq!(triples(&json!([[1, 2], [3, 4]]), Some(&json!([0.5, 0.6]))), wanted);
        assert_eq!(triples(&json!([[1, 2, 9], [3, 4, 9]]), Some(&json!([0.5, 0.6]))), wanted, "points in space");
        assert_eq!(triples(&json!([[1, 2, 9, 0.5], [3, 4, 9, 0.6]]), None), wanted);
        assert_eq!(triples(&json!([{ "x": 1, "y": 2, "score": 0.5 }, { "x": 3, "y": 4, "score": 0.6 }]), None), wanted);
        assert_eq!(triples(&json!({ "x": [1, 3], "y": [2, 4], "visible": [0.5, 0.6] }), None), wanted);
        assert_eq!(triples(&json!([[1, 2], [3, 4]]), None), Some(vec![1.0, 2.0, 1.0, 3.0, 4.0, 1.0]));
        assert_eq!(triples(&json!([[1, 2], [3, 4]]), Some(&json!([0.5]))), None);
        assert_eq!(triples(&json!([[1, 2], [3]]), None), None);
        assert_eq!(triples(&json!(["x"]), None), None);
    }
}
