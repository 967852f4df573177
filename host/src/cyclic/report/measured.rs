//! What the filter was given, beside the estimate.

use crate::cyclic::AngleTable;
use crate::cyclic::angle_table::{ANGLES, COLUMNS};
use crate::cyclic::tracking::{Tracked, Updates};
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// The angle that was measured in row `index` and seen by the filter, in the turn that is nearest
/// to the estimate, radians.
#[must_use]
pub fn measured_rad(
    table: &AngleTable,
    tracked: &Tracked,
    updates: &Updates,
    index: usize,
    angle: usize,
) -> Option<f64> {
    let (row, estimate) = (table.rows().get(index)?, tracked.frames.get(index)?.angles_rad[angle]);
    let off = row.angles_rad[angle].filter(|_| updates.sees(table.first_frame(), row.frame))? - estimate;
    Some(estimate + off - TAU * (off / TAU).round())
}

/// `frame` and the angles of each row; what was not measured is empty.
#[must_use]
pub fn to_csv(table: &AngleTable, tracked: &Tracked, updates: &Updates) -> String {
    let mut text = COLUMNS.join(",") + "\n";
    for (index, row) in table.rows().iter().enumerate() {
        // Writing to a string cannot fail.
        let _ = write!(text, "{}", row.frame);
        for angle in 0..ANGLES {
            let _ = match measured_rad(table, tracked, updates, index, angle) {
                Some(value) => write!(text, ",{value:.6}"),
                None => write!(text, ","),
            };
        }
        text.push('\n');
    }
    text
}
