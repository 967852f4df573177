//! Where the body is, by the points: the expected pose is fitted to them before any particle is
//! drawn.
//!
//! The PIK paper's subjects stand still. A root that moves has six coordinates that move
//! everything. Particles that guess them one by one are lost on it. So every motion model may begin
//! with the same look at the points.

use crate::error::{ParameterError, positive};
use crate::kinematics::inverse::{PoseDensity, Solve};
use crate::math::Vec3;
use crate::observation::point_cloud::PointBlock;
use crate::pik::guided::{GuidedDensity, HELD_STIFFNESS};
use crate::pik::motion::BodyScene;
use crate::skeleton::tree::SHIFTS;

/// How the expected pose is fitted to a frame's points.
///
/// ```
/// use sinew_core::pik::example::{rod_points, rod_scene};
/// use sinew_core::tracker::body::RootAlignment;
///
/// let scene = rod_scene()?;
/// let alignment = RootAlignment {
///     steps: 10,
///     coarse_to_fine: false,
///     shift_std_m_per_sqrt_s: 1.0,
///     turn_std_rad_per_sqrt_s: 1.0,
///     angle_std_rad_per_sqrt_s: 1.0,
///     pulling_blocks: 32,
///     fit_trunk: true,
/// };
/// // A body of one bone, three metres away, whose points show it ten centimetres farther to the right.
/// let before = [0.0, 0.0, 3.0, 0.0, 0.0, 0.0];
/// let cloud = rod_points(&scene, &[0.1, 0.0, 3.0, 0.0, 0.0, 0.0]);
/// let fitted = alignment.fit_root(&scene, cloud.blocks(), (&before, &[false; 6]), 1.0 / 15.0);
/// assert!((fitted[0] - 0.1).abs() < 0.02 && (fitted[2] - 3.0).abs() < 0.02, "{fitted:?}");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RootAlignment {
    /// Most steps of the solver.
    pub steps: usize,
    /// Whether coarse steps come first, for limbs that are farther off than points reach
    /// ([`GuidedDensity::mode_coarse_to_fine`]).
    pub coarse_to_fine: bool,
    /// How far the root is believed to get off its expected place, metres by root second.
    pub shift_std_m_per_sqrt_s: f32,
    /// How far it is believed to turn, radians by root second.
    pub turn_std_rad_per_sqrt_s: f32,
    /// How far the other angles are believed to change, radians by root second. They give way, so
    /// that a moving arm does not carry the root along. How far a limb explains points is asked
    /// beside the whole pose.
    pub angle_std_rad_per_sqrt_s: f32,
    /// Most blocks of points that pull.
    pub pulling_blocks: usize,
    /// Whether particles take over the fitted trunk, and not the root alone: limbs then hang where
    /// the points show the trunk.
    pub fit_trunk: bool,
}

impl RootAlignment {
    /// The same.
    ///
    /// # Errors
    /// Names the first standard deviation that is not positive.
    pub fn checked(self) -> Result<Self, ParameterError> {
        positive("shift_std_m_per_sqrt_s", self.shift_std_m_per_sqrt_s)?;
        positive("turn_std_rad_per_sqrt_s", self.turn_std_rad_per_sqrt_s)?;
        positive("angle_std_rad_per_sqrt_s", self.angle_std_rad_per_sqrt_s)?;
        Ok(self)
    }

    /// The pose `expected_rad` fitted to the points `blocks`, `dt_s` seconds after the last one. In
    /// coarse steps the angles of limbs that are `unseen` hold still: points of whatever hides
    /// a limb are not its own.
    #[must_use]
    pub fn fit_root<const BONES: usize, const ANGLES: usize>(
        &self,
        scene: &BodyScene<BONES, ANGLES>,
        blocks: &[PointBlock],
        (expected_rad, unseen): (&[f32; ANGLES], &[bool; ANGLES]),
        dt_s: f32,
    ) -> [f32; ANGLES] {
        let inverse_variance = |std: f32| 1.0 / (std * std * dt_s);
        let mut stiffness = [inverse_variance(self.angle_std_rad_per_sqrt_s); ANGLES];
        for (i, held) in stiffness.iter_mut().enumerate().take(scene.skeleton.root_coordinates()) {
            let is_shift = i < SHIFTS;
            *held = inverse_variance(if is_shift { self.shift_std_m_per_sqrt_s } else { self.turn_std_rad_per_sqrt_s });
        }
        let prior = PoseDensity {
            skeleton: &scene.skeleton,
            root_m: Vec3::zeros(),
            goals: &[],
            previous_rad: *expected_rad,
            stiffness,
            held: 0,
        };
        let density = GuidedDensity::of_some(prior, scene, blocks, self.pulling_blocks);
        if !self.coarse_to_fine {
            return density.mode(self.steps).angles_rad;
        }
        let mut far_prior = prior;
        for (held, _) in far_prior.stiffness.iter_mut().zip(unseen).filter(|(_, unseen)| **unseen) {
            *held = HELD_STIFFNESS;
        }
        density.mode_coarse_to_fine(&far_prior, self.steps).angles_rad
    }
}
