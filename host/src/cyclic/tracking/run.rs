//! One pass of a filter over an angle table.

use crate::cyclic::angle_table::{ANGLES, SPACE_ANGLES};
use crate::cyclic::{AngleRow, AngleTable, CyclicModel};
use crate::error::{Result, bail, ensure};
use sinew_core::cyclic::CyclicEstimate;
use sinew_core::cyclic::events::CycleCounter;
use std::f64::consts::TAU;

/// What the filter answered to one row.
#[derive(Debug, Clone, PartialEq)]
pub struct TrackedFrame {
    /// Number of the frame in the table.
    pub frame: u64,
    /// The estimate; velocities are per frame of the model's rate.
    pub estimate: CyclicEstimate<ANGLES>,
    /// Estimated angles, radians, unwrapped along time.
    pub angles_rad: [f64; ANGLES],
    /// Angles out of the plane, for a model of motion in space.
    pub side: Option<SideEstimate>,
    /// Cycles since the first row, with their fraction.
    pub cycles: f64,
    /// Whether the person was seen about this frame; if not, nothing else here means anything.
    pub is_known: bool,
}

/// Angles out of the plane of the side view.
#[derive(Debug, Clone, PartialEq)]
pub struct SideEstimate {
    /// Radians, unwrapped along time.
    pub angles_rad: [f64; ANGLES],
    /// Their variances, rad^2.
    pub angle_variance_rad2: [f32; ANGLES],
}

/// A whole run.
#[derive(Debug, Clone, PartialEq)]
pub struct Tracked {
    /// One entry a row of the table.
    pub frames: Vec<TrackedFrame>,
    /// Frames per second of the recording.
    pub rate_hz: f64,
    /// Frames of the model's rate in one of the recording's.
    pub step_frames: f64,
}

/// What is said of rows without any angle.
pub(super) const NO_ANGLE: &str =
    "the table has no angle in any row, so there is nothing to track; see `sinew angles --min-confidence`";

/// Whether the row has an angle.
pub(super) fn is_seen(row: &AngleRow) -> bool {
    row.angles_rad.iter().any(Option::is_some)
}

/// Index of the first row with an angle.
pub(super) fn first_seen(table: &AngleTable) -> Result<usize> {
    let Some(first) = table.rows().iter().position(is_seen) else { bail!("{NO_ANGLE}") };
    Ok(first)
}

/// Whether the model has two angles a joint.
pub(super) fn is_spatial(model: &CyclicModel) -> bool {
    model.numbers().angle_count > ANGLES
}

/// Refuses rows with one angle a joint for a model with two.
///
/// # Errors
/// Says so.
pub(super) fn check_angles(model: &CyclicModel, is_table_spatial: bool) -> Result<()> {
    ensure!(
        is_table_spatial || !is_spatial(model),
        "the model has two angles a joint, the table one; make the table with `sinew angles --view space`, or train a model on such tables"
    );
    Ok(())
}

/// Cycles since the start, with their part.
pub(super) fn cycles(counter: &CycleCounter) -> f64 {
    let (laps, part) = counter.laps_and_part();
    f64::from(laps) + f64::from(part)
}

pub(super) fn measured<const N: usize>(table: &AngleTable, index: usize) -> [Option<f32>; N] {
    std::array::from_fn(|angle| table.row_angle_rad(index, angle).map(|angle| angle as f32))
}

/// The answer of a frame, so many cycles after the first.
pub(super) fn tracked<const N: usize>(frame: u64, estimate: &CyclicEstimate<N>, cycles: f64) -> TrackedFrame {
    let unwrapped = |i: usize| f64::from(estimate.angles_rad[i]) + TAU * f64::from(estimate.turns[i]);
    let side = (N == SPACE_ANGLES).then(|| SideEstimate {
        angles_rad: std::array::from_fn(|i| unwrapped(ANGLES + i)),
        angle_variance_rad2: std::array::from_fn(|i| estimate.angle_variance_rad2[ANGLES + i]),
    });
    TrackedFrame {
        frame,
        estimate: in_plane(estimate),
        angles_rad: std::array::from_fn(unwrapped),
        side,
        cycles,
        is_known: true,
    }
}

/// The estimate with the angles in the plane only.
fn in_plane<const N: usize>(estimate: &CyclicEstimate<N>) -> CyclicEstimate<ANGLES> {
    CyclicEstimate {
        angles_rad: std::array::from_fn(|i| estimate.angles_rad[i]),
        turns: std::array::from_fn(|i| estimate.turns[i]),
        angle_variance_rad2: std::array::from_fn(|i| estimate.angle_variance_rad2[i]),
        cycle_position: estimate.cycle_position,
        cycle_position_variance: estimate.cycle_position_variance,
        cycle_velocity_per_frame: estimate.cycle_velocity_per_frame,
        cycle_velocity_variance: estimate.cycle_velocity_variance,
        log_likelihood: estimate.log_likelihood,
        outlier: estimate.outlier,
        misfit: estimate.misfit,
    }
}
