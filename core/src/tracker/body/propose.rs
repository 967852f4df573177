//! One particle of the new set: an ancestor moved on and weighed.

use crate::observation::limb_likelihood::ExpectedBody;
use crate::pik::motion::{BodyMotion, BodyParticle, FramePast};
use crate::random::Stream;
use crate::skeleton::limbs::TRUNK_GROUP;

/// What is needed to move and weigh any particle of a frame, in any order, on any thread.
///
/// ```
/// use sinew_core::pik::example::{arm_points, arm_scene, bending_elbow, guided_arm, hand_goals};
/// use sinew_core::pik::motion::BodyParticle;
/// use sinew_core::tracker::body::{BodyFrame, BodyTracker, DEFAULT_BODY_OPTIONS};
///
/// let (scene, goals) = (arm_scene()?, hand_goals()?);
/// let motion = guided_arm(&goals);
/// let first = BodyParticle::at(&scene.skeleton, bending_elbow(0));
/// let new =
///     || BodyTracker::<2, 4, 30, _>::new(&first, ([first; 30], [first; 30]), DEFAULT_BODY_OPTIONS, 1);
/// // Particles in any order, or on any thread: each has its own random numbers, so the answer is the same to the bit.
/// let cloud = arm_points(&scene, &bending_elbow(1));
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
    pub(super) motion: &'a M,
    pub(super) past: FramePast<'a, BONES, ANGLES>,
    pub(super) ancestors: &'a [u16],
    pub(super) particles: &'a [BodyParticle<BONES, ANGLES>],
    pub(super) expected: &'a ExpectedBody<BONES>,
    pub(super) seed: u64,
    pub(super) frame: u64,
}

impl<M: BodyMotion<BONES, ANGLES>, const BONES: usize, const ANGLES: usize> Advance<'_, M, BONES, ANGLES> {
    /// Makes particle `index` of the new set, with its log-weights: that of the whole pose, then of
    /// each limb.
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
