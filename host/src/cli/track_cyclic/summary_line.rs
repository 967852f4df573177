//! A summary on the terminal.

use crate::cyclic::tracking::Summary;
use crate::cyclic::tracking::summary::MIN_CYCLES;

/// Cycles and cadence in a line.
pub(super) fn summary_line(summary: &Summary) -> String {
    let cadence = match (summary.cadence_per_min, summary.cadence_std_per_min) {
        (Some(cadence), Some(std)) => format!("{cadence:.2} a minute (from cycle to cycle +-{std:.2})"),
        (Some(cadence), None) => format!("{cadence:.2} a minute"),
        (None, _) => format!("no cadence, which needs {MIN_CYCLES} cycles"),
    };
    format!(
        "{} frames, {:.2} s, {:.2} s of it seen: {:.2} cycles, {cadence}, {} outliers\n",
        summary.frames, summary.duration_s, summary.seen_s, summary.cycles, summary.outliers
    )
}
