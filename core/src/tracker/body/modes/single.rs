//! The leading mode alone, without rivals and draws: for firmware.
//!
//! It gives the numbers of [`super::state::ModeTracker`] with one mode and no draws, in 1.4 KB and
//! without lists of starts on the stack.

use super::super::deadband::Deadband;
use super::super::estimate::BodyEstimate;
use super::super::frame::BodyFrame;
use super::super::observed::observed;
use super::super::pace::LimbNoise;
use super::super::saved::{NUMBER, places};
use super::super::step::frame_time_s;
use super::super::velocity::EstimateVelocity;
use super::options::ModeOptions;
use super::state::BodyMode;
use super::step::ModeAdvance;
use crate::error::ParameterError;
use crate::kinematics::solver_memory::SolverMemory;
use crate::math::Vec3;
use crate::observation::point_cloud::PointBlock;
use crate::pik::goal::GoalProcess;
use crate::pik::guided::GuidedMotion;
use crate::pik::motion::{BodyParticle, BodyScene};
use crate::saved_state::{SavedState, StateVisitor};
use crate::skeleton::Limbs;

/// State of the tracker.
///
/// ```
/// use sinew_core::pik::example::{arm_points, arm_scene, bending_elbow, guided_arm, hand_goals};
/// use sinew_core::pik::motion::BodyParticle;
/// use sinew_core::skeleton::arm::FOREARM;
/// use sinew_core::tracker::body::BodyFrame;
/// use sinew_core::tracker::body::modes::{DEFAULT_MODE_OPTIONS, SingleModeTracker};
///
/// let (scene, goals) = (arm_scene()?, hand_goals()?);
/// let motion = guided_arm(&goals);
/// let first = BodyParticle::at(&scene.skeleton, bending_elbow(0));
/// let mut tracker = SingleModeTracker::<2, 4>::new(&first, DEFAULT_MODE_OPTIONS)?;
/// for frame in 1..=10 {
///     let cloud = arm_points(&scene, &bending_elbow(frame));
///     let estimate = tracker.step(&scene, &motion, &BodyFrame { dt_s: 1.0 / 15.0, blocks: cloud.blocks() });
///     let hand_m = scene.posture(&bending_elbow(frame)).ends[FOREARM];
///     assert!((estimate.ends_m[FOREARM] - hand_m).norm() < 0.05, "it goes 17 cm in all");
/// }
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
pub struct SingleModeTracker<const BONES: usize, const ANGLES: usize> {
    mode: BodyMode<BONES, ANGLES>,
    options: ModeOptions,
    first_m: [Vec3; BONES],
    deadband: Deadband<BONES, ANGLES>,
    noise: LimbNoise,
    frame: u64,
}

impl<const BONES: usize, const ANGLES: usize> SingleModeTracker<BONES, ANGLES> {
    /// A tracker of a body at `first`. Of the options rivals and draws are not read.
    ///
    /// # Errors
    /// Names the first option that is out of its range.
    pub fn new(first: &BodyParticle<BONES, ANGLES>, options: ModeOptions) -> Result<Self, ParameterError> {
        options.check()?;
        Ok(Self {
            mode: BodyMode {
                pose: *first,
                spread_m: [0.0; BONES],
                log_weight: 0.0,
                log_density: 0.0,
                velocity: EstimateVelocity::REST,
                is_rival: false,
                drawn: None,
            },
            options,
            first_m: first.ends_m,
            deadband: Deadband::new(*first),
            noise: LimbNoise::FULL,
            frame: 0,
        })
    }

    /// Its pose after the last frame, before the deadband.
    #[must_use]
    pub const fn pose(&self) -> &BodyParticle<BONES, ANGLES> {
        &self.mode.pose
    }

    /// One frame.
    pub fn step<P: GoalProcess<BONES>>(
        &mut self,
        scene: &BodyScene<BONES, ANGLES>,
        motion: &GuidedMotion<'_, P, ANGLES>,
        frame: &BodyFrame<'_>,
    ) -> BodyEstimate<BONES, ANGLES> {
        self.step_within(scene, motion, frame, &mut SolverMemory::new())
    }

    /// As [`Self::step`], with the solver in memory of the caller; there it lies on the stack.
    pub fn step_within<P: GoalProcess<BONES>>(
        &mut self,
        scene: &BodyScene<BONES, ANGLES>,
        motion: &GuidedMotion<'_, P, ANGLES>,
        frame: &BodyFrame<'_>,
        memory: &mut SolverMemory<BONES, ANGLES>,
    ) -> BodyEstimate<BONES, ANGLES> {
        self.frame += 1;
        let dt_s = frame_time_s(frame);
        let is_usable = frame.blocks.iter().all(PointBlock::is_usable);
        let blocks = if is_usable { frame.blocks } else { &[] };
        let limbs = Limbs::of(&scene.skeleton);
        let advance = ModeAdvance {
            motion,
            scene,
            limbs: &limbs,
            blocks,
            noise_share: self.noise.per_bone(&limbs),
            first_m: &self.first_m,
            dt_s,
            evidence_share: self.options.evidence_share,
            // Nothing is drawn.
            seed: 0,
            frame: self.frame,
        };
        climb(&advance, &mut self.mode, memory);
        self.mode.log_weight = 0.0;
        let observed = self.observed((scene, &limbs), blocks);
        self.conclude((scene, &limbs), observed, dt_s, memory)
    }

    // Not inlined: the surface leaves the stack before the conclusion needs it.
    #[inline(never)]
    fn observed(
        &self,
        (scene, limbs): (&BodyScene<BONES, ANGLES>, &Limbs<BONES>),
        blocks: &[PointBlock],
    ) -> [bool; BONES] {
        observed(&scene.surface(&scene.posture(&self.mode.pose.angles_rad)), limbs, blocks)
    }

    // Not inlined: climb and conclusion need their stack one after the other.
    #[inline(never)]
    fn conclude(
        &mut self,
        (scene, limbs): (&BodyScene<BONES, ANGLES>, &Limbs<BONES>),
        observed: [bool; BONES],
        dt_s: f32,
        memory: &mut SolverMemory<BONES, ANGLES>,
    ) -> BodyEstimate<BONES, ANGLES> {
        let mode = &self.mode;
        if let Some(pace) = &self.options.pace {
            self.noise.follow((pace, limbs), &mode.velocity.last.ends_m_per_s, (&observed, &scene.radii_m), dt_s);
        }
        let jitter_std_m = [self.options.jitter_std_m; BONES];
        let reported = self.deadband.filter_within((scene, limbs), &mode.pose, &jitter_std_m, dt_s, memory);
        BodyEstimate {
            angles_rad: reported.angles_rad,
            ends_m: reported.ends_m,
            spread_m: mode.spread_m,
            observed,
            effective_sample_size: 1.0,
            log_evidence: mode.log_density,
            tempering: self.options.evidence_share,
            is_degenerate: false,
        }
    }
}

#[inline(never)]
fn climb<P: GoalProcess<BONES>, const BONES: usize, const ANGLES: usize>(
    advance: &ModeAdvance<'_, P, BONES, ANGLES>,
    mode: &mut BodyMode<BONES, ANGLES>,
    memory: &mut SolverMemory<BONES, ANGLES>,
) {
    advance.climb_within(mode, memory);
}

impl<const BONES: usize, const ANGLES: usize> SavedState for SingleModeTracker<BONES, ANGLES> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.long(&mut self.frame);
        self.mode.visit(visitor);
        places(&mut self.first_m, visitor);
        self.deadband.reported.visit(visitor);
        places(&mut self.deadband.off_m, visitor);
        visitor.reals(&mut self.noise.shares, &NUMBER);
        for is_unseen in &mut self.noise.is_unseen {
            visitor.flag(is_unseen);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::options::DEFAULT_MODE_OPTIONS;
    use super::super::state::ModeTracker;
    use super::*;
    use crate::pik::example::{arm_points, arm_scene, bending_elbow, guided_arm, hand_goals};
    use crate::saved_state::{StateKind, restore, save};

    /// Also over frames without points, and from a saved state.
    #[test]
    fn it_gives_the_numbers_of_the_tracker_by_modes_with_one() {
        let (scene, goals) = (arm_scene().unwrap(), hand_goals().unwrap());
        let motion = guided_arm(&goals);
        let first = BodyParticle::at(&scene.skeleton, bending_elbow(0));
        let options = ModeOptions { max_modes: 1, draws: 0, jitter_std_m: 0.0075, ..DEFAULT_MODE_OPTIONS };
        let mut modes = ModeTracker::<2, 4>::new(&first, options, 1).unwrap();
        let mut single = SingleModeTracker::<2, 4>::new(&first, options).unwrap();
        for frame in 1..=20 {
            let cloud = arm_points(&scene, &bending_elbow(frame));
            let blocks = if (8..11).contains(&frame) { &[] } else { cloud.blocks() };
            let seen = BodyFrame { dt_s: 1.0 / 15.0, blocks };
            assert_eq!(single.step(&scene, &motion, &seen), modes.step(&scene, &motion, &seen), "frame {frame}");
            if frame == 12 {
                let mut bytes = [0; 2048];
                let length = save(StateKind::Body, 7, &mut single, &mut bytes).unwrap();
                single = SingleModeTracker::new(&first, options).unwrap();
                restore(StateKind::Body, 7, &mut single, &bytes[..length]).unwrap();
            }
        }
        assert!(SingleModeTracker::<2, 4>::new(&first, ModeOptions { draws: 4, ..options }).is_err());
    }
}
