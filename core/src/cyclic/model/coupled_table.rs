//! The numbers that the phase-coupled filter reads of a motion model, as arrays of fixed size.

use crate::cyclic::model::coupled_model::{CoupledModel, CoupledParts, ModelError};
use crate::cyclic::model::deviation::Deviation;
use crate::cyclic::model::table::PAPER_POSITIONS;
use crate::skeleton::stick_figure::HUMAN_ANGLES;

/// A motion model of `ANGLES` angles and `POSITIONS` positions for the phase-coupled filter, as
/// plain arrays to be placed in flash.
///
/// ```
/// use sinew_core::cyclic::CoupledTable;
///
/// // One angle at four positions.
/// static SWING: CoupledTable<4, 1> = CoupledTable {
///     mean_pose_rad: [[0.0], [0.5], [0.0], [-0.5]],
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
pub struct CoupledTable<const POSITIONS: usize, const ANGLES: usize> {
    /// See [`CoupledParts::mean_pose_rad`].
    pub mean_pose_rad: [[f32; ANGLES]; POSITIONS],
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
    /// See [`CoupledParts::turns_per_cycle`].
    pub turns_per_cycle: [i8; ANGLES],
    /// See [`CoupledParts::mean_duration_frames`].
    pub mean_duration_frames: f32,
    /// See [`CoupledParts::rate_hz`].
    pub rate_hz: f32,
}

/// The table of the paper's figure and reference cycle.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::model::coupled_table::HumanCoupledTable;
/// use sinew_core::cyclic::model::walking::WALKING_COUPLED;
///
/// static MODEL: &HumanCoupledTable = &WALKING_COUPLED;
/// assert_eq!(MODEL.model()?.angle_count(), 13);
/// # }
/// # Ok::<(), sinew_core::cyclic::ModelError>(())
/// ```
pub type HumanCoupledTable = CoupledTable<PAPER_POSITIONS, HUMAN_ANGLES>;

const _: () = assert!(size_of::<HumanCoupledTable>() <= 5632, "the coupled filter's model has to fit 5.5 KiB of flash");

impl<const POSITIONS: usize, const ANGLES: usize> CoupledTable<POSITIONS, ANGLES> {
    /// Checks the numbers and lends them as a model.
    ///
    /// # Errors
    /// Those of [`CoupledModel::new`].
    pub fn model(&self) -> Result<CoupledModel<'_>, ModelError> {
        CoupledModel::new(CoupledParts {
            angle_count: ANGLES,
            mean_pose_rad: self.mean_pose_rad.as_flattened(),
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
