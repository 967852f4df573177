//! The list of recordings: a CSV table, JSON lines or, with the feature `parquet`, a Parquet file.

use super::content::{Cells, cannot_read, names_in};
use crate::cli::data_error;
use crate::csv_text::headed_reader;
use crate::cyclic::angle_table::AngleRows;
use crate::file::{FileError, STANDARD_INPUT, read_lines};
use crate::registry::{Kind, extensions, find_by_content};
use serde_json::{Map, Value};
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

/// Columns that are no options.
const OWN: [&str; 4] = ["id", "input", "kind", DEFAULTS];
/// Column of [`Row::defaults`], as a JSON object.
const DEFAULTS: &str = "set";
/// How the names of files end that lie beside angle tables.
const ABOUT: &str = ".about.json";
/// What a file of a folder may hold to count as a recording; a video has its error in the tables.
const RECORDINGS: [Kind; 4] = [Kind::JointMotion, Kind::MarkerMotion, Kind::Keypoints, Kind::Video];

/// One recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Row {
    /// Its line in the manifest.
    pub line: usize,
    /// Its name in all tables.
    pub id: String,
    /// The file or folder.
    pub input: PathBuf,
    /// Where files lie that options name; the later folder counts where the first has none.
    pub folders: [PathBuf; 2],
    /// What is done with it; found by the input where none is given.
    pub kind: Option<String>,
    /// Values of options by the names of their flags.
    pub options: BTreeMap<String, String>,
    /// Values for where `options` have none, of options that the row's kind has.
    pub defaults: BTreeMap<String, String>,
}

impl Row {
    /// The row as a line that [`of_lines`] reads.
    #[must_use]
    pub fn to_json(&self) -> String {
        let own = [("id", Some(self.id.clone())), ("kind", self.kind.clone())];
        let own = own.into_iter().filter_map(|(name, value)| Some((name.to_owned(), value?)));
        let input = ("input".to_owned(), self.input.to_string_lossy().into_owned());
        let defaults = serde_json::to_string(&self.defaults).ok().filter(|_| !self.defaults.is_empty());
        let defaults = defaults.map(|text| (DEFAULTS.to_owned(), text));
        let cells = own.chain([input]).chain(defaults).chain(self.options.clone());
        Value::Object(cells.map(|(name, value)| (name, Value::String(value))).collect::<Map<_, _>>()).to_string()
    }

    /// Gives it each of `options` for where it has no value of its own.
    pub fn set(&mut self, options: &[(String, String)]) {
        for (name, value) in options {
            self.defaults.entry(name.clone()).or_insert_with(|| value.clone());
        }
    }
}

/// The recordings of a manifest or a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Manifest {
    /// Never empty.
    pub rows: Vec<Row>,
    /// Files of the folder that no reader knows, which are no rows.
    pub skipped: usize,
}

/// The recordings of a manifest, or all in a folder. Inputs are relative to `folder`, else
/// to the manifest's own.
///
/// # Errors
/// The line and the rule that it broke: a column `id` or `input` that is missing or empty, an id
/// that comes twice; a folder with nothing in it.
pub fn read(path: &Path, folder: Option<&Path>) -> anyhow::Result<Manifest> {
    let is_standard = path.as_os_str() == STANDARD_INPUT;
    if path.is_dir() && !is_standard {
        return everything_in(path);
    }
    let name = if is_standard { "standard input".to_owned() } else { path.display().to_string() };
    let extension = path.extension().and_then(|extension| extension.to_str());
    let own = path.parent().unwrap_or(Path::new(""));
    let folders = [folder.unwrap_or(own).to_path_buf(), PathBuf::new()];
    let listed = |rows: Vec<Row>| Manifest { rows, skipped: 0 };
    if extension == Some("parquet") {
        return rows_of(super::parquet::cells(path)?, &name, &folders).map(listed);
    }
    let text = read_lines(path).map_err(|error| match error {
        FileError::Io(reason) => anyhow::Error::new(reason).context(cannot_read(path)),
        other => data_error(format!("{name}:{}: {other}", other.line())),
    })?;
    let is_json = match extension {
        Some(extension) => matches!(extension, "jsonl" | "ndjson"),
        None => is_standard && text.trim_start().starts_with('{'),
    };
    let rows = if is_json { of_lines(&text, &name, &folders) } else { rows_of(table(&text), &name, &folders) };
    rows.map(listed)
}

/// The recordings of JSON lines; `name` is what messages call the text.
///
/// # Errors
/// As [`read`].
pub fn of_lines(text: &str, name: &str, folders: &[PathBuf; 2]) -> anyhow::Result<Vec<Row>> {
    rows_of(json_lines(text), name, folders)
}

fn rows_of(cells: Cells, name: &str, folders: &[PathBuf; 2]) -> anyhow::Result<Vec<Row>> {
    let broken = |line: usize, rule: &str| data_error(format!("{name}:{line}: {rule}"));
    let mut lines: HashMap<String, usize> = HashMap::new();
    let mut rows = Vec::new();
    for (line, cells) in cells.map_err(|(line, rule)| broken(line, &rule))? {
        let mut options: BTreeMap<String, String> = cells.into_iter().filter(|(_, value)| !value.is_empty()).collect();
        let [id, input, kind, defaults] = OWN.map(|name| options.remove(name));
        let defaults = defaults.map(|text| serde_json::from_str(&text)).transpose();
        let defaults = defaults.map_err(|_| broken(line, "has a `set` that is no JSON object of texts"))?;
        let id = id.ok_or_else(|| broken(line, "needs an `id`, the name of the recording in all tables"))?;
        let input = input.ok_or_else(|| broken(line, "needs an `input`, a file or folder"))?;
        if let Some(before) = lines.insert(id.clone(), line) {
            return Err(broken(line, &format!("has the id `{id}` of line {before}; ids have to differ")));
        }
        let (input, folders, defaults) = (folders[0].join(input), folders.clone(), defaults.unwrap_or_default());
        rows.push(Row { line, id, input, folders, kind, options, defaults });
    }
    if rows.is_empty() {
        return Err(broken(1, "names no recording; give a table with the columns `id` and `input`, a recording a row"));
    }
    Ok(rows)
}

/// One recording for each folder and each file that a reader knows in `folder`, named by it.
fn everything_in(folder: &Path) -> anyhow::Result<Manifest> {
    let mut names = names_in(folder)?;
    names.retain(|name| !name.starts_with('.') && !name.ends_with(ABOUT));
    let before = names.len();
    names.retain(|name| is_recording(&folder.join(name)));
    let skipped = before - names.len();
    let row = |(index, name): (usize, String)| {
        let id = name.rsplit_once('.').map_or(name.as_str(), |(stem, _)| stem).to_owned();
        let folders = [folder.to_path_buf(), PathBuf::new()];
        let (options, defaults) = (BTreeMap::new(), BTreeMap::new());
        Row { line: index + 1, id, input: folder.join(name), folders, kind: None, options, defaults }
    };
    let mut rows: Vec<Row> = names.into_iter().enumerate().map(row).collect();
    if rows.is_empty() {
        let found = match skipped {
            0 => "is empty".to_owned(),
            _ => format!("holds no recording ({}), but other files", extensions(&RECORDINGS)),
        };
        return Err(data_error(format!("`{}` {found}; give a folder of recordings, or a manifest", folder.display())));
    }
    let of_one_stem: Vec<String> =
        rows.windows(2).filter(|pair| pair[0].id == pair[1].id).map(|pair| pair[0].id.clone()).collect();
    for row in rows.iter_mut().filter(|row| of_one_stem.contains(&row.id)) {
        row.id = row.input.file_name().unwrap_or_default().to_string_lossy().into_owned();
    }
    Ok(Manifest { rows, skipped })
}

/// Whether a reader knows what is at `path`: a folder, an angle table, a file of a known ending
/// unless it is a text without a table.
fn is_recording(path: &Path) -> bool {
    path.is_dir() || find_by_content(path, &RECORDINGS).is_some() || AngleRows::open(path).is_ok()
}

fn table(text: &str) -> Cells {
    let mut reader = headed_reader(text);
    let header = reader.headers().map_err(|error| (1, error.to_string()))?.clone();
    let mut found = Vec::new();
    for record in reader.records() {
        let line = |error: &csv::Error| error.position().map_or(1, |position| position.line() as usize);
        let record = record.map_err(|error| (line(&error), error.to_string()))?;
        let cells = header.iter().zip(&record).map(|(name, cell)| (name.to_owned(), cell.to_owned()));
        found.push((record.position().map_or(1, |position| position.line() as usize), cells.collect()));
    }
    Ok(found)
}

fn json_lines(text: &str) -> Cells {
    let mut found = Vec::new();
    for (index, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let broken = |rule: String| (index + 1, rule);
        let object: Map<String, Value> =
            serde_json::from_str(line).map_err(|error| broken(format!("is no JSON object ({error})")))?;
        let cell = |(name, value): (String, Value)| match value {
            Value::Null => Ok((name, String::new())),
            Value::String(text) => Ok((name, text)),
            Value::Bool(_) | Value::Number(_) => Ok((name, value.to_string())),
            _ => Err(broken(format!("`{name}` has to be a text, a number, true or false"))),
        };
        found.push((index + 1, object.into_iter().map(cell).collect::<Result<_, _>>()?));
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn read_text(name: &str, text: &str) -> Result<Vec<Row>, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        let rows = read(&path, None).map_err(|error| error.to_string())?.rows;
        let short = |row: Row| Row { input: row.input.file_name().unwrap().into(), folders: Default::default(), ..row };
        Ok(rows.into_iter().map(short).collect())
    }

    #[test]
    fn a_table_and_json_lines_say_the_same() {
        let table =
            read_text("m.csv", "id,input,kind,model,online\na,1.csv,cyclic,running,true\nb,2.csv,,,\n").unwrap();
        let lines = "{\"id\":\"a\",\"input\":\"1.csv\",\"kind\":\"cyclic\",\"model\":\"running\",\"online\":true}\n\
            {\"id\":\"b\",\"input\":\"2.csv\",\"model\":null}\n";
        let mut lines = read_text("m.jsonl", lines).unwrap();
        lines.iter_mut().for_each(|row| row.line += 1);
        assert_eq!(table, lines);
        assert_eq!((table[0].options["model"].as_str(), table[1].kind.as_deref()), ("running", None));
    }

    #[test]
    fn a_folder_is_a_manifest_of_what_is_in_it() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["b.csv", "b.json", "a.trc", ".hidden", "a.about.json", "README", "notes.md", "02.asf", "f.png"] {
            fs::write(folder.path().join(name), "1").unwrap();
        }
        fs::write(folder.path().join("session.txt"), "Anna, in shoes\n").unwrap();
        fs::write(folder.path().join("run.txt"), "0.5,1\n").unwrap();
        let angles = crate::cyclic::angle_table::COLUMNS.join(",") + "\n";
        fs::write(folder.path().join("table.data"), angles).unwrap();
        let found = read(folder.path(), None).unwrap();
        let ids: Vec<String> = found.rows.into_iter().map(|row| row.id).collect();
        assert_eq!((ids.join(" ").as_str(), found.skipped), ("a b.csv b.json run table", 5));
        let refusal = |folder: &Path| read(folder, None).unwrap_err().to_string();
        let empty = tempfile::tempdir().unwrap();
        assert!(refusal(empty.path()).contains("is empty"));
        fs::write(empty.path().join("README"), "1").unwrap();
        assert!(refusal(empty.path()).contains("holds no recording (.bvh, "), "{}", refusal(empty.path()));
    }

    #[test]
    fn a_row_is_read_as_it_was_written() {
        let set = [("model", "running"), ("rate", "30")].map(|(name, value)| (name.to_owned(), value.to_owned()));
        let mut rows = read_text("m.csv", "id,input,model\na,1.csv,walking\n").unwrap();
        rows[0].set(&set);
        let read = of_lines(&rows[0].to_json(), "part", &Default::default()).unwrap();
        assert_eq!((&read[0].options, &read[0].defaults), (&rows[0].options, &rows[0].defaults));
        assert_eq!((read[0].options["model"].as_str(), read[0].defaults["rate"].as_str()), ("walking", "30"));
    }

    #[test]
    fn broken_manifests_name_the_line() {
        let refusal = |name: &str, text: &str| read_text(name, text).unwrap_err();
        assert!(refusal("m.csv", "id,input\na,1\na,2\n").contains("m.csv:3: has the id `a` of line 2"));
        assert!(refusal("m.csv", "id,input\n,1\n").contains("m.csv:2: needs an `id`"));
        assert!(refusal("m.csv", "id\na\n").contains("needs an `input`"));
        assert!(refusal("m.csv", "id,input\n").contains("names no recording"));
        assert!(refusal("m.jsonl", "[1]\n").contains("m.jsonl:1: is no JSON object"));
        assert!(refusal("m.jsonl", "{\"id\":[1]}\n").contains("`id` has to be a text"));
    }
}
