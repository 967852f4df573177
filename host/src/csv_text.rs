//! Tables as text.

use crate::limits::MAX_LINE_BYTES;
use std::borrow::Cow;
use std::cell::Cell;
use std::io::{self, Read};
use std::rc::Rc;

/// A reader of `text` that takes the header for a row, rows of any length, and trims cells.
pub(crate) fn csv_reader(text: &str) -> csv::Reader<&[u8]> {
    reader(text.as_bytes())
}

/// As [`csv_reader`], of cells that `separator` parts.
pub(crate) fn separated_reader(text: &str, separator: u8) -> csv::Reader<&[u8]> {
    let mut builder = csv::ReaderBuilder::new();
    builder.has_headers(false).flexible(true).trim(csv::Trim::All).delimiter(separator).from_reader(text.as_bytes())
}

/// A reader of `text` whose first row has the columns' names.
pub(crate) fn headed_reader(text: &str) -> csv::Reader<&[u8]> {
    csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text.as_bytes())
}

fn reader<R: Read>(input: R) -> csv::Reader<R> {
    csv::ReaderBuilder::new().has_headers(false).flexible(true).trim(csv::Trim::All).from_reader(input)
}

/// Why there is no next record.
#[derive(Debug, thiserror::Error)]
pub(crate) enum RecordError {
    /// The operating system refused to read on.
    #[error("{0}")]
    Io(io::Error),
    /// It has more bytes than are kept.
    #[error("a line has more than {MAX_LINE_BYTES} bytes, the most that is read")]
    TooLong { line: u64 },
    /// It is no record.
    #[error("{reason}")]
    Broken { line: u64, reason: String },
}

/// Records of a table of any length, of which only one is in memory. Bytes that are not UTF-8 are
/// replaced.
#[derive(Debug)]
pub(crate) struct RecordReader<R> {
    reader: csv::Reader<Metered<R>>,
    since_record: Rc<Cell<usize>>,
    /// Bytes and cells of the last record: the next one seldom needs more.
    usual: (usize, usize),
}

impl<R: Read> RecordReader<R> {
    pub(crate) fn new(input: R) -> Self {
        let since_record = Rc::default();
        let metered = Metered { input, since_record: Rc::clone(&since_record) };
        Self { reader: reader(metered), since_record, usual: (0, 0) }
    }

    /// The next record, the header being the first.
    pub(crate) fn next(&mut self) -> Result<Option<csv::StringRecord>, RecordError> {
        let mut record = csv::ByteRecord::with_capacity(self.usual.0, self.usual.1);
        self.since_record.set(0);
        match self.reader.read_byte_record(&mut record) {
            Ok(true) => {
                self.usual = (record.as_slice().len(), record.len());
                Ok(Some(csv::StringRecord::from_byte_record_lossy(record)))
            }
            Ok(false) => Ok(None),
            Err(error) => Err(self.refusal(error)),
        }
    }

    fn refusal(&self, error: csv::Error) -> RecordError {
        let line = self.reader.position().line();
        let reason = error.to_string();
        match error.into_kind() {
            csv::ErrorKind::Io(_) if self.since_record.get() > MAX_LINE_BYTES => RecordError::TooLong { line },
            csv::ErrorKind::Io(reason) => RecordError::Io(reason),
            _ => RecordError::Broken { line, reason },
        }
    }
}

/// Counts the bytes that were read for a record, and stops before they fill the memory.
#[derive(Debug)]
struct Metered<R> {
    input: R,
    since_record: Rc<Cell<usize>>,
}

impl<R: Read> Read for Metered<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.since_record.get() > MAX_LINE_BYTES {
            return Err(io::ErrorKind::InvalidData.into());
        }
        let count = self.input.read(buffer)?;
        self.since_record.set(self.since_record.get() + count);
        Ok(count)
    }
}

/// A cell that holds a name: what a spreadsheet would take for a formula gets an apostrophe, which
/// makes it text there.
pub(crate) fn name_cell(name: &str) -> Cow<'_, str> {
    let is_formula = name.starts_with(['=', '+', '-', '@', '\t', '\r']) && name.parse::<f64>().is_err();
    if is_formula { Cow::Owned(format!("'{name}")) } else { Cow::Borrowed(name) }
}

/// The name in a cell of [`name_cell`].
pub(crate) fn cell_name(cell: &str) -> &str {
    match cell.strip_prefix('\'') {
        Some(name) if name_cell(name) == cell => name,
        _ => cell,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quote_that_never_ends_is_refused_before_it_fills_the_memory() {
        let text = format!("a,b\n\"{}", "x".repeat(4 * MAX_LINE_BYTES));
        let mut records = RecordReader::new(text.as_bytes());
        assert_eq!(records.next().unwrap().unwrap().len(), 2);
        assert!(matches!(records.next().unwrap_err(), RecordError::TooLong { line: 2 }));
    }

    #[test]
    fn marks_and_wrong_bytes_are_no_obstacle() {
        let mut records = RecordReader::new(&b"\xef\xbb\xbfa,b\n1, \xff \n"[..]);
        assert_eq!(records.next().unwrap().unwrap().get(0), Some("a"));
        assert_eq!(records.next().unwrap().unwrap().get(1), Some("\u{fffd}"));
        assert!(records.next().unwrap().is_none());
    }

    #[test]
    fn formulas_are_text_and_come_back() {
        for name in ["=cmd|calc!A0.png", "-x", "@a", "+1+1"] {
            assert_eq!(name_cell(name), format!("'{name}"));
            assert_eq!(cell_name(&name_cell(name)), name);
        }
        for name in ["a.png", "-1.5", "'quoted'", ""] {
            assert_eq!((name_cell(name).as_ref(), cell_name(name)), (name, name));
        }
    }
}
