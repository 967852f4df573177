//! Rows of text as a table of Markdown.

/// A heading and the rows below it, cell by cell.
pub type Rows = Vec<Vec<String>>;

/// The table's lines; each row has the cells of the first one.
///
/// ```
/// use sinew_lab::tables::markdown::{line, table};
/// let rows = vec![line(["", "error"]), line(["guided", "0.45"])];
/// assert_eq!(table(&rows), "| | error |\n|---|---|\n| guided | 0.45 |\n");
/// ```
#[must_use]
pub fn table(rows: &Rows) -> String {
    let mut text = String::new();
    for (index, row) in rows.iter().enumerate() {
        let cells: String =
            row.iter().map(|cell| if cell.is_empty() { " |".to_owned() } else { format!(" {cell} |") }).collect();
        text.push_str(&format!("|{cells}\n"));
        if index == 0 {
            text.push_str(&format!("|{}\n", "---|".repeat(row.len())));
        }
    }
    text
}

/// A row of these cells.
#[must_use]
pub fn line<T: Into<String>>(cells: impl IntoIterator<Item = T>) -> Vec<String> {
    cells.into_iter().map(Into::into).collect()
}

/// A row that begins with its name.
#[must_use]
pub fn named(name: impl Into<String>, cells: impl IntoIterator<Item = String>) -> Vec<String> {
    std::iter::once(name.into()).chain(cells).collect()
}
