//! The tables of a page, between `<!-- table NAME -->` and `<!-- end of NAME -->`.

use anyhow::{Context, Result};
use std::ops::Range;

/// Names of all tables of a page, in their order.
#[must_use]
pub fn names(page: &str) -> Vec<&str> {
    page.lines().filter_map(|line| line.strip_prefix("<!-- table ")?.strip_suffix(" -->")).collect()
}

/// Where the text between a table's marks lies.
fn place(page: &str, name: &str) -> Result<Range<usize>> {
    let (open, close) = (format!("<!-- table {name} -->\n"), format!("<!-- end of {name} -->"));
    let missing = |mark: &str| format!("the page has no line `{}`", mark.trim_end());
    let start = page.find(&open).with_context(|| missing(&open))? + open.len();
    let length = page[start..].find(&close).with_context(|| missing(&close))?;
    Ok(start..start + length)
}

/// Whether the table `name` of `page` is `table`.
///
/// # Errors
/// The page lacks a mark.
pub fn is_current(page: &str, name: &str, table: &str) -> Result<bool> {
    Ok(page[place(page, name)?] == between_marks(table))
}

/// The page with `table` as the table `name`.
///
/// # Errors
/// The page lacks a mark.
pub fn renewed(page: &str, name: &str, table: &str) -> Result<String> {
    let mut renewed = page.to_owned();
    renewed.replace_range(place(page, name)?, &between_marks(table));
    Ok(renewed)
}

/// An empty line keeps a table apart from its marks.
fn between_marks(table: &str) -> String {
    format!("\n{table}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: &str = "# A\n\n<!-- table a -->\n\n| x |\n\n<!-- end of a -->\n\nb\n";

    #[test]
    fn a_table_is_replaced_and_the_rest_stays() {
        assert_eq!(names(PAGE), ["a"]);
        assert!(is_current(PAGE, "a", "| x |\n").unwrap());
        let page = renewed(PAGE, "a", "| y |\n").unwrap();
        assert_eq!(page, PAGE.replace('x', "y"));
        assert!(!is_current(&page, "a", "| x |\n").unwrap());
    }

    #[test]
    fn a_page_without_a_mark_is_refused() {
        let error = |page: &str, name: &str| renewed(page, name, "").unwrap_err().to_string();
        assert_eq!(error(PAGE, "b"), "the page has no line `<!-- table b -->`");
        assert!(error(&PAGE.replace("end of a", "end of b"), "a").contains("end of a"));
    }
}
