//! Records as lines for a reader.

use super::document::Fact;
use super::table::Table;
use serde_json::Value;

/// The options of a record as a table: nested names with dots between.
#[must_use]
pub fn options_table(name: &str, options: &Value) -> Table {
    let mut table = Table::new(name, "All options", &["option", "value"]);
    flatten("", options, &mut table.rows);
    table
}

fn flatten(prefix: &str, value: &Value, rows: &mut Vec<Vec<String>>) {
    match value {
        Value::Object(map) => {
            for (key, value) in map {
                let name = if prefix.is_empty() { key.clone() } else { format!("{prefix}.{key}") };
                flatten(&name, value, rows);
            }
        }
        Value::Null => rows.push(vec![prefix.to_owned(), String::new()]),
        other => rows.push(vec![prefix.to_owned(), text(other)]),
    }
}

/// A value as a reader wants it: no quotes around text, lists with commas between.
#[must_use]
pub fn text(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        Value::Bool(true) => "yes".to_owned(),
        Value::Bool(false) => "no".to_owned(),
        Value::Array(values) => values.iter().map(text).collect::<Vec<_>>().join(", "),
        other => other.to_string(),
    }
}

/// A fact for each of the fields that the record has and that is not null: name of the field,
/// label.
#[must_use]
pub fn facts_of(record: &Value, fields: &[(&str, &str)]) -> Vec<Fact> {
    let known = fields.iter().filter(|(field, _)| !record[*field].is_null());
    known.map(|(field, label)| Fact::new(*label, text(&record[*field]))).collect()
}

/// A number with so many decimals and its unit; nothing where the record has none.
#[must_use]
pub fn number(value: &Value, decimals: usize, unit: &str) -> Option<String> {
    let number = value.as_f64()?;
    Some(if unit.is_empty() { format!("{number:.decimals$}") } else { format!("{number:.decimals$} {unit}") })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn nested_options_get_names_with_dots() {
        let table = options_table("o", &json!({"b": {"c": [1, 2.5], "d": null}, "a": "x", "e": true}));
        let rows: Vec<String> = table.rows.iter().map(|row| row.join("=")).collect();
        assert_eq!(rows, ["a=x", "b.c=1, 2.5", "b.d=", "e=yes"]);
    }

    #[test]
    fn facts_leave_out_what_is_not_known() {
        let facts = facts_of(&json!({"seed": 7, "stick": null}), &[("seed", "Seed"), ("stick", "Stick"), ("x", "X")]);
        assert_eq!(facts, [Fact::new("Seed", "7")]);
        assert_eq!(number(&json!(0.12345), 2, "m").as_deref(), Some("0.12 m"));
        assert_eq!(number(&json!("no"), 2, "m"), None);
    }
}
