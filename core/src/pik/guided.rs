//! Guided proposals: the points pull at the pose before it is drawn. Beyond the PIK paper.

use super::end_effector::stiffness;
use super::goal::{GoalMemory, GoalProcess, Goals};
use super::motion::{BodyMotion, BodyParticle, BodyScene, Climbed, FramePast, Proposed};
use super::proposal::LaplaceProposal;
use super::root::RootProcess;
use crate::kinematics::body_information::BodyInformation;
use crate::kinematics::forward::Posture;
use crate::kinematics::inverse::{Mode, PoseDensity, PoseObjective, Solve};
use crate::kinematics::solver_memory::SolverMemory;
use crate::math::Vec3;
use crate::observation::point_cloud::PointBlock;
use crate::observation::point_likelihood::PointLikelihood;
use crate::observation::point_pull::add_pull;
use crate::random::Stream;
use crate::skeleton::Skeleton;

/// Inverse variance of a coordinate that is held.
/// Chosen: a thousand times any stiffness of a free coordinate, and still well conditioned in
/// `f32`.
pub(crate) const HELD_STIFFNESS: f32 = 1.0e6;

/// How many times as far points reach in the coarse steps of
/// [`GuidedDensity::mode_coarse_to_fine`]. Chosen: reaches the forearm of the test in this file.
const FAR_REACH: f32 = 2.0;
/// Coarse steps. Chosen: bounds the time of a particle.
const FAR_STEPS: usize = 2;
/// Noise, as a share of the motion model's, from which on a limb may be farther off than points
/// reach. Chosen: a limb at rest stays below it, one that moves or is unseen does not.
pub(crate) const LOOSE_SHARE: f32 = 0.8;

/// As [`super::end_effector::EndEffectorMotion`], but goals, stiffness, root *and* points make the
/// density. The pose is drawn from the mode and Laplace expansion of that density, so the draw
/// knows the frame's data.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::pik::example::{arm_past, arm_points, arm_scene};
/// use sinew_core::pik::goal::{LinearExtrapolation, MEMORY};
/// use sinew_core::pik::guided::GuidedMotion;
/// use sinew_core::pik::motion::{BodyMotion, BodyParticle};
/// use sinew_core::pik::processes::extrapolation::LinearGoals;
/// use sinew_core::pik::root::RootProcess;
/// use sinew_core::random::Stream;
/// use sinew_core::skeleton::arm::FOREARM;
///
/// let scene = arm_scene()?;
/// let cloud = arm_points(&scene, &[0.5, 0.1, 0.1, 1.4]);
/// let ancestor = BodyParticle::at(&scene.skeleton, [0.5, 0.1, 0.1, 1.0]);
/// let past = arm_past(&scene, &ancestor, cloud.blocks());
/// // The elbow was at 1.0 rad and seemed to stand still; the frame's points lie where it is at 1.4 rad.
/// let process = LinearExtrapolation { persistence: 1.0, std_m_per_sqrt_s: 0.5 };
/// let motion = GuidedMotion {
///     process: &LinearGoals::new(&[FOREARM], 2, process, 0.05)?,
///     root: RootProcess::FIXED,
///     angle_std_rad_per_sqrt_s: [1.0; 4],
///     angle_persistence: 0.0,
///     solver_steps: 5,
///     pulling_blocks: 2,
///     refining_steps: 0,
/// };
/// let hand_m = scene.posture(&[0.5, 0.1, 0.1, 1.4]).ends[FOREARM];
/// let mut mean_m = Vec3::zeros();
/// for particle in 0..100 {
///     let moved = motion.propose(&past, &ancestor, &mut [0.0; MEMORY], &mut Stream::new(1, 0, particle));
///     mean_m += moved.posture.ends[FOREARM] / 100.0;
/// }
/// let (before_m, after_m) = ((ancestor.ends_m[FOREARM] - hand_m).norm(), (mean_m - hand_m).norm());
/// assert!(after_m < 0.5 * before_m, "the points pulled the hand: {before_m} {after_m}");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GuidedMotion<'a, P, const ANGLES: usize> {
    /// Where the end-effectors want to be.
    pub process: &'a P,
    /// The root's own process.
    pub root: RootProcess,
    /// Standard deviation of each angle's change after one second, radians.
    pub angle_std_rad_per_sqrt_s: [f32; ANGLES],
    /// Share of the angles' velocities that goes on in what the stiffness holds on to.
    pub angle_persistence: f32,
    /// Most steps of the solver.
    pub solver_steps: usize,
    /// Most blocks of points that pull; of a larger cloud every n-th one does, n times as strongly.
    /// Each particle draws for itself with which one it begins. Were it the same for all, what the
    /// others show would be missing from every particle's mode alike.
    pub pulling_blocks: usize,
    /// Steps from the particles' mean to the mode of the density about the estimate before, by all
    /// points; zero reports the mean. A mean of few particles has their chance in it, the mode
    /// has not.
    pub refining_steps: usize,
}

/// Eq. (12) times the points' likelihood.
///
/// ```
/// use sinew_core::kinematics::inverse::{PoseDensity, Solve};
/// use sinew_core::math::Vec3;
/// use sinew_core::pik::example::{arm_points, arm_scene};
/// use sinew_core::pik::guided::GuidedDensity;
/// use sinew_core::skeleton::arm::FOREARM;
///
/// let scene = arm_scene()?;
/// // Lay a pose onto points, without any goal: the elbow was at 1.0 rad, the points show it at 1.4 rad.
/// let truth_rad = [0.5, 0.1, 0.1, 1.4];
/// let cloud = arm_points(&scene, &truth_rad);
/// let prior = PoseDensity {
///     skeleton: &scene.skeleton,
///     root_m: Vec3::zeros(),
///     goals: &[],
///     previous_rad: [0.5, 0.1, 0.1, 1.0],
///     stiffness: [1.0; 4],
///     held: 0,
/// };
/// let mode = GuidedDensity { prior, scene: &scene, blocks: cloud.blocks(), stride: 1, reach: 1.0 }.mode(10);
/// let hand_m = |pose| scene.posture(&pose).ends[FOREARM];
/// let [before_m, after_m] =
///     [prior.previous_rad, mode.angles_rad].map(|pose| (hand_m(pose) - hand_m(truth_rad)).norm());
/// assert!(after_m < 0.4 * before_m, "{before_m} {after_m}");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
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
    /// How many times as far as the scene's likelihood has it a point speaks to skin; 1 is the
    /// likelihood itself.
    pub reach: f32,
}

impl<'a, const BONES: usize, const ANGLES: usize> GuidedDensity<'a, BONES, ANGLES> {
    /// The density by every n-th of `blocks`, from the first on, so that at most `pulling_blocks`
    /// pull.
    pub(crate) fn of_some(
        prior: PoseDensity<'a, BONES, ANGLES>,
        scene: &'a BodyScene<BONES, ANGLES>,
        blocks: &'a [PointBlock],
        pulling_blocks: usize,
    ) -> Self {
        let stride = blocks.len().div_ceil(pulling_blocks.max(1)).max(1);
        Self { prior, scene, blocks, stride, reach: 1.0 }
    }

    /// The likelier of two modes: from the start, and from the pose after two coarse steps about
    /// `far_prior`. In coarse steps points reach twice as far. In fine steps no point pulls at
    /// a limb that moved farther than points reach.
    #[must_use]
    pub fn mode_coarse_to_fine(&self, far_prior: &PoseDensity<'_, BONES, ANGLES>, max_steps: usize) -> Mode<ANGLES> {
        let far_rad = self.far_start_rad(far_prior, &mut SolverMemory::new());
        self.mode_from(&[self.start_rad(), far_rad], max_steps)
    }

    /// The pose after two coarse steps about `far_prior`.
    // Not inlined: coarse and fine steps need their stack one after the other.
    #[inline(never)]
    pub(crate) fn far_start_rad(
        &self,
        far_prior: &PoseDensity<'_, BONES, ANGLES>,
        memory: &mut SolverMemory<BONES, ANGLES>,
    ) -> [f32; ANGLES] {
        let far = GuidedDensity { prior: *far_prior, reach: FAR_REACH * self.reach, ..*self };
        far.solve_within(&[], FAR_STEPS, memory).angles_rad
    }

    /// Writes what the points say of the bones, and returns their log-likelihood. Not inlined: the
    /// surface leaves the stack before twists need it.
    #[inline(never)]
    fn pull(&self, posture: &Posture<BONES, ANGLES>, information: &mut BodyInformation<BONES>) -> f32 {
        information.clear(posture);
        let surface = self.scene.surface(posture);
        add_pull(&self.likelihood(), &surface, self.pulling(), self.stride as f32, information)
    }

    fn pulling(&self) -> impl Iterator<Item = &PointBlock> {
        self.blocks.iter().step_by(self.stride.max(1))
    }

    /// The log density, where `points` is the log-likelihood of the blocks that pull.
    fn posterior(&self, angles_rad: &[f32; ANGLES], posture: &Posture<BONES, ANGLES>, points: f32) -> f32 {
        self.prior.log_density(angles_rad, posture) + points * self.stride as f32
    }

    fn likelihood(&self) -> PointLikelihood {
        let likelihood = self.scene.likelihood;
        PointLikelihood { outlier_m: self.reach * likelihood.outlier_m, ..likelihood }
    }
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
        let points = self.likelihood().log_likelihood_of(&surface, self.pulling());
        self.posterior(angles_rad, posture, points)
    }

    fn inform(
        &self,
        angles_rad: &[f32; ANGLES],
        posture: &Posture<BONES, ANGLES>,
        information: &mut BodyInformation<BONES>,
    ) -> f32 {
        let points = self.pull(posture, information);
        self.posterior(angles_rad, posture, points)
    }

    fn derivatives(
        &self,
        angles_rad: &[f32; ANGLES],
        posture: &Posture<BONES, ANGLES>,
    ) -> ([f32; ANGLES], [[f32; ANGLES]; ANGLES]) {
        let (mut gradient, mut hessian) = ([0.0; ANGLES], [[0.0; ANGLES]; ANGLES]);
        let mut information = BodyInformation::empty();
        self.pull(posture, &mut information);
        self.write_derivatives((angles_rad, posture), (&mut gradient, &mut hessian), &mut information);
        (gradient, hessian)
    }

    fn write_derivatives(
        &self,
        (angles_rad, posture): (&[f32; ANGLES], &Posture<BONES, ANGLES>),
        (gradient, hessian): (&mut [f32; ANGLES], &mut [[f32; ANGLES]; ANGLES]),
        information: &mut BodyInformation<BONES>,
    ) {
        self.prior.write_derivatives((angles_rad, posture), (&mut *gradient, &mut *hessian), information);
        information.add_to(self.prior.skeleton, posture, gradient, hessian);
    }

    fn residual_m(&self, posture: &Posture<BONES, ANGLES>) -> f32 {
        self.prior.residual_m(posture)
    }
}

/// Where a guided model takes an ancestor before any point is seen: PIK (12) with the goals' means
/// and their whole spread.
#[derive(Debug, Clone)]
pub(crate) struct GuidedPrior<const ANGLES: usize> {
    goals: Goals,
    /// The expected pose.
    pub(crate) expected_rad: [f32; ANGLES],
    stiffness: [f32; ANGLES],
}

impl<const ANGLES: usize> GuidedPrior<ANGLES> {
    /// The density of poses of `skeleton`.
    pub(crate) fn density<'a, const BONES: usize>(
        &'a self,
        skeleton: &'a Skeleton<BONES, ANGLES>,
    ) -> PoseDensity<'a, BONES, ANGLES> {
        let (goals, previous_rad, stiffness) = (&self.goals, self.expected_rad, self.stiffness);
        PoseDensity { skeleton, root_m: Vec3::zeros(), goals, previous_rad, stiffness, held: 0 }
    }
}

impl<P, const ANGLES: usize> GuidedMotion<'_, P, ANGLES> {
    /// What is expected of `ancestor` in this frame.
    pub(crate) fn prior<const BONES: usize>(
        &self,
        past: &FramePast<'_, BONES, ANGLES>,
        ancestor: &BodyParticle<BONES, ANGLES>,
        memory: &mut GoalMemory,
        stream: &mut Stream,
    ) -> GuidedPrior<ANGLES>
    where
        P: GoalProcess<BONES>,
    {
        let skeleton = &past.scene.skeleton;
        let mut goals = Goals::new();
        self.process.expect(&past.goals_of(ancestor), memory, stream, &mut goals);
        let mut expected_rad = ancestor.angles_rad;
        for (i, angle) in expected_rad.iter_mut().enumerate() {
            *angle += past.change(i, self.angle_persistence);
        }
        let mut stiffness = stiffness(&past.angle_std_rad(&self.angle_std_rad_per_sqrt_s));
        for i in 0..skeleton.root_coordinates() {
            let std = self.root.std(i, past.dt_s);
            stiffness[i] = if std > 0.0 { 1.0 / (std * std) } else { HELD_STIFFNESS };
        }
        GuidedPrior { goals, expected_rad: skeleton.clamp(expected_rad), stiffness }
    }

    /// Whether the limb of an end-effector is fast or unseen, so that it may be farther from where
    /// it is expected than points reach.
    pub(crate) fn is_any_loose<const BONES: usize>(&self, past: &FramePast<'_, BONES, ANGLES>) -> bool
    where
        P: GoalProcess<BONES>,
    {
        let share = |&bone: &usize| past.noise_share.get(bone).copied().unwrap_or(1.0);
        self.process.end_effectors().iter().map(share).any(|share| share >= LOOSE_SHARE)
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
        let prior = self.prior(past, ancestor, memory, stream);
        let prior = prior.density(skeleton);
        let mut density = GuidedDensity::of_some(prior, past.scene, past.blocks, self.pulling_blocks);
        density.blocks = past.blocks.get(stream.below(density.stride as u32) as usize..).unwrap_or_default();
        let mode = if self.is_any_loose(past) {
            density.mode_coarse_to_fine(&prior, self.solver_steps)
        } else {
            density.mode(self.solver_steps)
        };
        let Some(proposal) = LaplaceProposal::new(&mode) else {
            let posture = density.posture(&mode.angles_rad);
            return Proposed { angles_rad: mode.angles_rad, posture, log_ratio: 0.0 };
        };
        let draw = proposal.draw(skeleton.limits(), stream);
        let posture = density.posture(&draw.angles_rad);
        let log_ratio = prior.log_density(&draw.angles_rad, &posture) - proposal.log_density(&draw);
        Proposed { angles_rad: draw.angles_rad, posture, log_ratio }
    }

    // Not inlined: the solver's memory is not that of the weights.
    #[inline(never)]
    fn climb(
        &self,
        past: &FramePast<'_, BONES, ANGLES>,
        before: &BodyParticle<BONES, ANGLES>,
        mean_rad: Option<&[f32; ANGLES]>,
    ) -> Option<Climbed<ANGLES>> {
        if self.refining_steps == 0 {
            return None;
        }
        // Goals are expected without chance.
        let prior = self.prior(past, before, &mut before.memory.clone(), &mut Stream::new(0, 0, 0));
        let prior = prior.density(&past.scene.skeleton);
        let density = GuidedDensity::of_some(prior, past.scene, past.blocks, usize::MAX);
        let mut memory = SolverMemory::new();
        let solution = match mean_rad {
            Some(mean_rad) => density.solve_within(&[*mean_rad], self.refining_steps, &mut memory),
            None if self.is_any_loose(past) => {
                let far_rad = density.far_start_rad(&prior, &mut memory);
                density.solve_within(&[prior.previous_rad, far_rad], self.refining_steps, &mut memory)
            }
            None => density.solve_within(&[], self.refining_steps, &mut memory),
        };
        Some(Climbed { angles_rad: solution.angles_rad, log_density: solution.log_density })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observation::point_cloud::PointCloud;
    use crate::pik::goal::{LinearExtrapolation, MEMORY};
    use crate::pik::processes::extrapolation::LinearGoals;
    use crate::skeleton::arm::FOREARM;
    use crate::skeleton::{ArmGeometry, Side};

    /// A left arm two metres before the camera.
    fn scene_of(outlier_m: f32) -> BodyScene<2, 4> {
        let skeleton = ArmGeometry::new(Side::Left, 0.30, 0.35).unwrap().skeleton().unwrap();
        let likelihood = PointLikelihood { std_m: 0.05, outlier_m };
        let camera_m = Vec3::new(0.0, 0.0, -2.0);
        BodyScene { skeleton, radii_m: [0.05, 0.04], camera_m, likelihood, self_penetration: None }
    }

    /// Points along the arm of a pose, as the camera sees them.
    fn cloud_of(scene: &BodyScene<2, 4>, pose_rad: &[f32; 4]) -> PointCloud<3> {
        let surface = scene.surface(&scene.posture(pose_rad));
        let mut points_m: [Vec3; 48] = core::array::from_fn(|i| {
            let bone = surface.capsules[i % 2].capsule;
            let place_m = bone.start_m + (bone.end_m - bone.start_m) * (i as f32 / 48.0);
            bone.nearest_visible(&scene.camera_m, &(place_m - Vec3::z()))
        });
        let mut cloud = PointCloud::new();
        let _ = cloud.set(&mut points_m, &scene.camera_m);
        cloud
    }

    /// No goals; each angle is held on to alike.
    fn prior_about(scene: &BodyScene<2, 4>, previous_rad: [f32; 4], stiffness: f32) -> PoseDensity<'_, 2, 4> {
        let (skeleton, stiffness) = (&scene.skeleton, [stiffness; 4]);
        PoseDensity { skeleton, root_m: Vec3::zeros(), goals: &[], previous_rad, stiffness, held: 0 }
    }

    /// Brute force over all poses of an arm: the best of a few climbs is above the greatest of
    /// 15^4 poses, and the arm is where that one is.
    #[test]
    fn the_best_of_a_few_climbs_is_the_greatest_of_a_grid() {
        const SIDES: usize = 15;
        let scene = scene_of(0.3);
        let limits = scene.skeleton.limits();
        let pose_of = |mut index: usize| {
            core::array::from_fn(|angle| {
                let step = (index % SIDES) as f32 / (SIDES - 1) as f32;
                index /= SIDES;
                limits[angle].low_rad + step * (limits[angle].high_rad - limits[angle].low_rad)
            })
        };
        for truth_rad in [[0.9, 0.2, 0.3, 1.4], [2.0, -0.3, 0.1, 0.7]] {
            let cloud = cloud_of(&scene, &truth_rad);
            let prior = prior_about(&scene, [0.4, 0.0, 0.0, 0.9], 0.5);
            let density = GuidedDensity { prior, scene: &scene, blocks: cloud.blocks(), stride: 1, reach: 1.0 };
            let log_density = |pose_rad: &[f32; 4]| density.log_density(pose_rad, &scene.posture(pose_rad));
            let grid = (0..SIDES.pow(4)).map(pose_of).map(|pose_rad| (log_density(&pose_rad), pose_rad));
            let (grid_log, grid_rad) = grid.reduce(|best, next| if next.0 > best.0 { next } else { best }).unwrap();
            let starts =
                [0.2, 1.2, 2.2].into_iter().flat_map(|elevation| [0.2, 1.2].map(|elbow| [elevation, 0.0, 0.0, elbow]));
            let climbs = starts.map(|start_rad| density.mode_from(&[start_rad], 30));
            let mode =
                climbs.reduce(|best, next| if next.log_density > best.log_density { next } else { best }).unwrap();
            let above = mode.log_density - grid_log;
            assert!((0.0..30.0).contains(&above), "{truth_rad:?}: {} against {grid_log}", mode.log_density);
            let ends = |pose_rad: &[f32; 4]| scene.posture(pose_rad).ends;
            for (found_m, grid_m) in ends(&mode.angles_rad).iter().zip(ends(&grid_rad)) {
                assert!((found_m - grid_m).norm() < 0.12, "{truth_rad:?}: {found_m} against {grid_m}");
            }
        }
    }

    /// A forearm that swung farther than its points reach: it stays where it was without coarse
    /// steps. One that has hardly moved ends at the same place either way.
    #[test]
    fn what_swung_out_of_reach_is_found_from_afar() {
        let scene = scene_of(0.08);
        let off_m = |truth_rad: [f32; 4], coarse_to_fine: bool| {
            let cloud = cloud_of(&scene, &truth_rad);
            let prior = prior_about(&scene, [0.5, 0.1, 0.1, 0.9], 4.0);
            let density = GuidedDensity { prior, scene: &scene, blocks: cloud.blocks(), stride: 1, reach: 1.0 };
            let hand_m = |pose_rad| scene.posture(&pose_rad).ends[FOREARM];
            let mode = if coarse_to_fine { density.mode_coarse_to_fine(&prior, 4) } else { density.mode(4) };
            (hand_m(mode.angles_rad) - hand_m(truth_rad)).norm()
        };
        let swung_rad = [0.5, 0.1, 0.1, 1.4];
        let (near_m, far_m) = (off_m(swung_rad, false), off_m(swung_rad, true));
        assert!(near_m > 0.15 && far_m < 0.07, "{near_m} {far_m}");
        let bent_rad = [0.5, 0.1, 0.1, 1.0];
        let (near_m, far_m) = (off_m(bent_rad, false), off_m(bent_rad, true));
        assert!(near_m < 0.03 && (far_m - near_m).abs() < 5.0e-3, "{near_m} {far_m}");
    }

    /// Of two blocks, one shows the elbow more bent than it was and the other one less. Particles
    /// that look at one each go either way.
    #[test]
    fn particles_look_at_points_of_their_own() {
        let scene = scene_of(0.25);
        let mut points_m: [Vec3; 32] = core::array::from_fn(|i| {
            let elbow_rad = if i < 16 { 0.6 } else { 1.4 };
            let surface = scene.surface(&scene.posture(&[0.5, 0.1, 0.1, elbow_rad]));
            let forearm = surface.capsules[FOREARM].capsule;
            let place_m = forearm.start_m + (forearm.end_m - forearm.start_m) * (0.5 + (i % 16) as f32 / 32.0);
            forearm.nearest_visible(&scene.camera_m, &(place_m - Vec3::z()))
        });
        let mut cloud = PointCloud::<2>::new();
        let _ = cloud.set(&mut points_m, &scene.camera_m);
        let ancestor = BodyParticle::at(&scene.skeleton, [0.5, 0.1, 0.1, 1.0]);
        let past = FramePast {
            scene: &scene,
            blocks: cloud.blocks(),
            angle_velocity_per_s: [0.0; 4],
            shared_change: [None; 4],
            velocity_m_per_s: &[Vec3::zeros(); 2],
            noise_share: &[1.0; 2],
            first_m: &ancestor.ends_m,
            dt_s: 0.1,
            is_first: true,
        };
        let process = LinearExtrapolation { persistence: 0.0, std_m_per_sqrt_s: 0.5 };
        let motion = GuidedMotion {
            process: &LinearGoals::new(&[FOREARM], 2, process, 0.05).unwrap(),
            root: RootProcess::FIXED,
            angle_std_rad_per_sqrt_s: [1.0; 4],
            angle_persistence: 0.0,
            solver_steps: 4,
            pulling_blocks: 1,
            refining_steps: 0,
        };
        // Along the way from one place of the hand to the other, from the middle between them.
        let hand_m = |elbow_rad| scene.posture(&[0.5, 0.1, 0.1, elbow_rad]).ends[FOREARM];
        let (bent_m, straight_m) = (hand_m(1.4), hand_m(0.6));
        let along = (0..60_u32).map(|index| {
            let moved = motion.propose(&past, &ancestor, &mut [0.0; MEMORY], &mut Stream::new(1, 0, index));
            (moved.posture.ends[FOREARM] - (bent_m + straight_m) * 0.5).dot(&(bent_m - straight_m))
        });
        let bent = along.filter(|along| *along > 0.0).count();
        assert!((15..=45).contains(&bent), "{bent} of 60 go where the elbow is more bent");
    }
}
