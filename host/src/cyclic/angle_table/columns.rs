//! Columns of an angle table.

/// Angles of the stick figure.
pub const ANGLES: usize = 13;
/// First columns of every table: the frame, then the angles in the order of the stick figure's
/// joints.
pub const COLUMNS: [&str; ANGLES + 1] = [
    "frame",
    "neck_rad",
    "l_shoulder_rad",
    "l_elbow_rad",
    "l_wrist_rad",
    "r_shoulder_rad",
    "r_elbow_rad",
    "r_wrist_rad",
    "l_hip_rad",
    "l_knee_rad",
    "l_ankle_rad",
    "r_hip_rad",
    "r_knee_rad",
    "r_ankle_rad",
];

/// Columns of a motion in space, right after [`COLUMNS`]: how far each segment points out of the
/// side view's plane, to the person's left, radians.
pub const SIDE_COLUMNS: [&str; ANGLES] = [
    "neck_side_rad",
    "l_shoulder_side_rad",
    "l_elbow_side_rad",
    "l_wrist_side_rad",
    "r_shoulder_side_rad",
    "r_elbow_side_rad",
    "r_wrist_side_rad",
    "l_hip_side_rad",
    "l_knee_side_rad",
    "l_ankle_side_rad",
    "r_hip_side_rad",
    "r_knee_side_rad",
    "r_ankle_side_rad",
];

/// Column of when a frame was seen, seconds; the first one after the angles.
pub const TIME_COLUMN: &str = "time_s";

/// A time, seconds: as many of nine decimals as it needs, so that two rows of a fast camera give
/// their rate.
#[must_use]
pub fn time_cell(time_s: f64) -> String {
    let text = format!("{time_s:.9}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Two angles a joint.
pub const SPACE_ANGLES: usize = 2 * ANGLES;

/// Columns of all angles: in the plane, then out of it.
pub fn angle_columns() -> impl Iterator<Item = &'static str> {
    COLUMNS[1..].iter().chain(&SIDE_COLUMNS).copied()
}

/// Largest number of a frame; more is taken for a mistake.
pub const MAX_FRAME: u64 = 1_000_000_000_000;
