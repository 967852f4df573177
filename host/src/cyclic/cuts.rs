//! Cut lists: which frames of which angle tables are one cycle each.

use super::error::{CyclicError, read_text};
use crate::csv_text::csv_reader;
use crate::csv_text::{cell_name, name_cell};
use crate::error::Result;
use crate::output::write_atomically;
use std::path::{Path, PathBuf};

/// Columns that every cut list has.
pub const COLUMNS: [&str; 3] = ["file", "start_frame", "end_frame"];
/// The column after them that a list may have.
pub const PERSON: &str = "person";

/// One cycle.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cut {
    /// The table's name as the list has it: absolute, or relative to the list.
    pub file: String,
    /// First frame of the cycle.
    pub start_frame: u64,
    /// Frame after the last one: the first of the next cycle.
    pub end_frame: u64,
    /// Whose cycle it is, where the list says.
    pub person: Option<String>,
    /// Line of the list, from 1.
    pub line: u64,
}

impl Cut {
    /// Length of the cycle, frames.
    #[must_use]
    pub fn duration_frames(&self) -> u64 {
        self.end_frame - self.start_frame
    }
}

/// Cycles in the order of their list.
///
/// Invariants: at least one cut; each ends after it starts, and none overlaps another of its table;
/// all have a person or none has.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CutList {
    /// Where the list lies, for messages and relative names.
    path: PathBuf,
    cuts: Vec<Cut>,
}

impl CutList {
    /// Reads a list from a CSV file with the header `file,start_frame,end_frame`, after which
    /// `person` may stand.
    ///
    /// # Errors
    /// Names the file, the line and the rule that it broke.
    pub fn read(path: &Path) -> Result<Self, CyclicError> {
        Self::parse(&read_text(path)?, path)
    }

    /// Parses the text of a list that lies at `path`.
    ///
    /// # Errors
    /// Names the file, the line and the rule that it broke.
    pub fn parse(text: &str, path: &Path) -> Result<Self, CyclicError> {
        let mut reader = csv_reader(text);
        let (mut cuts, mut columns) = (Vec::new(), COLUMNS.len());
        for (index, record) in reader.records().enumerate() {
            let record = record.map_err(|error| CyclicError::broken(path, index as u64 + 1, error.to_string()))?;
            let line = record.position().map_or(0, csv::Position::line);
            if index > 0 {
                cuts.push(cut(&record, columns, line).map_err(|rule| CyclicError::broken(path, line, rule))?);
            } else if record.iter().eq(COLUMNS) || record.iter().eq(COLUMNS.into_iter().chain([PERSON])) {
                columns = record.len();
            } else {
                let rule = format!("the header has to be `{}`, and `,{PERSON}` if it is known", COLUMNS.join(","));
                return Err(CyclicError::broken(path, line, rule));
            }
        }
        if cuts.is_empty() {
            return Err(CyclicError::broken(
                path,
                1,
                "the list is empty; give at least one row file,start_frame,end_frame",
            ));
        }
        Self::of_cuts(cuts, path)
    }

    /// Cycles of tables that are in memory; `path` stands for them in messages.
    ///
    /// # Errors
    /// Names the rule of [`CutList`] that does not hold, and the cut.
    pub fn of_cuts(cuts: Vec<Cut>, path: &Path) -> Result<Self, CyclicError> {
        if cuts.is_empty() {
            return Err(CyclicError::unusable(path, "has no cycle; give at least two"));
        }
        if let Some(cut) = cuts.iter().find(|cut| cut.end_frame <= cut.start_frame) {
            let rule = format!("the end {} has to lie after the start {}", cut.end_frame, cut.start_frame);
            return Err(CyclicError::broken(path, cut.line, rule));
        }
        if let Some(cut) = cuts.iter().find(|cut| cut.person.is_some() != cuts[0].person.is_some()) {
            return Err(CyclicError::broken(path, cut.line, "either all cycles have a person or none"));
        }
        if let Some((cut, other)) = overlapping(&cuts) {
            let rule = format!(
                "the cycle overlaps that of frames {} to {} of the same table, and frames count once: take one of both out",
                other.start_frame, other.end_frame
            );
            return Err(CyclicError::broken(path, cut.line, rule));
        }
        Ok(Self { path: path.to_path_buf(), cuts })
    }

    /// The cuts, at least one.
    #[must_use]
    pub fn cuts(&self) -> &[Cut] {
        &self.cuts
    }

    /// Where the list lies.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Where the table of `cut` lies.
    #[must_use]
    pub fn table_path(&self, cut: &Cut) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(&cut.file)
    }
}

/// A cycle that begins before another one of its table ends, and that one.
fn overlapping(cuts: &[Cut]) -> Option<(&Cut, &Cut)> {
    let mut sorted: Vec<&Cut> = cuts.iter().collect();
    sorted.sort_by(|a, b| (&a.file, a.start_frame).cmp(&(&b.file, b.start_frame)));
    let mut pairs = sorted.windows(2).map(|pair| (pair[1], pair[0]));
    pairs.find(|(next, before)| next.file == before.file && next.start_frame < before.end_frame)
}

fn cut(record: &csv::StringRecord, columns: usize, line: u64) -> Result<Cut, String> {
    let (file, start, end, person) = match record.iter().collect::<Vec<_>>()[..] {
        [file, start, end] if columns == 3 => (file, start, end, None),
        [file, start, end, person] if columns == 4 => (file, start, end, Some(person)),
        _ => return Err(format!("a row needs {columns} columns, as the header, found {}", record.len())),
    };
    let frame = |name: &str, cell: &str| -> Result<u64, String> {
        cell.parse().map_err(|_| format!("`{name}` has to be a whole number from 0, found `{cell}`"))
    };
    let (start_frame, end_frame) = (frame("start_frame", start)?, frame("end_frame", end)?);
    if file.is_empty() {
        return Err("`file` is empty; name an angle table".into());
    }
    if end_frame <= start_frame {
        return Err(format!("`end_frame` {end_frame} has to lie after `start_frame` {start_frame}"));
    }
    if person == Some("") {
        return Err(format!("`{PERSON}` is empty; say whose cycle it is, or leave the column out"));
    }
    let person = person.map(|person| cell_name(person).to_owned());
    Ok(Cut { file: cell_name(file).to_owned(), start_frame, end_frame, person, line })
}

/// Writes a cut list under a temporary name, then renames it.
///
/// # Errors
/// Names the path with what the operating system refused.
pub fn write(path: &Path, cuts: &[Cut]) -> Result<()> {
    write_atomically(path, |output| {
        let mut writer = csv::Writer::from_writer(output);
        let has_person = cuts.iter().any(|cut| cut.person.is_some());
        writer.write_record(COLUMNS.into_iter().chain(has_person.then_some(PERSON)))?;
        for cut in cuts {
            let [file, person] = [&cut.file, cut.person.as_deref().unwrap_or_default()].map(|name| name_cell(name));
            let frames = [cut.start_frame, cut.end_frame].map(|frame| frame.to_string());
            let [start, end] = frames.each_ref().map(String::as_str);
            writer.write_record([&*file, start, end].into_iter().chain(has_person.then_some(&*person)))?;
        }
        Ok(writer.flush()?)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(rows: &str) -> Result<CutList, CyclicError> {
        CutList::parse(&format!("file,start_frame,end_frame\n{rows}"), Path::new("a/cuts.csv"))
    }

    #[test]
    fn tables_are_found_beside_the_list_or_by_their_absolute_name() {
        let list = parsed("t.csv,3,70\n/x/u.csv,0,1\n").unwrap();
        let paths: Vec<PathBuf> = list.cuts().iter().map(|cut| list.table_path(cut)).collect();
        assert_eq!(paths, [PathBuf::from("a/t.csv"), PathBuf::from("/x/u.csv")]);
        assert_eq!((list.cuts()[0].duration_frames(), list.cuts()[1].line), (67, 3));
    }

    #[test]
    fn a_list_survives_its_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("cuts.csv");
        let list = parsed("a b.csv,3,70\nt.csv,0,1\n").unwrap();
        write(&path, list.cuts()).unwrap();
        assert_eq!(CutList::read(&path).unwrap().cuts(), list.cuts());
        let mut cuts = list.cuts().to_vec();
        for (cut, person) in cuts.iter_mut().zip(["ann", "=bob"]) {
            cut.person = Some(person.into());
        }
        write(&path, &cuts).unwrap();
        assert_eq!(CutList::read(&path).unwrap().cuts(), cuts);
    }

    #[test]
    fn broken_lists_name_file_line_and_rule() {
        let cases = [
            ("t.csv,3\n", "a/cuts.csv:2: a row needs 3 columns, as the header, found 2"),
            ("t.csv,3,x\n", "a/cuts.csv:2: `end_frame` has to be a whole number"),
            ("t.csv,3,70\nt.csv,-3,70\n", "a/cuts.csv:3: `start_frame` has to be a whole number"),
            ("t.csv,70,70\n", "a/cuts.csv:2: `end_frame` 70 has to lie after"),
            (",3,70\n", "a/cuts.csv:2: `file` is empty"),
            ("t.csv,3,70\nu.csv,3,70\nt.csv,60,90\n", "a/cuts.csv:4: the cycle overlaps that of frames 3 to 70"),
            ("t.csv,3,70,ann\n", "a/cuts.csv:2: a row needs 3 columns, as the header, found 4"),
            ("", "a/cuts.csv:1: the list is empty"),
        ];
        for (rows, message) in cases {
            let found = parsed(rows).unwrap_err().to_string();
            assert!(found.starts_with(message), "{found}");
        }
        let unnamed = CutList::parse("file,start_frame,end_frame,person\nt.csv,1,2,\n", Path::new("c.csv"));
        assert!(unnamed.unwrap_err().to_string().starts_with("c.csv:2: `person` is empty"));
        let header = CutList::parse("t.csv,1,2\n", Path::new("c.csv")).unwrap_err().to_string();
        assert!(header.starts_with("c.csv:1: the header has to be `file,start_frame,end_frame`"), "{header}");
    }
}
