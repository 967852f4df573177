//! The body tracker's step: resample, move on, weigh, estimate (PIK paper, sections 5.1 and 6).

use super::alignment::RootAlignment;
use super::estimate::{BodyEstimate, mean_of_group, spread_of_group};
use super::observed::observed;
use super::pace::{LimbNoise, PaceNoise};
use super::steady::SteadyPose;
use super::tempering::temper;
use super::velocity::EstimateVelocity;
use crate::error::{ParameterError, Rule};
use crate::math::{Vec3, clamp, min, sqrt};
use crate::observation::limb_likelihood::ExpectedBody;
use crate::observation::point_cloud::PointBlock;
use crate::particle::Weights;
use crate::particle::resampling::systematic;
use crate::pik::motion::{BodyMotion, BodyParticle, BodyScene, FramePast};
use crate::pik::root::RootProcess;
use crate::random::Stream;
use crate::skeleton::Limbs;
use crate::skeleton::limbs::TRUNK_GROUP;

/// Stream of the resampling; particles have their own index.
const RESAMPLING_STREAM: u32 = u32::MAX;
/// Stream of what is drawn limb by limb.
const LIMB_STREAM: u32 = u32::MAX - 1;
/// Share of the estimate's velocity with which the body is expected to go on: between staying and going on.
const EXPECTED_PERSISTENCE: f32 = 0.5;
/// Particles that the least effective share is meant for.
const SHARE_PARTICLES: f32 = 100.0;

/// Options of the filter itself.
///
/// ```
/// use sinew_core::tracker::body::{BodyFrame, BodyOptions, BodyTracker, DEFAULT_BODY_OPTIONS};
/// # use sinew_core::pik::guided::GuidedMotion;
/// # use sinew_core::pik::motion::{BodyParticle, BodyScene};
/// # use sinew_core::pik::{goal::LinearExtrapolation, processes::extrapolation::LinearGoals, root::RootProcess};
/// # use sinew_core::skeleton::arm::FOREARM;
/// # use sinew_core::math::Vec3;
/// # use sinew_core::observation::{point_cloud::PointCloud, point_likelihood::PointLikelihood};
/// # use sinew_core::skeleton::{ArmGeometry, Side};
/// # let skeleton = ArmGeometry::new(Side::Left, 0.30, 0.35)?.skeleton()?;
/// # let likelihood = PointLikelihood { std_m: 0.05, outlier_m: 0.15 };
/// # let camera_m = Vec3::new(0.0, 0.0, -2.0);
/// # let scene = BodyScene { skeleton, radii_m: [0.05, 0.04], camera_m, likelihood, self_penetration: None };
/// # let points_of = |pose: &[f32; 4]| {
/// #     let surface = scene.surface(&scene.posture(pose));
/// #     let mut points_m = core::array::from_fn::<Vec3, 32, _>(|i| {
/// #         let bone = &surface.capsules[i % 2].capsule;
/// #         let place_m = bone.start_m + (bone.end_m - bone.start_m) * (i as f32 / 32.0);
/// #         bone.nearest_visible(&scene.camera_m, &(place_m - Vec3::z()))
/// #     });
/// #     let mut cloud = PointCloud::<2>::new();
/// #     let _ = cloud.set(&mut points_m, &scene.camera_m);
/// #     cloud
/// # };
/// # let process = LinearExtrapolation { persistence: 0.5, std_m_per_sqrt_s: 0.3 };
/// # let goals = LinearGoals::new(&[FOREARM], 2, process, 0.05)?;
/// # let (process, root, angle_std_rad_per_sqrt_s) = (&goals, RootProcess::FIXED, [1.0; 4]);
/// # let (solver_steps, pulling_blocks, angle_persistence) = (3, 2, 0.0);
/// # let motion =
/// #     GuidedMotion { process, root, angle_std_rad_per_sqrt_s, angle_persistence, solver_steps, pulling_blocks };
/// # let truth = |frame: usize| [0.5, 0.1, 0.1, 1.0 + 0.05 * frame as f32];
/// # let first = BodyParticle::at(&scene.skeleton, truth(0));
///
/// // Each limb is weighed and resampled by itself, so that all particles weigh the same after a step.
/// let options = BodyOptions { limb_by_limb: true, ..DEFAULT_BODY_OPTIONS };
/// let new = |options| BodyTracker::<2, 4, 30, _>::new(&first, ([first; 30], [first; 30]), options, 1);
/// let mut tracker = new(options)?;
/// let _ = tracker.step(&scene, &motion, &BodyFrame { dt_s: 1.0 / 15.0, blocks: points_of(&truth(1)).blocks() });
/// assert!(tracker.weights().iter().all(|weight| *weight == tracker.weights()[0]));
/// // A wrong option is refused by its name.
/// let wrong = new(BodyOptions { least_effective_share: 1.5, ..options });
/// assert_eq!(wrong.map_err(|error| error.parameter).err(), Some("least_effective_share"));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyOptions {
    /// Weights are flattened until at least this share of a hundred particles is effective, and of others a number that grows with the
    /// root of theirs: many particles tell a sharper likelihood from chance. Zero never flattens.
    pub least_effective_share: f32,
    /// Whether each limb is weighed by what it explains itself and resampled apart from the others.
    pub limb_by_limb: bool,
    /// How the expected pose is laid onto the points before particles are drawn, so that their root, and trunk if asked for, set out from
    /// there; `None` leaves them to their process.
    pub alignment: Option<RootAlignment>,
    /// How far the mean of the particles trembles about a limb at rest, in its standard errors: the pose that is told stays still within it.
    pub tremble_errors: f32,
    /// How far it trembles beyond that, however many particles there are, metres. Both zero tell each frame's mean.
    pub tremble_m: f32,
    /// How the noise of a limb follows its pace; `None` leaves every limb the motion model's own.
    pub pace: Option<PaceNoise>,
    /// Share of the velocity's last change that goes on, in [0, 1]: motion models are given a velocity that changes on as it did. Zero is the
    /// velocity of the last two frames.
    pub acceleration_share: f32,
}

/// What is used unless told otherwise.
pub const DEFAULT_BODY_OPTIONS: BodyOptions = BodyOptions {
    least_effective_share: 0.0,
    limb_by_limb: false,
    alignment: None,
    tremble_errors: 0.0,
    tremble_m: 0.0,
    pace: None,
    acceleration_share: 0.0,
};

/// One frame.
///
/// ```
/// use sinew_core::tracker::body::{BodyFrame, BodyTracker, DEFAULT_BODY_OPTIONS};
/// # use sinew_core::pik::guided::GuidedMotion;
/// # use sinew_core::pik::motion::{BodyParticle, BodyScene};
/// # use sinew_core::pik::{goal::LinearExtrapolation, processes::extrapolation::LinearGoals, root::RootProcess};
/// # use sinew_core::skeleton::arm::FOREARM;
/// # use sinew_core::math::Vec3;
/// # use sinew_core::observation::{point_cloud::PointCloud, point_likelihood::PointLikelihood};
/// # use sinew_core::skeleton::{ArmGeometry, Side};
/// # let skeleton = ArmGeometry::new(Side::Left, 0.30, 0.35)?.skeleton()?;
/// # let likelihood = PointLikelihood { std_m: 0.05, outlier_m: 0.15 };
/// # let camera_m = Vec3::new(0.0, 0.0, -2.0);
/// # let scene = BodyScene { skeleton, radii_m: [0.05, 0.04], camera_m, likelihood, self_penetration: None };
/// # let points_of = |pose: &[f32; 4]| {
/// #     let surface = scene.surface(&scene.posture(pose));
/// #     let mut points_m = core::array::from_fn::<Vec3, 32, _>(|i| {
/// #         let bone = &surface.capsules[i % 2].capsule;
/// #         let place_m = bone.start_m + (bone.end_m - bone.start_m) * (i as f32 / 32.0);
/// #         bone.nearest_visible(&scene.camera_m, &(place_m - Vec3::z()))
/// #     });
/// #     let mut cloud = PointCloud::<2>::new();
/// #     let _ = cloud.set(&mut points_m, &scene.camera_m);
/// #     cloud
/// # };
/// # let process = LinearExtrapolation { persistence: 0.5, std_m_per_sqrt_s: 0.3 };
/// # let goals = LinearGoals::new(&[FOREARM], 2, process, 0.05)?;
/// # let (process, root, angle_std_rad_per_sqrt_s) = (&goals, RootProcess::FIXED, [1.0; 4]);
/// # let (solver_steps, pulling_blocks, angle_persistence) = (3, 2, 0.0);
/// # let motion =
/// #     GuidedMotion { process, root, angle_std_rad_per_sqrt_s, angle_persistence, solver_steps, pulling_blocks };
/// # let truth = |frame: usize| [0.5, 0.1, 0.1, 1.0 + 0.05 * frame as f32];
/// # let first = BodyParticle::at(&scene.skeleton, truth(0));
///
/// # let sets = ([first; 30], [first; 30]);
/// # let mut tracker = BodyTracker::<2, 4, 30, _>::new(&first, sets, DEFAULT_BODY_OPTIONS, 1)?;
/// let cloud = points_of(&truth(1));
/// let seen = tracker.step(&scene, &motion, &BodyFrame { dt_s: 1.0 / 15.0, blocks: cloud.blocks() });
/// // No points for a third of a second: an ordinary frame, of which nobody learns anything.
/// let unseen = tracker.step(&scene, &motion, &BodyFrame { dt_s: 1.0 / 3.0, blocks: &[] });
/// assert_eq!(unseen.observed, [false; 2]);
/// assert!(unseen.spread_m[FOREARM] > seen.spread_m[FOREARM], "and the particles know less");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct BodyFrame<'a> {
    /// Time since the frame before, seconds; frames that were dropped are simply not given.
    pub dt_s: f32,
    /// The points; none is a frame without evidence.
    pub blocks: &'a [PointBlock],
}

/// What is needed to move and weigh any particle of a frame, in any order, on any thread.
///
/// ```
/// use sinew_core::tracker::body::{BodyFrame, BodyTracker, DEFAULT_BODY_OPTIONS};
/// # use sinew_core::pik::guided::GuidedMotion;
/// # use sinew_core::pik::motion::{BodyParticle, BodyScene};
/// # use sinew_core::pik::{goal::LinearExtrapolation, processes::extrapolation::LinearGoals, root::RootProcess};
/// # use sinew_core::skeleton::arm::FOREARM;
/// # use sinew_core::math::Vec3;
/// # use sinew_core::observation::{point_cloud::PointCloud, point_likelihood::PointLikelihood};
/// # use sinew_core::skeleton::{ArmGeometry, Side};
/// # let skeleton = ArmGeometry::new(Side::Left, 0.30, 0.35)?.skeleton()?;
/// # let likelihood = PointLikelihood { std_m: 0.05, outlier_m: 0.15 };
/// # let camera_m = Vec3::new(0.0, 0.0, -2.0);
/// # let scene = BodyScene { skeleton, radii_m: [0.05, 0.04], camera_m, likelihood, self_penetration: None };
/// # let points_of = |pose: &[f32; 4]| {
/// #     let surface = scene.surface(&scene.posture(pose));
/// #     let mut points_m = core::array::from_fn::<Vec3, 32, _>(|i| {
/// #         let bone = &surface.capsules[i % 2].capsule;
/// #         let place_m = bone.start_m + (bone.end_m - bone.start_m) * (i as f32 / 32.0);
/// #         bone.nearest_visible(&scene.camera_m, &(place_m - Vec3::z()))
/// #     });
/// #     let mut cloud = PointCloud::<2>::new();
/// #     let _ = cloud.set(&mut points_m, &scene.camera_m);
/// #     cloud
/// # };
/// # let process = LinearExtrapolation { persistence: 0.5, std_m_per_sqrt_s: 0.3 };
/// # let goals = LinearGoals::new(&[FOREARM], 2, process, 0.05)?;
/// # let (process, root, angle_std_rad_per_sqrt_s) = (&goals, RootProcess::FIXED, [1.0; 4]);
/// # let (solver_steps, pulling_blocks, angle_persistence) = (3, 2, 0.0);
/// # let motion =
/// #     GuidedMotion { process, root, angle_std_rad_per_sqrt_s, angle_persistence, solver_steps, pulling_blocks };
/// # let truth = |frame: usize| [0.5, 0.1, 0.1, 1.0 + 0.05 * frame as f32];
/// # let first = BodyParticle::at(&scene.skeleton, truth(0));
///
/// # let new =
/// #     || BodyTracker::<2, 4, 30, _>::new(&first, ([first; 30], [first; 30]), DEFAULT_BODY_OPTIONS, 1);
/// // Particles in any order, or on any thread: each has its own random numbers, so the answer is the same to the bit.
/// let cloud = points_of(&truth(1));
/// let frame = BodyFrame { dt_s: 1.0 / 15.0, blocks: cloud.blocks() };
/// let backwards = new()?.step_with(&scene, &motion, &frame, |advance, particles| {
///     for (index, slot) in particles.iter_mut().enumerate().rev() {
///         advance.particle(index, slot);
///     }
/// });
/// assert_eq!(backwards, new()?.step(&scene, &motion, &frame));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug)]
pub struct Advance<'a, M, const BONES: usize, const ANGLES: usize> {
    motion: &'a M,
    past: FramePast<'a, BONES, ANGLES>,
    ancestors: &'a [u16],
    particles: &'a [BodyParticle<BONES, ANGLES>],
    expected: &'a ExpectedBody<BONES>,
    seed: u64,
    frame: u64,
}

impl<M: BodyMotion<BONES, ANGLES>, const BONES: usize, const ANGLES: usize> Advance<'_, M, BONES, ANGLES> {
    /// Makes particle `index` of the new set, with its log-weights: that of the whole pose, then of each limb.
    pub fn particle(&self, index: usize, slot: &mut BodyParticle<BONES, ANGLES>) {
        let ancestor = self.ancestors.get(index).and_then(|&ancestor| self.particles.get(usize::from(ancestor)));
        let Some(ancestor) = ancestor else { return };
        let mut stream = Stream::new(self.seed, self.frame, index as u32);
        let mut memory = ancestor.memory;
        let proposed = self.motion.propose(&self.past, ancestor, &mut memory, &mut stream);
        let scene = self.past.scene;
        let mut log_weights = scene.log_weights(&scene.surface(&proposed.posture), self.past.blocks, self.expected);
        log_weights[TRUNK_GROUP] += proposed.log_ratio;
        *slot = BodyParticle { angles_rad: proposed.angles_rad, ends_m: proposed.posture.ends, memory, log_weights };
    }
}

/// State of the tracker: up to `N` particles, kept in two sets `S` (arrays in firmware, vectors on a host).
///
/// ```
/// use sinew_core::tracker::body::{BodyFrame, BodyTracker, DEFAULT_BODY_OPTIONS};
/// # use sinew_core::pik::guided::GuidedMotion;
/// # use sinew_core::pik::motion::{BodyParticle, BodyScene};
/// # use sinew_core::pik::{goal::LinearExtrapolation, processes::extrapolation::LinearGoals, root::RootProcess};
/// # use sinew_core::skeleton::arm::FOREARM;
/// # use sinew_core::math::Vec3;
/// # use sinew_core::observation::{point_cloud::PointCloud, point_likelihood::PointLikelihood};
/// # use sinew_core::skeleton::{ArmGeometry, Side};
/// # let skeleton = ArmGeometry::new(Side::Left, 0.30, 0.35)?.skeleton()?;
/// # let likelihood = PointLikelihood { std_m: 0.05, outlier_m: 0.15 };
/// # let camera_m = Vec3::new(0.0, 0.0, -2.0);
/// # let scene = BodyScene { skeleton, radii_m: [0.05, 0.04], camera_m, likelihood, self_penetration: None };
/// # let points_of = |pose: &[f32; 4]| {
/// #     let surface = scene.surface(&scene.posture(pose));
/// #     let mut points_m = core::array::from_fn::<Vec3, 32, _>(|i| {
/// #         let bone = &surface.capsules[i % 2].capsule;
/// #         let place_m = bone.start_m + (bone.end_m - bone.start_m) * (i as f32 / 32.0);
/// #         bone.nearest_visible(&scene.camera_m, &(place_m - Vec3::z()))
/// #     });
/// #     let mut cloud = PointCloud::<2>::new();
/// #     let _ = cloud.set(&mut points_m, &scene.camera_m);
/// #     cloud
/// # };
/// # let process = LinearExtrapolation { persistence: 0.5, std_m_per_sqrt_s: 0.3 };
/// # let goals = LinearGoals::new(&[FOREARM], 2, process, 0.05)?;
/// # let (process, root, angle_std_rad_per_sqrt_s) = (&goals, RootProcess::FIXED, [1.0; 4]);
/// # let (solver_steps, pulling_blocks, angle_persistence) = (3, 2, 0.0);
/// # let motion =
/// #     GuidedMotion { process, root, angle_std_rad_per_sqrt_s, angle_persistence, solver_steps, pulling_blocks };
/// # let truth = |frame: usize| [0.5, 0.1, 0.1, 1.0 + 0.05 * frame as f32];
/// # let first = BodyParticle::at(&scene.skeleton, truth(0));
///
/// // A body of two bones, an arm whose elbow bends; thirty particles in arrays, without an allocator.
/// let sets = ([first; 30], [first; 30]);
/// let mut tracker = BodyTracker::<2, 4, 30, _>::new(&first, sets, DEFAULT_BODY_OPTIONS, 1)?;
/// for frame in 1..=10 {
///     let cloud = points_of(&truth(frame));
///     let estimate = tracker.step(&scene, &motion, &BodyFrame { dt_s: 1.0 / 15.0, blocks: cloud.blocks() });
///     let hand_m = scene.posture(&truth(frame)).ends[FOREARM];
///     assert!((estimate.ends_m[FOREARM] - hand_m).norm() < 0.1, "it goes 17 cm in all");
/// }
/// assert!((tracker.weights().iter().sum::<f32>() - 1.0).abs() < 1e-5);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
pub struct BodyTracker<const BONES: usize, const ANGLES: usize, const N: usize, S> {
    pub(super) particles: S,
    pub(super) next: S,
    expected: ExpectedBody<BONES>,
    pub(super) weights: Weights<N>,
    pub(super) ancestors: heapless::Vec<u16, N>,
    options: BodyOptions,
    pub(super) first_m: [Vec3; BONES],
    pub(super) before: BodyParticle<BONES, ANGLES>,
    pub(super) steady: SteadyPose<BONES, ANGLES>,
    pub(super) noise: LimbNoise,
    pub(super) velocity: EstimateVelocity<BONES, ANGLES>,
    pub(super) seed: u64,
    pub(super) frame: u64,
}

impl<const BONES: usize, const ANGLES: usize, const N: usize, S> BodyTracker<BONES, ANGLES, N, S>
where
    S: AsRef<[BodyParticle<BONES, ANGLES>]> + AsMut<[BodyParticle<BONES, ANGLES>]>,
{
    /// A tracker whose particles, as many as `particles` and `next` have room for, all are at `first`.
    ///
    /// # Errors
    /// Both sets have to be of the same size, from 1 to `N`; options finite, the share in [0, 1].
    pub fn new(
        first: &BodyParticle<BONES, ANGLES>,
        (mut particles, next): (S, S),
        options: BodyOptions,
        seed: u64,
    ) -> Result<Self, ParameterError> {
        let count = particles.as_ref().len();
        if next.as_ref().len() != count {
            return Err(ParameterError::new("next", Rule::SameLength { expected: count }));
        }
        let shares = [
            ("least_effective_share", options.least_effective_share),
            ("acceleration_share", options.acceleration_share),
        ];
        for (name, share) in shares {
            if !(0.0..=1.0).contains(&share) {
                return Err(ParameterError::new(name, Rule::Within { low: 0.0, high: 1.0 }));
            }
        }
        for (name, value) in [("tremble_errors", options.tremble_errors), ("tremble_m", options.tremble_m)] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(ParameterError::new(name, Rule::NotNegative));
            }
        }
        options.pace.map(PaceNoise::checked).transpose()?;
        particles.as_mut().fill(*first);
        let mut ancestors = heapless::Vec::new();
        let weights = Weights::uniform(count)?;
        // As many as there are weights, which fit.
        let _ = ancestors.resize(count, 0);
        Ok(Self {
            particles,
            next,
            expected: ExpectedBody::new(Limbs::none()),
            weights,
            ancestors,
            options,
            first_m: first.ends_m,
            before: *first,
            steady: SteadyPose::new(*first),
            noise: LimbNoise::FULL,
            velocity: EstimateVelocity::REST,
            seed,
            frame: 0,
        })
    }

    /// The particles after the last step.
    #[must_use]
    pub fn particles(&self) -> &[BodyParticle<BONES, ANGLES>] {
        self.particles.as_ref()
    }

    /// Their weights, which sum to one; equal after a step limb by limb, which ends with the resampling.
    #[must_use]
    pub fn weights(&self) -> &[f32] {
        self.weights.normalised()
    }

    /// One frame, particle by particle.
    pub fn step<M: BodyMotion<BONES, ANGLES>>(
        &mut self,
        scene: &BodyScene<BONES, ANGLES>,
        motion: &M,
        frame: &BodyFrame<'_>,
    ) -> BodyEstimate<BONES, ANGLES> {
        self.step_with(scene, motion, frame, |advance, particles| {
            for (index, slot) in particles.iter_mut().enumerate() {
                advance.particle(index, slot);
            }
        })
    }

    /// One frame whose particles `advance_all` moves: it has to call [`Advance::particle`] once for each slot, in any order.
    pub fn step_with<M: BodyMotion<BONES, ANGLES>>(
        &mut self,
        scene: &BodyScene<BONES, ANGLES>,
        motion: &M,
        frame: &BodyFrame<'_>,
        advance_all: impl FnOnce(&Advance<'_, M, BONES, ANGLES>, &mut [BodyParticle<BONES, ANGLES>]),
    ) -> BodyEstimate<BONES, ANGLES> {
        let is_first = self.frame == 0;
        self.frame += 1;
        let offset = Stream::new(self.seed, self.frame, RESAMPLING_STREAM).uniform();
        systematic(self.weights.normalised(), offset, &mut self.ancestors);
        // No time, or time that runs back, is the shortest time that still lets particles differ.
        let dt_s = clamp(frame.dt_s, 1.0e-4, 10.0);
        let limbs = Limbs::of(&scene.skeleton);
        let velocity = self.velocity.expected(self.options.acceleration_share, dt_s);
        let expected_rad = self.expected_pose((scene, &limbs), motion.root(), frame.blocks, dt_s);
        if self.options.limb_by_limb {
            self.expected.set_limbs(limbs);
            self.expected.expect(&scene.likelihood, &scene.surface(&scene.posture(&expected_rad)), frame.blocks);
        }
        let advance = Advance {
            motion,
            past: FramePast {
                scene,
                blocks: frame.blocks,
                angle_velocity_per_s: velocity.angles_per_s,
                shared_change: self.shared_change((scene, &limbs), &expected_rad),
                velocity_m_per_s: &velocity.ends_m_per_s,
                noise_share: &self.noise.per_bone(&limbs),
                first_m: &self.first_m,
                dt_s,
                is_first,
            },
            ancestors: &self.ancestors,
            particles: self.particles.as_ref(),
            expected: &self.expected,
            seed: self.seed,
            frame: self.frame,
        };
        advance_all(&advance, self.next.as_mut());
        core::mem::swap(&mut self.particles, &mut self.next);
        self.conclude((scene, &limbs), frame, dt_s)
    }

    /// Where the body is expected: it goes on as it moved, and where the root is aligned that pose is laid onto the points. The root of every
    /// particle sets out from there; limbs are weighed by what they explain beside it.
    fn expected_pose(
        &self,
        (scene, limbs): (&BodyScene<BONES, ANGLES>, &Limbs<BONES>),
        root: &RootProcess,
        blocks: &[PointBlock],
        dt_s: f32,
    ) -> [f32; ANGLES] {
        let velocity_per_s = self.velocity.expected(0.0, dt_s).angles_per_s;
        let root_change = root.expected_change(&velocity_per_s, dt_s);
        let mut expected_rad = self.before.angles_rad;
        for (index, angle) in expected_rad.iter_mut().enumerate() {
            *angle += if index < scene.skeleton.root_coordinates() {
                root_change.get(index).copied().unwrap_or(0.0)
            } else {
                EXPECTED_PERSISTENCE * velocity_per_s[index] * dt_s
            };
        }
        let expected_rad = scene.skeleton.clamp(expected_rad);
        let Some(mut alignment) = self.options.alignment else { return expected_rad };
        alignment.looks_afar &= self.noise.is_any_fast(limbs.count());
        let unseen = core::array::from_fn(|i| self.noise.is_let_loose(limbs.group(scene.skeleton.bone_of_angle(i))));
        alignment.laid(scene, blocks, (&expected_rad, &unseen), dt_s)
    }

    /// What every particle's root changes by, and its trunk where that is laid onto the points.
    fn shared_change(
        &self,
        (scene, limbs): (&BodyScene<BONES, ANGLES>, &Limbs<BONES>),
        expected_rad: &[f32; ANGLES],
    ) -> [Option<f32>; ANGLES] {
        let skeleton = &scene.skeleton;
        let lays_trunk = self.options.alignment.is_some_and(|alignment| alignment.lays_trunk);
        core::array::from_fn(|index| {
            let is_trunk = limbs.group(skeleton.bone_of_angle(index)) == TRUNK_GROUP;
            let is_shared = index < skeleton.root_coordinates() || (lays_trunk && is_trunk);
            is_shared.then(|| expected_rad[index] - self.before.angles_rad[index])
        })
    }

    /// Weights, mean pose, spread and velocities of the new set.
    fn conclude(
        &mut self,
        (scene, limbs): (&BodyScene<BONES, ANGLES>, &Limbs<BONES>),
        frame: &BodyFrame<'_>,
        dt_s: f32,
    ) -> BodyEstimate<BONES, ANGLES> {
        // One group of all bones where whole poses are weighed.
        let weighed_limbs = *self.expected.limbs();
        let mut stream = Stream::new(self.seed, self.frame, LIMB_STREAM);
        let mut angles_rad = [0.0; ANGLES];
        let (mut spread_m, mut standard_error_m) = ([0.0; BONES], [0.0; BONES]);
        let (mut whole, mut effective_sample_size) = (Ok(0.0), f32::INFINITY);
        let mut tempering = 1.0;
        // The trunk comes last: what belongs to the whole pose stays as it was weighed.
        for group in (0..weighed_limbs.count()).rev() {
            tempering = self.weigh(group);
            whole = self.weights.normalise();
            effective_sample_size = min(effective_sample_size, self.weights.effective_sample_size());
            let weighed = (self.particles.as_ref(), self.weights.normalised());
            mean_of_group(&scene.skeleton, weighed, (&weighed_limbs, group), &mut angles_rad);
            spread_of_group(weighed, (&weighed_limbs, group), (&mut spread_m, &mut standard_error_m));
            if weighed_limbs.count() > 1 {
                self.resample_group(&scene.skeleton, (&weighed_limbs, group), &mut stream);
            }
        }
        if weighed_limbs.count() > 1 {
            self.join_groups(scene);
        }
        let posture = scene.posture(&angles_rad);
        let mean = BodyParticle { angles_rad, ends_m: posture.ends, ..self.before };
        let observed = observed(&scene.surface(&posture), limbs, frame.blocks);
        self.velocity.follow(&self.before, &mean, dt_s);
        if let Some(pace) = &self.options.pace {
            self.noise.follow((pace, limbs), &self.velocity.last.ends_m_per_s, (&observed, &scene.radii_m), dt_s);
        }
        let tremble_m = standard_error_m.map(|error_m| self.options.tremble_m + self.options.tremble_errors * error_m);
        let told = *self.steady.tell((scene, limbs), &mean, &tremble_m, dt_s);
        self.before = mean;
        BodyEstimate {
            angles_rad: told.angles_rad,
            ends_m: told.ends_m,
            spread_m,
            observed,
            effective_sample_size,
            log_evidence: whole.unwrap_or(0.0),
            tempering,
            is_degenerate: whole.is_err(),
        }
    }

    /// Sets the log-weights of one group, flattened; gives the exponent.
    fn weigh(&mut self, group: usize) -> f32 {
        let set = |weights: &mut Weights<N>, particles: &S, exponent: f32| {
            for (index, particle) in particles.as_ref().iter().enumerate() {
                let log = particle.log_weights.get(group).copied().unwrap_or(f32::NEG_INFINITY);
                weights.set_log(index, exponent * log);
            }
        };
        set(&mut self.weights, &self.particles, 1.0);
        if !(self.options.least_effective_share > 0.0) {
            return 1.0;
        }
        let count = self.weights.len() as f32;
        let least = self.options.least_effective_share * sqrt(SHARE_PARTICLES * count);
        let exponent = temper(&self.weights, min(least, count));
        set(&mut self.weights, &self.particles, exponent);
        exponent
    }
}
