//! A synthetic motion of two angles, for examples and tests.

use super::model::ModelTable;
use crate::math::sin_cos;
use core::f32::consts::TAU;

/// Stored positions of [`swing_table`].
const POSITIONS: usize = 100;

/// Mean pose at a cycle position: two angles that swing at different phases, rad.
///
/// ```
/// use sinew_core::cyclic::example::swing_pose_rad;
///
/// assert_eq!(swing_pose_rad(0.0), [0.0, 0.3]);
/// ```
#[must_use]
pub fn swing_pose_rad(position: f32) -> [f32; 2] {
    let (sine, cosine) = sin_cos(TAU * position);
    [0.5 * sine, 0.3 * cosine]
}

/// A model of [`swing_pose_rad`] with 60 frames a cycle at 60 Hz.
///
/// ```
/// use sinew_core::cyclic::example::{swing_pose_rad, swing_table};
///
/// let table = swing_table();
/// let model = table.model()?;
/// let error_rad = model.mean_pose_rad::<2>(model.point(0.25))[0] - swing_pose_rad(0.25)[0];
/// assert!(error_rad.abs() < 1e-6);
/// # Ok::<(), sinew_core::cyclic::ModelError>(())
/// ```
#[must_use]
pub fn swing_table() -> ModelTable<POSITIONS, 2, 3> {
    let place = |i: usize| swing_pose_rad(i as f32 / POSITIONS as f32);
    let mut table = ModelTable {
        mean_acceleration: [[0.0; 2]; POSITIONS],
        acceleration_covariance: [[1e-8, 0.0, 1e-8]; POSITIONS],
        mean_pose_rad: core::array::from_fn(place),
        mean_velocity: [[0.0; 2]; POSITIONS],
        offset_std_rad: [0.08; 2],
        cosine_std_rad: [0.05; 2],
        sine_std_rad: [0.05; 2],
        rest_std_rad: [0.03; 2],
        rest_rate_per_cycle: [6.0; 2],
        turns_per_cycle: [0; 2],
        mean_duration_frames: 60.0,
        rate_hz: 60.0,
    };
    for i in 0..POSITIONS {
        let [before, after] = [POSITIONS - 1, 1].map(|step| place((i + step) % POSITIONS));
        for j in 0..2 {
            table.mean_velocity[i][j] = 0.5 * (after[j] - before[j]);
            table.mean_acceleration[i][j] = after[j] - 2.0 * table.mean_pose_rad[i][j] + before[j];
        }
    }
    table
}
