//! The numbers of a motion model as arrays of fixed size, to be placed in flash.

use crate::cyclic::model::coupled_model::ModelError;
use crate::cyclic::model::deviation::Deviation;
use crate::cyclic::model::motion_model::{ModelParts, MotionModel};
use crate::numeric::semi_definite::packed_len;
use crate::skeleton::stick_figure::HUMAN_ANGLES;

/// Positions l of the reference cycle: cyclic paper, section 3.1.
pub const PAPER_POSITIONS: usize = 100;

/// A motion model of `ANGLES` angles and `POSITIONS` positions, `PACKED` = `ANGLES` (`ANGLES` + 1)
/// / 2, as plain arrays.
///
/// ```
/// use sinew_core::cyclic::ModelTable;
///
/// // One angle at four positions, in flash: a packed covariance of one angle is one number.
/// static SWING: ModelTable<4, 1, 1> = ModelTable {
///     mean_acceleration: [[0.0], [-1.0], [0.0], [1.0]],
///     acceleration_covariance: [[0.01]; 4],
///     mean_pose_rad: [[0.0], [0.5], [0.0], [-0.5]],
///     mean_velocity: [[0.5], [0.0], [-0.5], [0.0]],
///     offset_std_rad: [0.08],
///     cosine_std_rad: [0.05],
///     sine_std_rad: [0.05],
///     rest_std_rad: [0.03],
///     rest_rate_per_cycle: [6.0],
///     turns_per_cycle: [0],
///     mean_duration_frames: 20.0,
///     rate_hz: 20.0,
/// };
/// let model = SWING.model()?;
/// assert_eq!(model.mean_pose_rad(model.point(0.125)), [0.25], "half-way up");
/// # Ok::<(), sinew_core::cyclic::ModelError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ModelTable<const POSITIONS: usize, const ANGLES: usize, const PACKED: usize> {
    /// See [`ModelParts::mean_acceleration`].
    pub mean_acceleration: [[f32; ANGLES]; POSITIONS],
    /// See [`ModelParts::acceleration_covariance`].
    pub acceleration_covariance: [[f32; PACKED]; POSITIONS],
    /// See [`ModelParts::mean_pose_rad`].
    pub mean_pose_rad: [[f32; ANGLES]; POSITIONS],
    /// See [`ModelParts::mean_velocity`].
    pub mean_velocity: [[f32; ANGLES]; POSITIONS],
    /// See [`Deviation::offset_std_rad`].
    pub offset_std_rad: [f32; ANGLES],
    /// See [`Deviation::cosine_std_rad`].
    pub cosine_std_rad: [f32; ANGLES],
    /// See [`Deviation::sine_std_rad`].
    pub sine_std_rad: [f32; ANGLES],
    /// See [`Deviation::rest_std_rad`].
    pub rest_std_rad: [f32; ANGLES],
    /// See [`Deviation::rest_rate_per_cycle`].
    pub rest_rate_per_cycle: [f32; ANGLES],
    /// See [`ModelParts::turns_per_cycle`].
    pub turns_per_cycle: [i8; ANGLES],
    /// See [`ModelParts::mean_duration_frames`].
    pub mean_duration_frames: f32,
    /// See [`ModelParts::rate_hz`].
    pub rate_hz: f32,
}

/// The table of the paper's figure and reference cycle.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::HumanModelTable;
/// use sinew_core::cyclic::model::walking::WALKING;
///
/// // A model of one's own has the same type as the shipped one: a parameter, not a generic.
/// fn cadence_per_min(table: &HumanModelTable) -> f32 {
///     60.0 * table.rate_hz / table.mean_duration_frames
/// }
/// assert!((40.0..80.0).contains(&cadence_per_min(&WALKING)), "cycles of two steps");
/// # }
/// ```
pub type HumanModelTable = ModelTable<PAPER_POSITIONS, HUMAN_ANGLES, { packed_len(HUMAN_ANGLES) }>;

const _: () = assert!(size_of::<HumanModelTable>() <= 64 * 1024, "the model has to fit 64 KiB of flash");

impl<const POSITIONS: usize, const ANGLES: usize, const PACKED: usize> ModelTable<POSITIONS, ANGLES, PACKED> {
    /// Checks the numbers and lends them as a model.
    ///
    /// # Errors
    /// Those of [`MotionModel::new`].
    pub fn model(&self) -> Result<MotionModel<'_>, ModelError> {
        MotionModel::new(ModelParts {
            angle_count: ANGLES,
            mean_acceleration: self.mean_acceleration.as_flattened(),
            acceleration_covariance: self.acceleration_covariance.as_flattened(),
            mean_pose_rad: self.mean_pose_rad.as_flattened(),
            mean_velocity: self.mean_velocity.as_flattened(),
            turns_per_cycle: &self.turns_per_cycle,
            mean_duration_frames: self.mean_duration_frames,
            rate_hz: self.rate_hz,
            deviation: Deviation {
                offset_std_rad: &self.offset_std_rad,
                cosine_std_rad: &self.cosine_std_rad,
                sine_std_rad: &self.sine_std_rad,
                rest_std_rad: &self.rest_std_rad,
                rest_rate_per_cycle: &self.rest_rate_per_cycle,
            },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_static_table_lends_a_model() {
        static TABLE: ModelTable<5, 1, 1> = ModelTable {
            mean_acceleration: [[0.0]; 5],
            acceleration_covariance: [[1.0]; 5],
            mean_pose_rad: [[0.5]; 5],
            mean_velocity: [[0.0]; 5],
            offset_std_rad: [0.1],
            cosine_std_rad: [0.1],
            sine_std_rad: [0.1],
            rest_std_rad: [0.1],
            rest_rate_per_cycle: [12.0],
            turns_per_cycle: [0],
            mean_duration_frames: 60.0,
            rate_hz: 60.0,
        };
        let model = TABLE.model().unwrap();
        assert_eq!((model.angle_count(), model.position_count()), (1, 5));
        let wrong = ModelTable::<5, 1, 1> { acceleration_covariance: [[-1.0]; 5], ..TABLE.clone() };
        assert_eq!(wrong.model().unwrap_err().position, Some(0));
    }
}
