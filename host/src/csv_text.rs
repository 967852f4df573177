//! Reading of tables from text.

/// A reader of `text` that takes the header for a row, rows of any length, and trims cells.
pub(crate) fn csv_reader(text: &str) -> csv::Reader<&[u8]> {
    csv::ReaderBuilder::new().has_headers(false).flexible(true).trim(csv::Trim::All).from_reader(text.as_bytes())
}
