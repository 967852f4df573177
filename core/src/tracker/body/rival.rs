//! Another explanation of a body beside that of the particles, and what it takes to lead.

use super::velocity::EstimateVelocity;
use crate::error::{ParameterError, Rule, positive};
use crate::pik::motion::BodyParticle;

/// When a rival of the particles' explanation leads.
///
/// ```
/// use sinew_core::pik::example::{arm_scene, bending_elbow};
/// use sinew_core::pik::motion::BodyParticle;
/// use sinew_core::tracker::body::{BodyOptions, BodyTracker, DEFAULT_BODY_OPTIONS, RivalOptions};
///
/// let first = BodyParticle::at(&arm_scene()?.skeleton, bending_elbow(0));
/// let new = |evidence_share| {
///     let rival = Some(RivalOptions { evidence_share, switch_cost: 10.0 });
///     let options = BodyOptions { rival, ..DEFAULT_BODY_OPTIONS };
///     BodyTracker::<2, 4, 30, _>::new(&first, ([first; 30], [first; 30]), options, 1)
/// };
/// assert!(new(0.2).is_ok());
/// assert_eq!(new(2.0).map_err(|error| error.parameter).err(), Some("evidence_share"));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RivalOptions {
    /// Share of a frame's log evidence that counts, in (0, 1]: points on one limb, and those of one
    /// frame and the next, are not independent.
    pub evidence_share: f32,
    /// Log evidence that a rival has to gain before it leads.
    pub switch_cost: f32,
}

impl RivalOptions {
    pub(super) fn checked(self) -> Result<Self, ParameterError> {
        if positive("evidence_share", self.evidence_share)? > 1.0 {
            return Err(ParameterError::new("evidence_share", Rule::Within { low: 0.0, high: 1.0 }));
        }
        positive("switch_cost", self.switch_cost)?;
        Ok(self)
    }
}

/// Another explanation, with a past of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rival<const BONES: usize, const ANGLES: usize> {
    pub(super) pose: BodyParticle<BONES, ANGLES>,
    pub(super) velocity: EstimateVelocity<BONES, ANGLES>,
    /// Log evidence since it began, over that of the particles' explanation, less the switch cost.
    pub(super) log_weight: f32,
}
