//! State of the body tracker: how it begins and what it holds between frames.

use super::deadband::Deadband;
use super::options::BodyOptions;
use super::pace::LimbNoise;
use super::velocity::EstimateVelocity;
use crate::error::{ParameterError, Rule};
use crate::math::Vec3;
use crate::observation::limb_likelihood::ExpectedBody;
use crate::particle::Weights;
use crate::pik::motion::BodyParticle;
use crate::skeleton::Limbs;

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
    pub(super) expected: ExpectedBody<BONES>,
    pub(super) weights: Weights<N>,
    pub(super) ancestors: heapless::Vec<u16, N>,
    pub(super) options: BodyOptions,
    pub(super) first_m: [Vec3; BONES],
    pub(super) before: BodyParticle<BONES, ANGLES>,
    pub(super) deadband: Deadband<BONES, ANGLES>,
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
        options.check()?;
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
            deadband: Deadband::new(*first),
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
}
