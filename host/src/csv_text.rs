//! Tables as text.

use std::borrow::Cow;

/// A reader of `text` that takes the header for a row, rows of any length, and trims cells.
pub(crate) fn csv_reader(text: &str) -> csv::Reader<&[u8]> {
    csv::ReaderBuilder::new().has_headers(false).flexible(true).trim(csv::Trim::All).from_reader(text.as_bytes())
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
