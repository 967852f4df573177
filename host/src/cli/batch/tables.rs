//! The tables over all recordings.

use super::numbers::Numbers;
use super::store::{Ended, Failure};
use crate::csv_text::name_cell;
use crate::error::Result;
use crate::output::write_atomically;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::collections::HashMap;
use std::io::Write;
use std::path::Path;

/// One recording as the tables show it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// Its name.
    pub id: String,
    /// Under which its result is.
    pub key: String,
    /// How it ended; nothing if it did not.
    pub ended: Option<Outcome>,
}

/// How a recording ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Seconds of the last attempt.
    pub seconds: f64,
    /// How often it was tried.
    pub attempts: u32,
    /// What failed; nothing if there is a result.
    pub failure: Option<Failure>,
    /// Whether an earlier run did it.
    pub from_before: bool,
    /// What the summary shows of it.
    pub numbers: Numbers,
}

impl Outcome {
    /// What the tables show of `ended`.
    #[must_use]
    pub fn of(ended: Ended, from_before: bool) -> Self {
        let Ended { seconds, attempts, failure, answer } = ended;
        Self { seconds, attempts, failure, from_before, numbers: Numbers::of(&answer) }
    }
}

/// How many recordings ended how.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// All of them.
    pub recordings: usize,
    /// Those with a result.
    pub good: usize,
    /// Those of them that an earlier run did.
    pub from_before: usize,
    /// Those with an error.
    pub failed: usize,
    /// Those that did not end.
    pub open: usize,
}

impl Counts {
    /// Of `lines`.
    #[must_use]
    pub fn of(lines: &[Line]) -> Self {
        let mut counts = Self { recordings: lines.len(), ..Self::default() };
        for line in lines {
            match &line.ended {
                None => counts.open += 1,
                Some(Outcome { failure: Some(_), .. }) => counts.failed += 1,
                Some(outcome) => {
                    counts.good += 1;
                    counts.from_before += usize::from(outcome.from_before);
                }
            }
        }
        counts
    }
}

/// Writes both tables.
///
/// # Errors
/// A table that cannot be written.
pub fn write(lines: &[Line], status: &Path, summary: &Path) -> Result<()> {
    write_atomically(status, |file| csv(lines, self::status, file))?;
    write_atomically(summary, |file| csv(lines, self::summary, file))
}

/// Writes `lines` as JSON, a line each.
///
/// # Errors
/// The file cannot be written.
pub fn write_json_lines(lines: &[Line], path: &Path) -> Result<()> {
    write_atomically(path, |file| Ok(file.write_all(json_lines(lines)?.as_bytes())?))
}

/// `lines` as JSON, a line each.
///
/// # Errors
/// None in practice.
pub fn json_lines(lines: &[Line]) -> Result<String> {
    let each = lines.iter().map(|line| Ok(serde_json::to_string(line)? + "\n"));
    each.collect()
}

/// What takes the rows of a table, of which the first names the columns.
pub type Sink<'a> = &'a mut dyn FnMut(&[Cow<'_, str>]) -> Result<()>;

/// A table by its rows.
pub type Table = fn(&[Line], Sink) -> Result<()>;

fn csv(lines: &[Line], table: Table, file: &mut dyn Write) -> Result<()> {
    let mut writer = csv::Writer::from_writer(file);
    table(lines, &mut |cells| Ok(writer.write_record(cells.iter().map(|cell| cell.as_bytes()))?))?;
    Ok(writer.flush()?)
}

/// The columns of the status table.
const STATUS: [&str; 7] = ["id", "key", "status", "class", "message", "seconds", "attempts"];

/// How each recording ended: `ok`, `error`, or `open`.
///
/// # Errors
/// Those of `sink`.
pub fn status(lines: &[Line], sink: Sink) -> Result<()> {
    sink(&STATUS.map(Cow::from))?;
    for line in lines {
        let failure = line.ended.as_ref().and_then(|ended| ended.failure.as_ref());
        let status = match (&line.ended, failure) {
            (None, _) => "open",
            (_, Some(_)) => "error",
            (Some(_), None) => "ok",
        };
        let (class, message) = failure.map_or(("", ""), |failure| (&failure.class, &failure.message));
        let number = |value: fn(&Outcome) -> String| line.ended.as_ref().map_or_else(String::new, value).into();
        sink(&[
            name_cell(&line.id),
            line.key.as_str().into(),
            status.into(),
            class.into(),
            name_cell(message),
            number(|ended| format!("{:.3}", ended.seconds)),
            number(|ended| ended.attempts.to_string()),
        ])?;
    }
    Ok(())
}

/// The numbers of each recording that has a result, a row each; a column is there if any has it.
///
/// # Errors
/// Those of `sink`.
pub fn summary(lines: &[Line], sink: Sink) -> Result<()> {
    let is_good = |line: &&Line| line.ended.as_ref().is_some_and(|ended| ended.failure.is_none());
    let good = || lines.iter().filter(is_good).filter_map(|line| Some((&line.id, &line.ended.as_ref()?.numbers)));
    let mut header = vec!["id".to_owned()];
    // The columns of each list of names.
    let mut columns: HashMap<*const String, Vec<usize>> = HashMap::new();
    for (_, numbers) in good() {
        columns.entry(numbers.names().as_ptr()).or_insert_with(|| {
            let known =
                |name: &String, header: &[String]| 1 + header[1..].iter().take_while(|other| *other != name).count();
            let column = |name: &String| {
                let column = known(name, &header);
                if column == header.len() {
                    header.push(name.clone());
                }
                column
            };
            numbers.names().iter().map(column).collect()
        });
    }
    sink(&header.iter().map(Cow::from).collect::<Vec<_>>())?;
    for (id, numbers) in good() {
        let mut cells = vec![Cow::from(""); header.len()];
        for (column, value) in columns[&numbers.names().as_ptr()].iter().zip(numbers.values()) {
            // Of a name that stands twice the first value counts.
            if cells[*column].is_empty() {
                cells[*column] = value.into();
            }
        }
        cells[0] = name_cell(id);
        sink(&cells)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn lines() -> Vec<Line> {
        let ended = |answer: Value, failure: Option<Failure>| {
            Some(Outcome::of(Ended { seconds: 0.5, attempts: 1, failure, answer }, false))
        };
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
            Line { id: "d".into(), key: "m".into(), ended: ended(json!({"frames": 3, "doubts": []}), None) },
        ]
    }

    fn text(table: Table) -> String {
        let mut bytes = Vec::new();
        csv(&lines(), table, &mut bytes).unwrap();
        String::from_utf8(bytes).unwrap()
    }

    #[test]
    fn tables_hold_a_row_each() {
        let status = text(status);
        let wanted = "id,key,status,class,message,seconds,attempts\na,k,ok,,,0.500,1\n";
        assert!(status.starts_with(wanted) && status.contains("c,,open,,,,\n"), "{status}");
        assert!(status.contains("b,l,error,data,\"'=broken, row 2\""), "{status}");
        let wanted = "id,cadence_per_min,knee_flexion_left_range_deg,doubts,frames\na,55.5,60.0,1,\nd,,,0,3\n";
        assert_eq!(text(summary), wanted);
        let counts = Counts { recordings: 4, good: 2, from_before: 0, failed: 1, open: 1 };
        assert_eq!(Counts::of(&lines()), counts);
    }

    #[test]
    fn lines_come_back_from_json() {
        let text = json_lines(&lines()).unwrap();
        let back: Vec<Line> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        assert_eq!(back, lines());
    }
}
