//! Options of the filter itself.

use super::alignment::RootAlignment;
use super::pace::SpeedScaledNoise;
use super::rival::RivalOptions;
use crate::error::{ParameterError, Rule};

/// Options of the filter itself.
///
/// ```
/// use sinew_core::pik::example::{arm_points, arm_scene, bending_elbow, guided_arm, hand_goals};
/// use sinew_core::pik::motion::BodyParticle;
/// use sinew_core::tracker::body::{BodyFrame, BodyOptions, BodyTracker, DEFAULT_BODY_OPTIONS};
///
/// let (scene, goals) = (arm_scene()?, hand_goals()?);
/// let motion = guided_arm(&goals);
/// let first = BodyParticle::at(&scene.skeleton, bending_elbow(0));
/// // Each limb is weighed and resampled by itself, so that all particles weigh the same after a step.
/// let options = BodyOptions { limb_by_limb: true, ..DEFAULT_BODY_OPTIONS };
/// let new = |options| BodyTracker::<2, 4, 30, _>::new(&first, ([first; 30], [first; 30]), options, 1);
/// let mut tracker = new(options)?;
/// let cloud = arm_points(&scene, &bending_elbow(1));
/// let _ = tracker.step(&scene, &motion, &BodyFrame { dt_s: 1.0 / 15.0, blocks: cloud.blocks() });
/// assert!(tracker.weights().iter().all(|weight| *weight == tracker.weights()[0]));
/// // A wrong option is refused by its name.
/// let wrong = new(BodyOptions { least_effective_share: 1.5, ..options });
/// assert_eq!(wrong.map_err(|error| error.parameter).err(), Some("least_effective_share"));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyOptions {
    /// Weights are flattened until at least this share of a hundred particles is effective. For
    /// another number of particles the effective number grows with its root. Many particles
    /// separate a sharper likelihood from chance. Zero never flattens.
    pub least_effective_share: f32,
    /// Whether each limb is weighed by what it explains itself and resampled apart from the others.
    pub limb_by_limb: bool,
    /// How the expected pose is fitted to the points before particles are drawn. Their root, and
    /// trunk if asked for, set out from there. `None` leaves them to their process.
    pub alignment: Option<RootAlignment>,
    /// Deadband of the reported pose at rest, in standard errors of the particles' mean.
    pub jitter_std_errors: f32,
    /// Part of the deadband that no number of particles reduces, metres. With both zero each
    /// frame's mean is reported.
    pub jitter_std_m: f32,
    /// When a body with exchanged legs takes the place of the estimate; `None` never. Motion models
    /// that do not climb ([`BodyMotion::climb`](crate::pik::motion::BodyMotion::climb)) have none.
    pub rival: Option<RivalOptions>,
    /// How the noise of a limb follows its pace; `None` leaves every limb the motion model's own.
    pub pace: Option<SpeedScaledNoise>,
    /// Share of the velocity's last change that goes on, in [0, 1]: motion models are given a
    /// velocity that changes on as it did. Zero is the velocity of the last two frames.
    pub acceleration_share: f32,
}

/// The default options.
pub const DEFAULT_BODY_OPTIONS: BodyOptions = BodyOptions {
    least_effective_share: 0.0,
    limb_by_limb: false,
    alignment: None,
    jitter_std_errors: 0.0,
    jitter_std_m: 0.0,
    rival: None,
    pace: None,
    acceleration_share: 0.0,
};

impl BodyOptions {
    /// Checks every value.
    ///
    /// # Errors
    /// Names the first value that is out of its range.
    pub(super) fn check(&self) -> Result<(), ParameterError> {
        let shares =
            [("least_effective_share", self.least_effective_share), ("acceleration_share", self.acceleration_share)];
        for (name, share) in shares {
            if !(0.0..=1.0).contains(&share) {
                return Err(ParameterError::new(name, Rule::Within { low: 0.0, high: 1.0 }));
            }
        }
        for (name, value) in [("jitter_std_errors", self.jitter_std_errors), ("jitter_std_m", self.jitter_std_m)] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(ParameterError::new(name, Rule::NotNegative));
            }
        }
        self.alignment.map(RootAlignment::checked).transpose()?;
        self.rival.map(RivalOptions::checked).transpose()?;
        self.pace.map(SpeedScaledNoise::checked).transpose()?;
        Ok(())
    }
}
