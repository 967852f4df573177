//! Numbers that the PIK paper leaves open, of the models with its structure
//! (docs/body_motion.md).

use super::joint_std::JointStd;
use serde::{Deserialize, Serialize};

/// kappa of PIK (32) by the joint that an angle belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointKappa {
    /// Trunk against the pelvis.
    pub trunk: f32,
    /// Head against the trunk.
    pub head: f32,
    /// Shoulders.
    pub shoulder: f32,
    /// Elbows.
    pub elbow: f32,
    /// Hips.
    pub hip: f32,
    /// Knees.
    pub knee: f32,
    /// Ankles.
    pub ankle: f32,
}

impl JointKappa {
    /// The same for every angle.
    #[must_use]
    pub const fn uniform(kappa: f32) -> Self {
        Self { trunk: kappa, head: kappa, shoulder: kappa, elbow: kappa, hip: kappa, knee: kappa, ankle: kappa }
    }

    /// Standard deviations of a normal that is as concentrated, radians.
    #[must_use]
    pub fn std_rad(&self) -> JointStd {
        let Self { trunk, head, shoulder, elbow, hip, knee, ankle } = *self;
        let [trunk, head, shoulder, elbow, hip, knee, ankle] =
            [trunk, head, shoulder, elbow, hip, knee, ankle].map(|kappa| 1.0 / kappa.sqrt());
        JointStd { trunk, head, shoulder, elbow, hip, knee, ankle }
    }
}

/// Numbers of `end-effector-paper` and `angular-paper`; each holds for a frame, as in the paper.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PaperTuning {
    /// lambda of PIK (12), one for all angles, per square radian.
    pub lambda: f32,
    /// W of PIK (3) is 1 / `reach_std_m`^2 times the identity, metres.
    pub reach_std_m: f32,
    /// sigma of PIK (33), metres.
    pub goal_std_m: f32,
    /// kappa of PIK (32).
    pub kappa: JointKappa,
    /// sigma of PIK (25), metres, of both models.
    pub point_std_m: f32,
    /// Root of tau of PIK (29), metres, of both models.
    pub outlier_m: f32,
    /// Maximum number of steps of the solver of PIK (12).
    pub solver_steps: usize,
    /// Whether PIK (31) and PIK (33) go on from the particle's own last two angles and sampled
    /// goals. If not, they go on from its angles and the places it reached, with the velocity of
    /// the estimate.
    pub own_velocity: bool,
}

/// Found by `sinew-lab tune-pik --only both`: the least mean logarithm of PIK (34) of both models
/// with 100 particles, on the rows `body-paper,tuning` of host/lab/data_split.csv.
pub(super) const PAPER: PaperTuning = PaperTuning {
    lambda: 304.0,
    reach_std_m: 0.0224,
    goal_std_m: 0.0617,
    kappa: JointKappa::uniform(125.0),
    point_std_m: 0.154,
    outlier_m: 0.113,
    // Two Gauss-Newton steps reach the mode of every model with goals (docs/body_tracker.md).
    solver_steps: 2,
    own_velocity: false,
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_concentration_is_the_inverse_of_a_variance() {
        let std = JointKappa { elbow: 25.0, ..JointKappa::uniform(100.0) }.std_rad();
        assert!((std.trunk - 0.1).abs() < 1.0e-6 && (std.elbow - 0.2).abs() < 1.0e-6);
    }
}
