//! A summary on the terminal.

use crate::cyclic::tracking::Summary;

/// Cycles and cadence in a line.
pub(super) fn summary_line(summary: &Summary) -> String {
    format!(
        "{} frames, {:.2} s: {:.2} cycles, {:.2} a minute, {} outliers\n",
        summary.frames, summary.duration_s, summary.cycles, summary.cadence_per_min, summary.outliers
    )
}
