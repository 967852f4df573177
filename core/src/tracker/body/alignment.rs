//! Where the root goes, by the points: the mean pose is laid onto them before any particle is drawn.
//!
//! The PIK paper's subjects stand still. A root that moves has six coordinates that move everything, and particles that guess them
//! one by one are lost on it; so every motion model may begin with the same look at the points.

use crate::kinematics::inverse::{PoseDensity, Solve};
use crate::math::Vec3;
use crate::observation::point_cloud::PointBlock;
use crate::pik::guided::GuidedDensity;
use crate::pik::motion::BodyScene;
use crate::skeleton::tree::{FREE_ROOT_COORDINATES, SHIFTS};

/// How the mean pose is laid onto a frame's points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RootAlignment {
    /// Most steps of the solver.
    pub steps: usize,
    /// How far the root is believed to get off its expected place, metres by root second.
    pub shift_std_m_per_sqrt_s: f32,
    /// How far it is believed to turn, radians by root second.
    pub turn_std_rad_per_sqrt_s: f32,
    /// How far the other angles are believed to change, radians by root second: they give way, so that a moving arm does not
    /// carry the root along, and are then forgotten.
    pub angle_std_rad_per_sqrt_s: f32,
    /// Most blocks of points that pull.
    pub pulling_blocks: usize,
}

impl RootAlignment {
    /// What the root's coordinates change by, from the pose `before_rad`, if `expected` is what its process expects.
    #[must_use]
    pub fn root_change<const BONES: usize, const ANGLES: usize>(
        &self,
        scene: &BodyScene<BONES, ANGLES>,
        blocks: &[PointBlock],
        before_rad: &[f32; ANGLES],
        expected: &[f32; FREE_ROOT_COORDINATES],
        dt_s: f32,
    ) -> [f32; FREE_ROOT_COORDINATES] {
        let inverse_variance = |std: f32| 1.0 / (std * std * dt_s);
        let mut stiffness = [inverse_variance(self.angle_std_rad_per_sqrt_s); ANGLES];
        let mut previous_rad = *before_rad;
        for i in 0..scene.skeleton.root_coordinates() {
            let is_shift = i < SHIFTS;
            let std = if is_shift { self.shift_std_m_per_sqrt_s } else { self.turn_std_rad_per_sqrt_s };
            stiffness[i] = inverse_variance(std);
            previous_rad[i] += expected.get(i).copied().unwrap_or(0.0);
        }
        let prior = PoseDensity {
            skeleton: &scene.skeleton,
            root_m: Vec3::zeros(),
            goals: &[],
            previous_rad,
            stiffness,
            held: 0,
        };
        let stride = blocks.len().div_ceil(self.pulling_blocks.max(1)).max(1);
        let mode = GuidedDensity { prior, scene, blocks, stride }.mode(self.steps);
        let mut change = [0.0; FREE_ROOT_COORDINATES];
        for i in 0..scene.skeleton.root_coordinates() {
            change[i] = mode.angles_rad[i] - before_rad[i];
        }
        change
    }
}
