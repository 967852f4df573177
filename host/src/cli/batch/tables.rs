//! The tables over all recordings.

use super::store::Ended;
use crate::csv_text::name_cell;
use crate::error::{Error, Result};
use serde_json::Value;

/// One recording as the tables show it.
#[derive(Debug, Clone)]
pub struct Line {
    /// Its name.
    pub id: String,
    /// Under which its result is.
    pub key: String,
    /// How it ended; nothing if it did not.
    pub ended: Option<Ended>,
}

/// The columns of the status table.
const STATUS: [&str; 7] = ["id", "key", "status", "class", "message", "seconds", "attempts"];

/// How each recording ended: `ok`, `error`, or `open`.
///
/// # Errors
/// None in practice.
pub fn status_csv(lines: &[Line]) -> Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(STATUS)?;
    for line in lines {
        let failure = line.ended.as_ref().and_then(|ended| ended.failure.as_ref());
        let status = match (&line.ended, failure) {
            (None, _) => "open",
            (_, Some(_)) => "error",
            (Some(_), None) => "ok",
        };
        let (class, message) = failure.map_or(("", ""), |failure| (&failure.class, &failure.message));
        let number = |value: Option<String>| value.unwrap_or_default();
        writer.write_record([
            &*name_cell(&line.id),
            &line.key,
            status,
            class,
            &*name_cell(message),
            &number(line.ended.as_ref().map(|ended| format!("{:.3}", ended.seconds))),
            &number(line.ended.as_ref().map(|ended| ended.attempts.to_string())),
        ])?;
    }
    String::from_utf8(writer.into_inner().map_err(Error::invalid)?).map_err(Error::invalid)
}

/// The numbers of each recording that has a result, a row each; a column is there if any has it.
///
/// # Errors
/// None in practice.
pub fn summary_csv(lines: &[Line]) -> Result<String> {
    let rows: Vec<(&str, Vec<(String, String)>)> = lines
        .iter()
        .filter_map(|line| Some((line.id.as_str(), line.ended.as_ref().filter(|ended| ended.failure.is_none())?)))
        .map(|(id, ended)| (id, cells(&ended.answer)))
        .collect();
    let mut names: Vec<&str> = Vec::new();
    for (name, _) in rows.iter().flat_map(|(_, cells)| cells) {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(std::iter::once("id").chain(names.iter().copied()))?;
    for (id, cells) in &rows {
        let cell = |name: &&str| cells.iter().find(|(known, _)| known == name).map_or("", |(_, value)| value);
        writer.write_record(std::iter::once(&*name_cell(id)).chain(names.iter().map(cell)))?;
    }
    String::from_utf8(writer.into_inner().map_err(Error::invalid)?).map_err(Error::invalid)
}

/// The numbers of an answer: those at its top, in `summary`, and of each joint in `symmetries`;
/// `doubts` by their number.
fn cells(answer: &Value) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut add = |prefix: &str, value: &Value| {
        for (name, value) in value.as_object().into_iter().flatten() {
            if value.is_number() || value.is_boolean() {
                found.push((format!("{prefix}{name}"), value.to_string()));
            }
        }
    };
    add("", answer);
    add("", &answer["summary"]);
    for joint in answer["symmetries"].as_array().into_iter().flatten() {
        add(&format!("{}_", joint["angle"].as_str().unwrap_or_default()), joint);
    }
    if let Some(doubts) = answer["doubts"].as_array() {
        found.push(("doubts".to_owned(), doubts.len().to_string()));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::store::Failure;
    use super::*;
    use serde_json::json;

    fn lines() -> Vec<Line> {
        let ended =
            |answer: Value, failure: Option<Failure>| Some(Ended { seconds: 0.5, attempts: 1, failure, answer });
        let answer = json!({
            "summary": { "cadence_per_min": 55.5, "whole_cycles_s": null },
            "symmetries": [{ "angle": "knee_flexion", "left_range_deg": 60.0 }],
            "doubts": ["one"], "out": "x",
        });
        let failure = Failure { class: "data".into(), message: "=broken, row 2".into() };
        vec![
            Line { id: "a".into(), key: "k".into(), ended: ended(answer, None) },
            Line { id: "b".into(), key: "l".into(), ended: ended(Value::Null, Some(failure)) },
            Line { id: "c".into(), key: String::new(), ended: None },
        ]
    }

    #[test]
    fn tables_hold_a_row_each() {
        let status = status_csv(&lines()).unwrap();
        let wanted = "id,key,status,class,message,seconds,attempts\na,k,ok,,,0.500,1\n";
        assert!(status.starts_with(wanted) && status.ends_with("c,,open,,,,\n"), "{status}");
        assert!(status.contains("b,l,error,data,\"'=broken, row 2\""), "{status}");
        let summary = summary_csv(&lines()).unwrap();
        assert_eq!(summary, "id,cadence_per_min,knee_flexion_left_range_deg,doubts\na,55.5,60.0,1\n");
    }
}
