//! State of the tracker by modes: how it begins and what it holds between frames.

use super::super::deadband::Deadband;
use super::super::pace::LimbNoise;
use super::super::velocity::EstimateVelocity;
use super::options::{MAX_MODES, ModeOptions};
use crate::error::ParameterError;
use crate::math::Vec3;
use crate::pik::motion::BodyParticle;
use crate::skeleton::Skeleton;
use heapless::Vec;

/// One explanation of a body: the mode of its density, and how it moves.
///
/// ```
/// use sinew_core::pik::example::{arm_scene, bending_elbow};
/// use sinew_core::pik::motion::BodyParticle;
/// use sinew_core::tracker::body::modes::{DEFAULT_MODE_OPTIONS, ModeTracker};
///
/// let scene = arm_scene()?;
/// let first = BodyParticle::at(&scene.skeleton, bending_elbow(0));
/// let tracker = ModeTracker::<2, 4>::new(&first, DEFAULT_MODE_OPTIONS, 1)?;
/// // At first there is one explanation, that of the first pose, and nothing to hold against it.
/// assert_eq!(tracker.modes().len(), 1);
/// assert_eq!((tracker.modes()[0].pose, tracker.modes()[0].log_weight), (first, 0.0));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyMode<const BONES: usize, const ANGLES: usize> {
    /// Its pose.
    pub pose: BodyParticle<BONES, ANGLES>,
    /// Standard deviation of each bone's end by the Laplace expansion PIK (22), metres (root of the
    /// summed variances).
    pub spread_m: [f32; BONES],
    /// Log evidence of all frames since it began, over that of the leading mode; zero of that one.
    pub log_weight: f32,
    /// Log density of the last frame at the pose; zero before the first one.
    pub(super) log_density: f32,
    pub(in super::super) velocity: EstimateVelocity<BONES, ANGLES>,
    /// Whether it explains the body in another way than the leading mode does.
    pub(super) is_rival: bool,
    /// The limb whose pose is drawn before the climb, and the stream that draws it.
    pub(super) drawn: Option<(usize, u32)>,
}

/// State of the tracker.
///
/// ```
/// use sinew_core::pik::example::{arm_points, arm_scene, bending_elbow, guided_arm, hand_goals};
/// use sinew_core::pik::motion::BodyParticle;
/// use sinew_core::skeleton::arm::FOREARM;
/// use sinew_core::tracker::body::BodyFrame;
/// use sinew_core::tracker::body::modes::{DEFAULT_MODE_OPTIONS, ModeTracker};
///
/// let (scene, goals) = (arm_scene()?, hand_goals()?);
/// let motion = guided_arm(&goals);
/// let first = BodyParticle::at(&scene.skeleton, bending_elbow(0));
/// let mut tracker = ModeTracker::<2, 4>::new(&first, DEFAULT_MODE_OPTIONS, 1)?;
/// for frame in 1..=10 {
///     let cloud = arm_points(&scene, &bending_elbow(frame));
///     let estimate = tracker.step(&scene, &motion, &BodyFrame { dt_s: 1.0 / 15.0, blocks: cloud.blocks() });
///     let hand_m = scene.posture(&bending_elbow(frame)).ends[FOREARM];
///     assert!((estimate.ends_m[FOREARM] - hand_m).norm() < 0.05, "it goes 17 cm in all");
/// }
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
pub struct ModeTracker<const BONES: usize, const ANGLES: usize> {
    pub(super) modes: Vec<BodyMode<BONES, ANGLES>, MAX_MODES>,
    pub(super) options: ModeOptions,
    pub(super) first_m: [Vec3; BONES],
    pub(super) deadband: Deadband<BONES, ANGLES>,
    pub(super) noise: LimbNoise,
    pub(super) seed: u64,
    pub(super) frame: u64,
}

impl<const BONES: usize, const ANGLES: usize> ModeTracker<BONES, ANGLES> {
    /// A tracker of a body at `first`; `seed` draws the poses that limbs are begun anew from.
    ///
    /// # Errors
    /// Names the first option that is out of its range.
    pub fn new(first: &BodyParticle<BONES, ANGLES>, options: ModeOptions, seed: u64) -> Result<Self, ParameterError> {
        options.check()?;
        let mode = BodyMode {
            pose: *first,
            spread_m: [0.0; BONES],
            log_weight: 0.0,
            log_density: 0.0,
            velocity: EstimateVelocity::REST,
            is_rival: false,
            drawn: None,
        };
        let mut modes = Vec::new();
        // There is room for the first.
        let _ = modes.push(mode);
        let (deadband, noise) = (Deadband::new(*first), LimbNoise::FULL);
        Ok(Self { modes, options, first_m: first.ends_m, deadband, noise, seed, frame: 0 })
    }

    /// The modes after the last step, the leading one first, then by their weight.
    #[must_use]
    pub fn modes(&self) -> &[BodyMode<BONES, ANGLES>] {
        &self.modes
    }

    /// Goes on with the same poses of a body with the lengths of `skeleton`. The next step has to
    /// be given a scene with it.
    pub fn reshape(&mut self, skeleton: &Skeleton<BONES, ANGLES>) {
        self.modes.iter_mut().for_each(|mode| mode.pose.reshape(skeleton));
        self.deadband.reported.reshape(skeleton);
    }
}
