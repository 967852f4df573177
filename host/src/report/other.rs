//! Pages of folders that no other file here knows: records, tables and pictures as they are.

use super::document::{Level, Run, StillPicture};
use super::facts::{options_table, text};
use super::folder::RunFolder;
use super::pictures::Pictures;
use super::table::Table;
use serde_json::Value;

/// Maximum number of pictures of such a folder that are shown.
const MAX_PICTURES: usize = 24;

/// Evaluations whose folders hold nothing but tables: a file that each has, and its name on the
/// page.
const PLAIN_EVALUATIONS: [(&str, &str); 2] =
    [("hands.json", "Evaluation of both hands on real frames"), ("skin.json", "Evaluation of a skin model")];

/// Whatever is in `folder`.
pub fn other_run(mut folder: RunFolder, pictures: &mut Pictures) -> Run {
    let mut run = Run { name: folder.path().display().to_string(), ..Run::default() };
    run.kind = match PLAIN_EVALUATIONS.iter().find(|(name, _)| folder.has(name)) {
        Some((_, kind)) => (*kind).to_owned(),
        None => {
            folder.notice(
                Level::Note,
                "this is no folder of a track or an evaluation that is known here; its files are shown as they are",
            );
            "Folder with tables, records or pictures".to_owned()
        }
    };
    let names = folder.names();
    for name in &names {
        if name.ends_with(".json")
            && let Some(record) = folder.json(name)
        {
            add_record(&mut run, name, &record);
        }
        if name.ends_with(".csv") {
            run.tables.extend(folder.table(name, "Table of the folder"));
        }
    }
    let shown: Vec<&String> = names.iter().filter(|name| name.ends_with(".png") || name.ends_with(".jpg")).collect();
    for name in shown.iter().take(MAX_PICTURES) {
        add_picture(&mut run, &folder, name, pictures);
    }
    if shown.len() > MAX_PICTURES {
        folder.notice(Level::Note, format!("the first {MAX_PICTURES} of {} pictures are shown", shown.len()));
    }
    run.notices = folder.into_notices();
    run
}

/// Adds the picture `name` of the folder, if it is there.
pub fn add_picture(run: &mut Run, folder: &RunFolder, name: &str, pictures: &mut Pictures) {
    if folder.has(name) {
        let block = pictures.add(vec![Some(folder.path().join(name))]);
        run.pictures.push(StillPicture { name: name.to_owned(), block });
    }
}

/// A record: its lists of objects as tables, the rest as lines.
fn add_record(run: &mut Run, name: &str, record: &Value) {
    let mut rest = record.clone();
    if let Some(map) = rest.as_object_mut() {
        let lists: Vec<String> =
            map.iter().filter(|(_, value)| is_list_of_objects(value)).map(|(key, _)| key.clone()).collect();
        for key in lists {
            if let Some(list) = map.remove(&key) {
                run.tables.push(list_table(&format!("{name}: {key}"), "List of the record", &list));
            }
        }
    }
    run.tables.push(options_table(name, &rest));
}

fn is_list_of_objects(value: &Value) -> bool {
    value.as_array().is_some_and(|list| list.len() > 1 && list.iter().all(Value::is_object))
}

/// A row for each object of a list, a column for each of their names.
#[must_use]
pub fn list_table(name: &str, title: &str, list: &Value) -> Table {
    let flat: Vec<Vec<Vec<String>>> =
        list.as_array().into_iter().flatten().map(|one| options_table("", one).rows).collect();
    let mut columns: Vec<&str> = Vec::new();
    for key in flat.iter().flatten().map(|row| row[0].as_str()) {
        if !columns.contains(&key) {
            columns.push(key);
        }
    }
    let mut table = Table::new(name, title, &columns);
    for one in &flat {
        let cell =
            |column: &&str| one.iter().find(|row| row[0] == *column).map_or_else(String::new, |row| row[1].clone());
        table.rows.push(columns.iter().map(cell).collect());
    }
    if table.columns.is_empty() {
        table = Table::new(name, title, &["value"]);
        table.rows = list.as_array().into_iter().flatten().map(|one| vec![text(one)]).collect();
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_list_of_objects_becomes_a_table_of_all_their_names() {
        let table = list_table("l", "", &json!([{"a": 1, "b": {"c": "x"}}, {"d": true}]));
        assert_eq!(table.to_csv(), "a,b.c,d\n1,x,\n,,yes\n");
    }

    #[test]
    fn a_record_falls_into_lists_and_lines() {
        let mut run = Run::default();
        add_record(&mut run, "r.json", &json!({"rows": [{"a": 1}, {"a": 2}], "seed": 3, "one": [{"a": 1}]}));
        let names: Vec<(&str, usize)> =
            run.tables.iter().map(|table| (table.name.as_str(), table.rows.len())).collect();
        assert_eq!(names, [("r.json: rows", 2), ("r.json", 2)]);
    }
}
