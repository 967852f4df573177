//! Numbers that the PIK paper leaves open, of the models with its structure
//! (docs/body_motion.md).

use super::by_joint::ByJoint;
use serde::{Deserialize, Serialize};

/// The root's process and its fit to the points, of both models: the paper has no process for a
/// root.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PaperRoot {
    /// Share of the velocity that goes on.
    pub persistence: f32,
    /// Metres by root second about the fitted place.
    pub shift_std_m: f32,
    /// Radians by root second about the fitted place.
    pub turn_std_rad: f32,
    /// How far the fit may shift, metres by root second.
    pub aligned_shift_std_m: f32,
    /// How far the fit may turn, radians by root second.
    pub aligned_turn_std_rad: f32,
    /// How far other angles may give way in the fit, radians by root second.
    pub aligned_angle_std_rad: f32,
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
    /// kappa of PIK (32), per square radian.
    pub kappa: ByJoint,
    /// sigma of PIK (25), metres, of both models.
    pub point_std_m: f32,
    /// Root of tau of PIK (29), metres, of both models.
    pub outlier_m: f32,
    /// Maximum number of steps of the solver of PIK (12).
    pub solver_steps: usize,
    /// Whether these steps are the paper's gradient projection (section 5.2.1), and not
    /// Gauss-Newton steps.
    pub gradient_projection: bool,
    /// Whether PIK (31) and PIK (33) go on from the particle's own last two angles and sampled
    /// goals. If not, they go on from its angles and the places it reached, with the velocity of
    /// the estimate.
    pub own_velocity: bool,
    /// Root of both models.
    pub root: PaperRoot,
}

impl PaperTuning {
    /// Standard deviations of normals that are as concentrated as `kappa`, radians.
    #[must_use]
    pub fn angle_std_rad(&self) -> ByJoint {
        self.kappa.map(|kappa| 1.0 / kappa.sqrt())
    }
}

/// Found by `sinew-lab tune-pik --only both`: the least mean logarithm of PIK (34) of both models
/// with 100 particles, on the rows `body-paper,tuning` of host/lab/data_split.csv. The root by
/// `--only root --tries 60`, which lowers it from 1.27 to 1.20 cm; 100 more tries of all numbers
/// found nothing lower.
pub(super) const PAPER: PaperTuning = PaperTuning {
    lambda: 304.0,
    reach_std_m: 0.0224,
    goal_std_m: 0.0617,
    kappa: ByJoint::uniform(125.0),
    point_std_m: 0.154,
    outlier_m: 0.113,
    // Two Gauss-Newton steps reach the mode of every model with goals (docs/body_tracker.md).
    solver_steps: 2,
    gradient_projection: false,
    own_velocity: false,
    root: PaperRoot {
        persistence: 0.565,
        shift_std_m: 0.0063,
        turn_std_rad: 0.00521,
        aligned_shift_std_m: 0.306,
        aligned_turn_std_rad: 0.836,
        aligned_angle_std_rad: 0.39,
    },
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_concentration_is_the_inverse_of_a_variance() {
        let kappa = ByJoint { elbow: 25.0, ..ByJoint::uniform(100.0) };
        let std = PaperTuning { kappa, ..PAPER }.angle_std_rad();
        assert!((std.trunk - 0.1).abs() < 1.0e-6 && (std.elbow - 0.2).abs() < 1.0e-6);
    }
}
