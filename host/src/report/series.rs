//! What the plots of all runs are made from.

use super::document::Series;
use super::table::Table;

/// Degrees in a radian.
pub const DEGREES: f64 = 180.0 / std::f64::consts::PI;

/// A line from two columns of a table.
#[must_use]
pub fn select(table: &Table, x: &str, y: &str) -> Series {
    Series {
        name: y.to_owned(),
        table: table.name.clone(),
        x: x.to_owned(),
        y: y.to_owned(),
        x_times: 1.0,
        y_times: 1.0,
        ..Series::default()
    }
}

/// The condition that `column` holds `value`.
#[must_use]
pub fn only(column: &str, value: &str) -> Vec<[String; 2]> {
    vec![[column.to_owned(), value.to_owned()]]
}
