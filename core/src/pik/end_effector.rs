//! Probabilistic inverse kinematics: goals in space, then a pose that reaches them (PIK paper,
//! sections 4 and 5).

use super::goal::{GoalMemory, GoalProcess, Goals};
use super::motion::{BodyMotion, BodyParticle, FramePast, Proposed};
use super::proposal::{LaplaceProposal, LimitMass};
use super::root::RootProcess;
use crate::kinematics::gradient_projection::mode_by_gradient;
use crate::kinematics::inverse::{Mode, PoseDensity, PoseObjective, Solve};
use crate::math::{Vec3, clamp};
use crate::random::Stream;

/// Greatest size of a log importance ratio: where the expansion is bad the ratio would decide
/// alone. Chosen: far beyond the ratios of a good expansion.
const MAX_LOG_RATIO: f32 = 10.0;

/// Draws that estimate the mass inside the limits, where the weight is corrected.
/// Chosen: bounds the time of a particle.
const LIMIT_MASS_DRAWS: usize = 8;

/// Goals from a process, poses by the Laplace proposal.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::pik::end_effector::EndEffectorMotion;
/// use sinew_core::pik::example::{arm_past, arm_scene};
/// use sinew_core::pik::goal::{LinearExtrapolation, MEMORY};
/// use sinew_core::pik::motion::{BodyMotion, BodyParticle, FramePast};
/// use sinew_core::pik::processes::extrapolation::LinearGoals;
/// use sinew_core::pik::root::RootProcess;
/// use sinew_core::random::Stream;
/// use sinew_core::skeleton::arm::FOREARM;
///
/// let scene = arm_scene()?;
/// let ancestor = BodyParticle::at(&scene.skeleton, [0.5, 0.1, 0.1, 1.0]);
/// let past = arm_past(&scene, &ancestor, &[]);
/// // The hand was lifted by half a metre a second: after a tenth of a second poses reach five centimetres higher.
/// let past = FramePast { velocity_m_per_s: &[Vec3::zeros(), Vec3::new(0.0, -0.5, 0.0)], ..past };
/// let process = LinearExtrapolation { persistence: 1.0, std_m_per_sqrt_s: 0.05 };
/// let motion = EndEffectorMotion {
///     process: &LinearGoals::new(&[FOREARM], 2, process, 0.01)?,
///     root: RootProcess::FIXED,
///     angle_std_rad_per_sqrt_s: [2.0; 4],
///     angle_persistence: 0.0,
///     solver_steps: 5,
///     by_gradient: false,
///     corrects_weight: false,
///     draw_share: 0.1,
/// };
/// let mut lift_m = 0.0;
/// for particle in 0..200 {
///     let moved = motion.propose(&past, &ancestor, &mut [0.0; MEMORY], &mut Stream::new(1, 0, particle));
///     lift_m += (ancestor.ends_m[FOREARM].y - moved.posture.ends[FOREARM].y) / 200.0;
/// }
/// assert!((lift_m - 0.05).abs() < 0.01, "{lift_m}");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndEffectorMotion<'a, P, const ANGLES: usize> {
    /// Where the end-effectors want to be.
    pub process: &'a P,
    /// The root's own process.
    pub root: RootProcess,
    /// Standard deviation of each angle's change after one second, radians: lambda = 1 / (std^2 dt)
    /// of PIK (12), a diagonal.
    pub angle_std_rad_per_sqrt_s: [f32; ANGLES],
    /// Share of the angles' velocities that goes on in what the stiffness holds on to: zero is PIK
    /// (12), the pose of the frame before.
    pub angle_persistence: f32,
    /// Most steps of the solver.
    pub solver_steps: usize,
    /// Whether the steps are the paper's gradient projection (section 5.2.1), which needs many more
    /// of them than Gauss-Newton.
    pub by_gradient: bool,
    /// Whether the weight takes the importance ratio (18).
    pub corrects_weight: bool,
    /// Standard deviation of the draw relative to that of the Laplace expansion, in (0, 1]; 1 is
    /// the paper's, and what is meant where the weight is corrected. Below it goals spread the
    /// particles, and angles that no goal moves spread them less.
    pub draw_share: f32,
}

/// Makes the expansion around a mode `share` times as wide, about the same centre.
///
/// ```
/// use sinew_core::kinematics::inverse::Solve;
/// use sinew_core::pik::end_effector::narrow;
/// use sinew_core::pik::example::{hand_goal, reaching_arm, right_arm};
/// use sinew_core::pik::proposal::LaplaceProposal;
///
/// let (skeleton, goals) = (right_arm()?, hand_goal());
/// let density = reaching_arm(&skeleton, &goals);
/// let mut mode = density.mode(10);
/// let wide = LaplaceProposal::new(&mode).expect("a mode has curvature");
/// let curvature = mode.hessian[0][0];
/// narrow(&mut mode, 0.5);
/// let half = LaplaceProposal::new(&mode).expect("as before");
/// assert!((mode.hessian[0][0] / curvature - 4.0).abs() < 1e-5, "half as wide");
/// assert!((half.centre_rad()[0] - wide.centre_rad()[0]).abs() < 1e-4, "about the same centre");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
pub fn narrow<const ANGLES: usize>(mode: &mut Mode<ANGLES>, share: f32) {
    let sharper = 1.0 / (share * share);
    for i in 0..ANGLES {
        mode.gradient[i] *= sharper;
        for entry in &mut mode.hessian[i] {
            *entry *= sharper;
        }
    }
}

/// lambda of PIK (12), one an angle.
pub(super) fn stiffness<const ANGLES: usize>(std_rad: &[f32; ANGLES]) -> [f32; ANGLES] {
    std_rad.map(|std| 1.0 / (std * std))
}

impl<P: GoalProcess<BONES>, const BONES: usize, const ANGLES: usize> BodyMotion<BONES, ANGLES>
    for EndEffectorMotion<'_, P, ANGLES>
{
    fn root(&self) -> &RootProcess {
        &self.root
    }

    fn propose(
        &self,
        past: &FramePast<'_, BONES, ANGLES>,
        ancestor: &BodyParticle<BONES, ANGLES>,
        memory: &mut GoalMemory,
        stream: &mut Stream,
    ) -> Proposed<BONES, ANGLES> {
        let skeleton = &past.scene.skeleton;
        let mut previous_rad = ancestor.angles_rad;
        self.root.draw(skeleton, &mut previous_rad, &past.shared_change, past.dt_s, stream);
        for i in skeleton.root_coordinates()..ANGLES {
            previous_rad[i] += past.change(i, self.angle_persistence);
        }
        let previous_rad = skeleton.clamp(previous_rad);
        let mut goals = Goals::new();
        self.process.draw(&past.goals_of(ancestor), memory, stream, &mut goals);
        let density = PoseDensity {
            skeleton,
            root_m: Vec3::zeros(),
            goals: &goals,
            previous_rad,
            stiffness: stiffness(&past.angle_std_rad(&self.angle_std_rad_per_sqrt_s)),
            held: skeleton.root_coordinates(),
        };
        let mut mode = if self.by_gradient {
            mode_by_gradient(&density, self.solver_steps)
        } else {
            density.mode(self.solver_steps)
        };
        if !self.corrects_weight {
            narrow(&mut mode, self.draw_share);
        }
        let Some(proposal) = LaplaceProposal::new(&mode) else {
            let posture = density.posture(&mode.angles_rad);
            return Proposed { angles_rad: mode.angles_rad, posture, log_ratio: 0.0 };
        };
        let draw = proposal.draw(skeleton.limits(), stream);
        let posture = density.posture(&draw.angles_rad);
        let log_ratio = if self.corrects_weight {
            let log_density = density.log_density(&draw.angles_rad, &posture);
            let log_box = proposal.log_box(skeleton.limits(), LIMIT_MASS_DRAWS, stream);
            let ratio = proposal.log_importance_ratio(&draw, log_density, LimitMass::Counted { log_box });
            clamp(ratio, -MAX_LOG_RATIO, MAX_LOG_RATIO)
        } else {
            0.0
        };
        Proposed { angles_rad: draw.angles_rad, posture, log_ratio }
    }
}
