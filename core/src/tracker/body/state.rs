//! State of the body tracker: how it begins and what it holds between frames.

use super::deadband::Deadband;
use super::options::BodyOptions;
use super::pace::LimbNoise;
use super::rival::Rival;
use super::velocity::EstimateVelocity;
use crate::error::{ParameterError, Rule};
use crate::math::Vec3;
use crate::observation::limb_likelihood::ExpectedBody;
use crate::particle::Weights;
use crate::pik::motion::BodyParticle;
use crate::skeleton::Limbs;

/// State of the tracker: up to `N` particles, kept in two sets `S` (arrays in firmware, vectors on
/// a host).
///
/// ```
/// use sinew_core::pik::example::{arm_points, arm_scene, bending_elbow, guided_arm, hand_goals};
/// use sinew_core::pik::motion::BodyParticle;
/// use sinew_core::skeleton::arm::FOREARM;
/// use sinew_core::tracker::body::{BodyFrame, BodyTracker, DEFAULT_BODY_OPTIONS};
///
/// let (scene, goals) = (arm_scene()?, hand_goals()?);
/// let motion = guided_arm(&goals);
/// let first = BodyParticle::at(&scene.skeleton, bending_elbow(0));
/// // A body of two bones, an arm whose elbow bends; thirty particles in arrays, without an allocator.
/// let sets = ([first; 30], [first; 30]);
/// let mut tracker = BodyTracker::<2, 4, 30, _>::new(&first, sets, DEFAULT_BODY_OPTIONS, 1)?;
/// for frame in 1..=10 {
///     let cloud = arm_points(&scene, &bending_elbow(frame));
///     let estimate = tracker.step(&scene, &motion, &BodyFrame { dt_s: 1.0 / 15.0, blocks: cloud.blocks() });
///     let hand_m = scene.posture(&bending_elbow(frame)).ends[FOREARM];
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
    pub(super) rival: Option<Rival<BONES, ANGLES>>,
    pub(super) seed: u64,
    pub(super) frame: u64,
}

impl<const BONES: usize, const ANGLES: usize, const N: usize, S> BodyTracker<BONES, ANGLES, N, S>
where
    S: AsRef<[BodyParticle<BONES, ANGLES>]> + AsMut<[BodyParticle<BONES, ANGLES>]>,
{
    /// A tracker whose particles, as many as `particles` and `next` have room for, all are at
    /// `first`.
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
            rival: None,
            seed,
            frame: 0,
        })
    }

    /// The particles after the last step.
    #[must_use]
    pub fn particles(&self) -> &[BodyParticle<BONES, ANGLES>] {
        self.particles.as_ref()
    }

    /// The mean pose of the last step, PIK (30), or what the motion model refines it to, before the
    /// deadband; at first the pose that the tracker begins with.
    ///
    /// ```
    /// use sinew_core::pik::example::{arm_points, arm_scene, bending_elbow, guided_arm, hand_goals};
    /// use sinew_core::pik::motion::BodyParticle;
    /// use sinew_core::tracker::body::{BodyFrame, BodyTracker, DEFAULT_BODY_OPTIONS};
    ///
    /// let (scene, goals) = (arm_scene()?, hand_goals()?);
    /// let first = BodyParticle::at(&scene.skeleton, bending_elbow(0));
    /// let sets = ([first; 30], [first; 30]);
    /// let mut tracker = BodyTracker::<2, 4, 30, _>::new(&first, sets, DEFAULT_BODY_OPTIONS, 1)?;
    /// let cloud = arm_points(&scene, &bending_elbow(1));
    /// let frame = BodyFrame { dt_s: 1.0 / 15.0, blocks: cloud.blocks() };
    /// let estimate = tracker.step(&scene, &guided_arm(&goals), &frame);
    /// // The default options have no deadband.
    /// assert_eq!(tracker.mean().angles_rad, estimate.angles_rad);
    /// # Ok::<(), sinew_core::error::ParameterError>(())
    /// ```
    #[must_use]
    pub fn mean(&self) -> &BodyParticle<BONES, ANGLES> {
        &self.before
    }

    /// The particles' weights, which sum to one; equal after a step limb by limb, which ends with
    /// resampling.
    #[must_use]
    pub fn weights(&self) -> &[f32] {
        self.weights.normalised()
    }
}
