//! The words for sides and statuses, the same in tables, reports and pictures.

use sinew_core::skeleton::Side;
use sinew_core::tracker::arm::Status;

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
        Status::Predicted => "predicted",
        Status::Lost => "lost",
    }
}
