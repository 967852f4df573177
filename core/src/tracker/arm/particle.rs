//! One weighted arm.

use crate::math::{Vec3, unit};
use crate::skeleton::arm::ArmAngles;

/// One weighted arm.
///
/// ```
/// use sinew_core::tracker::arm::example::{SHOULDERS_M, hand_blob, left_arm};
/// use sinew_core::tracker::arm::{ArmFrame, ArmImage, ArmTracker};
///
/// let (model, hand, shoulder_m) = (left_arm()?, hand_blob(), SHOULDERS_M[0]);
/// let mut tracker = ArmTracker::<50>::new(&model, shoulder_m, 1)?;
/// let image = Some(ArmImage { candidates: &[hand], edges: &[] });
/// let _ = tracker.step(&model, &ArmFrame { timestamp_us: 0, image, shoulder_m });
/// // The only blob drove most particles; the free share went on as if there were none.
/// let driven = tracker.particles().iter().filter(|particle| particle.driver == Some(0)).count();
/// assert!((25..50).contains(&driven), "{driven} of 50");
/// // Every particle is a whole pose, with the lengths of the arm.
/// let particle = &tracker.particles()[0];
/// assert!(((particle.hand_m - particle.elbow_m).norm() - 0.35).abs() < 1e-4);
/// assert!((particle.forearm().norm() - 1.0).abs() < 1e-5);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Particle {
    /// Pose, inside the limits.
    pub angles_rad: ArmAngles,
    /// Elbow of that pose, metres.
    pub elbow_m: Vec3,
    /// Hand of that pose, metres: what was reached, not the goal.
    pub hand_m: Vec3,
    /// The considered candidate that drove the particle in this frame.
    pub driver: Option<u8>,
}

impl Particle {
    /// Where the forearm points, a unit vector.
    #[must_use]
    pub fn forearm(&self) -> Vec3 {
        unit(self.hand_m - self.elbow_m).unwrap_or(Vec3::zeros())
    }
}
