//! Options of the tracker by modes.

use super::super::pace::SpeedScaledNoise;
use crate::error::{ParameterError, Rule, positive};

/// Explanations that are followed beside each other at most, the leading one included.
/// Chosen: the leading one, and one for each way in which limbs or the pelvis are mistaken.
pub const MAX_MODES: usize = 8;
/// Draws of a limb in a frame at most. Chosen: three gain as much as one.
pub(super) const MAX_DRAWS: usize = 3;

/// Options of the tracker by modes.
///
/// ```
/// use sinew_core::pik::example::{arm_scene, bending_elbow};
/// use sinew_core::pik::motion::BodyParticle;
/// use sinew_core::tracker::body::modes::{DEFAULT_MODE_OPTIONS, ModeOptions, ModeTracker};
///
/// let scene = arm_scene()?;
/// let first = BodyParticle::at(&scene.skeleton, bending_elbow(0));
/// let new = |options| ModeTracker::<2, 4>::new(&first, options, 1);
/// // The leading mode alone, without rivals.
/// assert!(new(ModeOptions { max_modes: 1, ..DEFAULT_MODE_OPTIONS }).is_ok());
/// // A wrong option is refused by its name.
/// let wrong = new(ModeOptions { max_modes: 9, ..DEFAULT_MODE_OPTIONS });
/// assert_eq!(wrong.map_err(|error| error.parameter).err(), Some("max_modes"));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeOptions {
    /// Modes that are followed at most, from 1 to [`MAX_MODES`]; with one there are no rivals.
    pub max_modes: usize,
    /// Share of a frame's log evidence that counts, in (0, 1]: points on one limb, and those of one
    /// frame and the next, are not independent.
    pub evidence_share: f32,
    /// Log evidence that a rival has to gain before it leads.
    pub switch_cost: f32,
    /// How far the pelvis of some rivals is turned to either side, radians; zero turns none.
    pub turn_rad: f32,
    /// How often in a frame each limb of the leading mode is begun anew from a drawn pose, 0 to 3.
    pub draws: usize,
    /// Deadband of the reported pose at rest, metres; zero reports each frame's mode.
    pub jitter_std_m: f32,
    /// How the noise of a limb follows its pace; `None` leaves every limb the motion model's own.
    pub pace: Option<SpeedScaledNoise>,
}

/// The default options, tuned on the runners that docs/body_modes.md names.
pub const DEFAULT_MODE_OPTIONS: ModeOptions = ModeOptions {
    max_modes: MAX_MODES,
    evidence_share: 0.2,
    switch_cost: 10.0,
    turn_rad: 0.7,
    draws: 1,
    jitter_std_m: 0.0,
    pace: None,
};

impl ModeOptions {
    /// Checks every value.
    ///
    /// # Errors
    /// Names the first value that is out of its range.
    pub(super) fn check(&self) -> Result<(), ParameterError> {
        if !(1..=MAX_MODES).contains(&self.max_modes) {
            return Err(ParameterError::new("max_modes", Rule::Within { low: 1.0, high: MAX_MODES as f32 }));
        }
        if positive("evidence_share", self.evidence_share)? > 1.0 {
            return Err(ParameterError::new("evidence_share", Rule::Within { low: 0.0, high: 1.0 }));
        }
        positive("switch_cost", self.switch_cost)?;
        if self.draws > MAX_DRAWS {
            return Err(ParameterError::new("draws", Rule::Within { low: 0.0, high: MAX_DRAWS as f32 }));
        }
        for (name, value) in [("turn_rad", self.turn_rad), ("jitter_std_m", self.jitter_std_m)] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(ParameterError::new(name, Rule::NotNegative));
            }
        }
        self.pace.map(SpeedScaledNoise::checked).transpose()?;
        Ok(())
    }
}
