//! The numbers of a recording as the summary has them. Names, which recordings share, are kept
//! once: a million recordings take one gigabyte.

use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, PoisonError};

/// Parts of a run's record that say what was asked for, not what was found, and times, which differ
/// from run to run.
const NOT_SHOWN: [&str; 7] = ["body", "options", "inputs", "version", "seed", "frames_per_second", "seconds_per_step"];

/// All lists of names so far.
static NAMES: Mutex<BTreeSet<Arc<[String]>>> = Mutex::new(BTreeSet::new());

/// Numbers, as text, with their names.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "Vec<(String, String)>", into = "Vec<(String, String)>")]
pub struct Numbers {
    names: Arc<[String]>,
    /// A value a line.
    values: Box<str>,
}

impl Numbers {
    /// Those of an answer at its top, in `summary`, of each joint in `symmetries`, and in `run`;
    /// `doubts` by their number.
    #[must_use]
    pub fn of(answer: &Value) -> Self {
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
        add_all("", &answer["run"], &mut found);
        if let Some(doubts) = answer["doubts"].as_array() {
            found.push(("doubts".to_owned(), doubts.len().to_string()));
        }
        found.into()
    }

    /// Names, the same place in memory for the same names.
    #[must_use]
    pub fn names(&self) -> &Arc<[String]> {
        &self.names
    }

    /// Values in the order of their names.
    pub fn values(&self) -> impl Iterator<Item = &str> {
        self.values.lines()
    }
}

/// Adds the numbers of a record and of those inside it.
fn add_all(prefix: &str, record: &Value, found: &mut Vec<(String, String)>) {
    for (name, value) in
        record.as_object().into_iter().flatten().filter(|(name, _)| !NOT_SHOWN.contains(&name.as_str()))
    {
        match value {
            Value::Number(_) | Value::Bool(_) => found.push((format!("{prefix}{name}"), value.to_string())),
            Value::Object(_) => add_all(&format!("{prefix}{name}_"), value, found),
            _ => (),
        }
    }
}

impl From<Vec<(String, String)>> for Numbers {
    fn from(cells: Vec<(String, String)>) -> Self {
        let (names, values): (Vec<String>, Vec<String>) = cells.into_iter().unzip();
        let names: Arc<[String]> = names.into();
        let mut all = NAMES.lock().unwrap_or_else(PoisonError::into_inner);
        let known = all.get(&names).cloned();
        let names = known.unwrap_or_else(|| {
            all.insert(Arc::clone(&names));
            names
        });
        Self { names, values: values.join("\n").into() }
    }
}

impl From<Numbers> for Vec<(String, String)> {
    fn from(numbers: Numbers) -> Self {
        numbers.names.iter().cloned().zip(numbers.values().map(str::to_owned)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn names_are_kept_once_and_come_back() {
        let numbers =
            |cadence| Numbers::of(&json!({ "summary": { "cadence": cadence }, "out": "x", "doubts": ["one"] }));
        let (one, two) = (numbers(1.5), numbers(2.5));
        assert!(Arc::ptr_eq(one.names(), two.names()));
        let text = serde_json::to_string(&one).unwrap();
        assert_eq!(text, r#"[["cadence","1.5"],["doubts","1"]]"#);
        assert_eq!(serde_json::from_str::<Numbers>(&text).unwrap(), one);
        let run = json!({ "run": { "frames": 3, "seed": 1, "options": { "x": 1 }, "seen": { "hands": 2 } } });
        assert_eq!(Vec::from(Numbers::of(&run)), [("frames".into(), "3".into()), ("seen_hands".into(), "2".into())]);
        assert_eq!(Numbers::of(&Value::Null).values().count(), 0);
    }
}
