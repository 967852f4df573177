//! Words that stand in several places: sides and statuses in tables, reports and pictures, and a
//! remedy.

use sinew_core::skeleton::Side;
use sinew_core::tracker::arm::Status;

/// What to do where a run cannot be gone on with.
pub const REMEDY: &str = "leave --resume out to begin anew";

/// Word for `side`.
#[must_use]
pub fn side_name(side: Side) -> &'static str {
    match side {
        Side::Left => "left",
        Side::Right => "right",
    }
}

/// Word for `status`.
#[must_use]
pub fn status_name(status: Status) -> &'static str {
    match status {
        Status::Tracking => "tracking",
        Status::Uncertain => "uncertain",
        Status::Predicted => "predicted",
        Status::Lost => "lost",
    }
}
