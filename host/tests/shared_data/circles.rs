//! Arm circles forwards of one person in two recordings, the shipped model's own.

use sinew::cyclic::AngleTable;
use sinew::cyclic::recording::{RecordingOptions, angles};
use std::path::Path;

/// First and end frames of the circles, found by `sinew cut` in the frames of that direction, at 60 frames a second.
pub type Circles = &'static [(u64, u64)];

/// Each recording with its circles.
pub const FORWARDS: [(&str, Circles); 2] =
    [("13_29", &[(639, 694), (694, 752), (752, 821)]), ("13_31", &[(1031, 1074), (1074, 1124)])];

/// The angles of a recording in `data`.
pub fn table(data: &Path, trial: &str) -> AngleTable {
    let skeleton = Some(data.join("cmu-walk/35/35.asf"));
    let options = RecordingOptions { skeleton, rate_hz: Some(60.0), ..RecordingOptions::default() };
    angles(&data.join(format!("cmu-exercise/{trial}.amc")), &options).unwrap().table
}
