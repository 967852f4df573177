//! The estimates as a CSV table: the columns of an angle table first, so that every tool for those
//! reads it.

use super::run::Tracked;
use crate::cyclic::angle_table::{ANGLES, COLUMNS, SPACE_ANGLES, angle_columns};
use crate::error::{Error, Result};
use crate::output::write_atomically;
use std::path::Path;

/// Columns after the angles.
pub const ESTIMATE_COLUMNS: [&str; 7] = [
    "cycle_position",
    "cycle_velocity_per_frame",
    "cadence_per_min",
    "log_likelihood",
    "outlier",
    "cadence_std_per_min",
    "cycles",
];

/// Columns at the end where several motions were tracked.
pub const MOTION_COLUMNS: [&str; 2] = ["motion", "motion_probability"];
/// What stands in the column `motion` where it is none of them.
pub const NO_MOTION: &str = "none";

/// Name and probability of the motion of each row.
pub type MotionCells = Vec<(String, f64)>;

/// The text of the table; after [`ESTIMATE_COLUMNS`] come the angles' standard deviations. A model
/// with two angles a joint gives the angles out of the plane after those in it. `motions`, if there
/// are any, come last.
///
/// `cycle_velocity_per_frame` is per frame of the recording; `outlier` is 0 or 1.
///
/// # Errors
/// None in practice: text can always be written to memory.
pub fn to_csv(tracked: &Tracked, motions: Option<&MotionCells>) -> Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let is_spatial = tracked.frames.iter().any(|frame| frame.side.is_some());
    let count = if is_spatial { SPACE_ANGLES } else { ANGLES };
    let columns = COLUMNS[..1].iter().copied().chain(angle_columns().take(count)).chain(ESTIMATE_COLUMNS);
    let std_columns = angle_columns().take(count).map(|name| name.replace("_rad", "_std_rad"));
    let motion_columns = motions.iter().flat_map(|_| MOTION_COLUMNS.map(str::to_owned));
    writer.write_record(columns.map(str::to_owned).chain(std_columns).chain(motion_columns))?;
    for (index, frame) in tracked.frames.iter().enumerate() {
        let estimate = &frame.estimate;
        let velocity = f64::from(estimate.cycle_velocity_per_frame) * tracked.step_frames;
        let per_min = 60.0 * tracked.rate_hz;
        let velocity_std = f64::from(estimate.cycle_velocity_variance.max(0.0).sqrt()) * tracked.step_frames;
        let derived = [
            position_cell(f64::from(estimate.cycle_position)),
            format!("{velocity:.8}"),
            format!("{:.4}", velocity * per_min),
            format!("{:.4}", estimate.log_likelihood),
            u8::from(estimate.outlier).to_string(),
            format!("{:.4}", velocity_std * per_min),
            format!("{:.5}", frame.cycles),
        ];
        let side = frame.side.as_ref();
        let side_angles = side.iter().flat_map(|side| side.angles_rad);
        let angles = frame.angles_rad.into_iter().chain(side_angles).map(|angle| format!("{angle:.6}"));
        let side_variances = side.iter().flat_map(|side| &side.angle_variance_rad2);
        let stds = estimate
            .angle_variance_rad2
            .iter()
            .chain(side_variances)
            .map(|variance| format!("{:.6}", variance.max(0.0).sqrt()));
        let motion = motions.and_then(|motions| motions.get(index));
        let motion = motion.into_iter().flat_map(|(name, probability)| [name.clone(), format!("{probability:.6}")]);
        let cells = std::iter::once(frame.frame.to_string()).chain(angles).chain(derived).chain(stds).chain(motion);
        writer.write_record(cells)?;
    }
    String::from_utf8(writer.into_inner()?).map_err(Error::invalid)
}

/// Six decimals in [0, 1): what would round up to one is the start of the next cycle.
fn position_cell(position: f64) -> String {
    format!("{:.6}", if position < 0.999_999_5 { position } else { 0.0 })
}

/// Writes the table under a temporary name, then renames it.
///
/// # Errors
/// Names the path with what the operating system refused.
pub fn write(tracked: &Tracked, motions: Option<&MotionCells>, path: &Path) -> Result<()> {
    let text = to_csv(tracked, motions)?;
    write_atomically(path, |writer| Ok(writer.write_all(text.as_bytes())?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_position_stays_below_one_in_text() {
        assert_eq!(
            [0.0, 0.25, 0.999_999_4, 0.999_999_9].map(position_cell),
            ["0.000000", "0.250000", "0.999999", "0.000000"]
        );
    }
}
