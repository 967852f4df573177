//! Guided proposals: the points pull at the pose before it is drawn (DESIGN.md, section 3: beyond the paper).

use super::end_effector::stiffness;
use super::goal::{GoalMemory, GoalProcess, Goals};
use super::motion::{BodyMotion, BodyParticle, BodyScene, FramePast, Proposed};
use super::proposal::LaplaceProposal;
use super::root::RootProcess;
use crate::kinematics::body_information::BodyInformation;
use crate::kinematics::forward::Posture;
use crate::kinematics::inverse::{PoseDensity, PoseObjective, Solve};
use crate::math::Vec3;
use crate::observation::point_cloud::PointBlock;
use crate::observation::point_pull::add_pull;
use crate::random::Stream;
use crate::skeleton::Skeleton;

/// Inverse variance of a root coordinate that its process holds.
const HELD_STIFFNESS: f32 = 1.0e6;

/// As [`super::end_effector::EndEffectorMotion`], but goals, stiffness, root *and* points make the density whose mode and Laplace
/// expansion the pose is drawn from, so that the draw knows the frame's data.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GuidedMotion<'a, P, const ANGLES: usize> {
    /// Where the end-effectors want to be.
    pub process: &'a P,
    /// The root's own process.
    pub root: RootProcess,
    /// Standard deviation of each angle's change after one second, radians.
    pub angle_std_rad_per_sqrt_s: [f32; ANGLES],
    /// Most steps of the solver.
    pub solver_steps: usize,
    /// Most blocks of points that pull; of a larger cloud every n-th one does, n times as strongly.
    pub pulling_blocks: usize,
}

/// Eq. (12) times the points' likelihood.
#[derive(Debug, Clone, Copy)]
pub struct GuidedDensity<'a, const BONES: usize, const ANGLES: usize> {
    /// Eq. (12).
    pub prior: PoseDensity<'a, BONES, ANGLES>,
    /// The body and its camera.
    pub scene: &'a BodyScene<BONES, ANGLES>,
    /// The frame's points.
    pub blocks: &'a [PointBlock],
    /// Every how many blocks pull, at least one; each that does pulls as often.
    pub stride: usize,
}

impl<const BONES: usize, const ANGLES: usize> PoseObjective<BONES, ANGLES> for GuidedDensity<'_, BONES, ANGLES> {
    fn skeleton(&self) -> &Skeleton<BONES, ANGLES> {
        self.prior.skeleton
    }

    fn root_m(&self) -> Vec3 {
        self.prior.root_m
    }

    fn start_rad(&self) -> [f32; ANGLES] {
        self.prior.previous_rad
    }

    fn held(&self) -> usize {
        self.prior.held
    }

    fn log_density(&self, angles_rad: &[f32; ANGLES], posture: &Posture<BONES, ANGLES>) -> f32 {
        let surface = self.scene.surface(posture);
        let points = self.scene.likelihood.log_likelihood_of(&surface, self.blocks.iter().step_by(self.stride));
        self.prior.log_density(angles_rad, posture) + points * self.stride as f32
    }

    fn derivatives(
        &self,
        angles_rad: &[f32; ANGLES],
        posture: &Posture<BONES, ANGLES>,
    ) -> ([f32; ANGLES], [[f32; ANGLES]; ANGLES]) {
        let (mut gradient, mut hessian) = self.prior.derivatives(angles_rad, posture);
        let surface = self.scene.surface(posture);
        let mut information = BodyInformation::none(posture);
        let pulling = self.blocks.iter().step_by(self.stride);
        add_pull(&self.scene.likelihood, &surface, pulling, self.stride as f32, &mut information);
        information.add_to(self.prior.skeleton, posture, &mut gradient, &mut hessian);
        (gradient, hessian)
    }

    fn residual_m(&self, posture: &Posture<BONES, ANGLES>) -> f32 {
        self.prior.residual_m(posture)
    }
}

impl<P: GoalProcess<BONES>, const BONES: usize, const ANGLES: usize> BodyMotion<BONES, ANGLES>
    for GuidedMotion<'_, P, ANGLES>
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
        let mut goals = Goals::new();
        self.process.expect(&past.goals_of(ancestor), memory, stream, &mut goals);
        let mut previous_rad = ancestor.angles_rad;
        let mut stiffness = stiffness(&self.angle_std_rad_per_sqrt_s, past.dt_s);
        for i in 0..skeleton.root_coordinates() {
            previous_rad[i] += past.root_change.get(i).copied().unwrap_or(0.0);
            let std = self.root.std(i, past.dt_s);
            stiffness[i] = if std > 0.0 { 1.0 / (std * std) } else { HELD_STIFFNESS };
        }
        let prior = PoseDensity { skeleton, root_m: Vec3::zeros(), goals: &goals, previous_rad, stiffness, held: 0 };
        let stride = past.blocks.len().div_ceil(self.pulling_blocks.max(1)).max(1);
        let density = GuidedDensity { prior, scene: past.scene, blocks: past.blocks, stride };
        let mode = density.mode(self.solver_steps);
        let Some(proposal) = LaplaceProposal::new(&mode) else {
            let posture = density.posture(&mode.angles_rad);
            return Proposed { angles_rad: mode.angles_rad, posture, log_ratio: 0.0 };
        };
        let draw = proposal.draw(skeleton.limits(), stream);
        let posture = density.posture(&draw.angles_rad);
        let log_ratio = prior.log_density(&draw.angles_rad, &posture) - proposal.log_density(&draw);
        Proposed { angles_rad: draw.angles_rad, posture, log_ratio }
    }
}
