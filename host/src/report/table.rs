//! Tables of text as the files of a run hold them: nothing is rounded on the way to the page.

use serde::ser::{Serialize, SerializeStruct, Serializer};

/// A table with a heading row; every row has a cell for each column.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Table {
    /// File name, which plots refer to.
    pub name: String,
    /// What it holds.
    pub title: String,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// The cells.
    pub rows: Vec<Vec<String>>,
}

/// What was odd about the text of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Oddities {
    /// Rows that had another number of cells than the heading, and were left out.
    pub ragged_rows: usize,
    /// Whether some bytes were no UTF-8.
    pub not_text: bool,
}

impl Table {
    /// An empty table.
    #[must_use]
    pub fn new(name: &str, title: &str, columns: &[&str]) -> Self {
        let columns = columns.iter().map(|&column| column.to_owned()).collect();
        Self { name: name.to_owned(), title: title.to_owned(), columns, rows: Vec::new() }
    }

    /// Reads CSV; rows that do not fit the heading are left out and counted.
    #[must_use]
    pub fn parse(name: &str, title: &str, bytes: &[u8]) -> (Self, Oddities) {
        let mut table = Self::new(name, title, &[]);
        let mut odd = Oddities::default();
        let mut reader = csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(bytes);
        for record in reader.byte_records() {
            let Ok(record) = record else {
                odd.ragged_rows += 1;
                continue;
            };
            odd.not_text |= record.iter().any(|cell| std::str::from_utf8(cell).is_err());
            let cells: Vec<String> = record.iter().map(|cell| String::from_utf8_lossy(cell).into_owned()).collect();
            if table.columns.is_empty() {
                table.columns = cells;
            } else if cells.len() == table.columns.len() {
                table.rows.push(cells);
            } else {
                odd.ragged_rows += 1;
            }
        }
        (table, odd)
    }

    /// Index of a column.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column == name)
    }

    /// Whether there is a column of this name.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.column(name).is_some()
    }

    /// Cell of a row in the column of this name; empty where there is none.
    #[must_use]
    pub fn cell<'a>(&'a self, row: &'a [String], name: &str) -> &'a str {
        self.column(name).and_then(|column| row.get(column)).map_or("", String::as_str)
    }

    /// Number in a row and column, if there is one.
    #[must_use]
    pub fn number(&self, row: &[String], name: &str) -> Option<f64> {
        self.cell(row, name).trim().parse().ok().filter(|value: &f64| value.is_finite())
    }

    /// The different cells of a column, in the order of their first row.
    #[must_use]
    pub fn distinct(&self, name: &str) -> Vec<String> {
        let Some(column) = self.column(name) else { return Vec::new() };
        let mut seen = std::collections::BTreeSet::new();
        let cells = self.rows.iter().map(|row| &row[column]);
        cells.filter(|cell| seen.insert(cell.as_str())).cloned().collect()
    }

    /// First and last number of the frames that the table jumps over, in each place where it does
    /// so by more than the usual step.
    #[must_use]
    pub fn frame_gaps(&self) -> Vec<[u64; 2]> {
        let frames: Vec<u64> = self.distinct("frame").iter().filter_map(|frame| frame.trim().parse().ok()).collect();
        let pairs = || frames.windows(2).filter(|pair| pair[1] > pair[0]);
        let mut steps: Vec<u64> = pairs().map(|pair| pair[1] - pair[0]).collect();
        steps.sort_unstable();
        let Some(&usual) = steps.get(steps.len() / 2) else { return Vec::new() };
        pairs().filter(|pair| pair[1] - pair[0] > usual).map(|pair| [pair[0] + 1, pair[1] - 1]).collect()
    }

    /// Keeps the rows of every `every`-th of the different cells of the first column.
    pub fn thin(&mut self, every: usize) {
        let mut before: Option<String> = None;
        let mut index = 0;
        self.rows.retain(|row| {
            let first = row.first().cloned().unwrap_or_default();
            if before.as_ref().is_some_and(|before| *before != first) {
                index += 1;
            }
            before = Some(first);
            index % every == 0
        });
    }

    /// The table as CSV.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let mut writer = csv::WriterBuilder::new().flexible(true).from_writer(Vec::new());
        for row in std::iter::once(&self.columns).chain(&self.rows) {
            // Writing to memory cannot fail.
            let _ = writer.write_record(row);
        }
        String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
    }
}

impl Serialize for Table {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut table = serializer.serialize_struct("Table", 4)?;
        table.serialize_field("name", &self.name)?;
        table.serialize_field("title", &self.title)?;
        table.serialize_field("csv", &self.to_csv())?;
        table.serialize_field("rows", &self.rows.len())?;
        table.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_come_back_as_they_were() {
        let text = "frame,name\n0,\"a,\"\"b\"\"\"\n1,0.10\n";
        let (table, odd) = Table::parse("t.csv", "", text.as_bytes());
        assert_eq!((table.rows.len(), odd), (2, Oddities::default()));
        assert_eq!(table.cell(&table.rows[0], "name"), "a,\"b\"");
        assert_eq!(table.to_csv(), text);
    }

    #[test]
    fn a_row_that_was_cut_off_is_left_out_and_counted() {
        let (table, odd) = Table::parse("t.csv", "", b"frame,x_m,y_m\n0,1,2\n1,1");
        assert_eq!((table.rows.len(), odd.ragged_rows), (1, 1));
        let (empty, odd) = Table::parse("t.csv", "", b"");
        assert!(empty.columns.is_empty() && odd == Oddities::default());
        let (latin, odd) = Table::parse("t.csv", "", b"a\n\xe9\n");
        assert!(odd.not_text && latin.rows.len() == 1);
    }

    #[test]
    fn thinning_keeps_both_sides_of_a_frame() {
        let text = "frame,side\n0,left\n0,right\n1,left\n1,right\n2,left\n2,right\n";
        let (mut table, _) = Table::parse("t.csv", "", text.as_bytes());
        table.thin(2);
        assert_eq!(table.to_csv(), "frame,side\n0,left\n0,right\n2,left\n2,right\n");
        assert_eq!(table.distinct("frame"), ["0", "2"]);
    }

    #[test]
    fn frames_that_are_jumped_over_are_gaps() {
        let gaps = |frames: &str| Table::parse("t.csv", "", format!("frame\n{frames}").as_bytes()).0.frame_gaps();
        assert_eq!(gaps("0\n0\n1\n2\n4\n5\n9\n"), [[3, 3], [6, 8]]);
        assert!(gaps("0\n5\n10\n").is_empty() && gaps("4\n").is_empty() && gaps("x\n").is_empty());
    }

    #[test]
    fn a_number_that_is_none_is_not_there() {
        let (table, _) = Table::parse("t.csv", "", b"a,b,c\n1.5,NaN,\n");
        let row = &table.rows[0];
        assert_eq!(["a", "b", "c", "d"].map(|name| table.number(row, name)), [Some(1.5), None, None, None]);
    }
}
