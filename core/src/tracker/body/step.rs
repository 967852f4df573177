//! The body tracker's step: resample, move on, weigh, estimate (PIK paper, sections 5.1 and 6).

use super::estimate::{BodyEstimate, mean_of_group, spread_of_group};
use super::frame::BodyFrame;
use super::observed::observed;
use super::propose::Advance;
use super::state::BodyTracker;
use crate::math::{clamp, min};
use crate::observation::point_cloud::PointBlock;
use crate::particle::resampling::systematic;
use crate::pik::motion::{BodyMotion, BodyParticle, BodyScene, FramePast};
use crate::random::Stream;
use crate::skeleton::Limbs;

/// Stream of the resampling; particles have their own index.
const RESAMPLING_STREAM: u32 = u32::MAX;
/// Stream of what is drawn limb by limb.
const LIMB_STREAM: u32 = u32::MAX - 1;
/// Shortest time between two frames, seconds: it still lets particles differ, and says nothing of
/// their velocity. Chosen: no camera is as fast.
pub(super) const MIN_DT_S: f32 = 1.0e-4;
/// Longest time between two frames, seconds. Chosen: the pose is unknown after it.
const MAX_DT_S: f32 = 10.0;
/// Share of the mean's standard error that is left in a refined pose. Chosen: the reported pose
/// moves as far as the truth on seven motions of the tuning; with 0.25 to 0.5 by 3 % more or less.
const REFINED_ERROR_SHARE: f32 = 0.33;

/// Time since the frame before within its bounds, seconds.
pub(super) fn frame_time_s(frame: &BodyFrame<'_>) -> f32 {
    if frame.dt_s.is_finite() { clamp(frame.dt_s, MIN_DT_S, MAX_DT_S) } else { MIN_DT_S }
}

impl<const BONES: usize, const ANGLES: usize, const N: usize, S> BodyTracker<BONES, ANGLES, N, S>
where
    S: AsRef<[BodyParticle<BONES, ANGLES>]> + AsMut<[BodyParticle<BONES, ANGLES>]>,
{
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

    /// One frame whose particles `advance_all` moves: it has to call [`Advance::particle`] once for
    /// each slot, in any order.
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
        let dt_s = frame_time_s(frame);
        let is_usable = frame.blocks.iter().all(PointBlock::is_usable);
        let frame = &BodyFrame { dt_s, blocks: if is_usable { frame.blocks } else { &[] } };
        let limbs = Limbs::of(&scene.skeleton);
        let velocity = self.velocity.expected(self.options.acceleration_share, dt_s);
        let expected_rad = self.expected_pose((scene, &limbs), motion.root(), frame.blocks, dt_s);
        if self.options.limb_by_limb {
            self.expected.set_limbs(limbs);
            self.expected.expect(&scene.likelihood, &scene.surface(&scene.posture(&expected_rad)), frame.blocks);
        }
        let (noise_share, first_m) = (self.noise.per_bone(&limbs), self.first_m);
        let past = FramePast {
            scene,
            blocks: frame.blocks,
            angle_velocity_per_s: velocity.angles_per_s,
            shared_change: self.shared_change((scene, &limbs), &expected_rad),
            velocity_m_per_s: &velocity.ends_m_per_s,
            noise_share: &noise_share,
            first_m: &first_m,
            dt_s,
            is_first,
        };
        let advance = Advance {
            motion,
            past,
            ancestors: &self.ancestors,
            particles: self.particles.as_ref(),
            expected: &self.expected,
            seed: self.seed,
            frame: self.frame,
        };
        advance_all(&advance, self.next.as_mut());
        core::mem::swap(&mut self.particles, &mut self.next);
        self.conclude(motion, &past, &limbs)
    }

    /// Weights, pose, spread and velocities of the new set.
    fn conclude<M: BodyMotion<BONES, ANGLES>>(
        &mut self,
        motion: &M,
        past: &FramePast<'_, BONES, ANGLES>,
        limbs: &Limbs<BONES>,
    ) -> BodyEstimate<BONES, ANGLES> {
        let &FramePast { scene, blocks, dt_s, .. } = past;
        // One group of all bones where whole poses are weighed.
        let weighed_limbs = *self.expected.limbs();
        let mut stream = Stream::new(self.seed, self.frame, LIMB_STREAM);
        let mut angles_rad = [0.0; ANGLES];
        let (mut spread_m, mut standard_error_m) = ([0.0; BONES], [0.0; BONES]);
        let (mut whole, mut effective_sample_size) = (Ok(0.0), f32::INFINITY);
        let mut tempering = 1.0;
        // The trunk comes last: what belongs to the whole pose stays as it was weighed.
        for group in (0..weighed_limbs.count()).rev() {
            (whole, tempering) = self.weigh(group);
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
        let led = self.lead(motion, past, limbs, &angles_rad);
        if let Some((led_rad, _)) = led {
            angles_rad = led_rad;
            standard_error_m = standard_error_m.map(|error_m| REFINED_ERROR_SHARE * error_m);
        }
        let posture = scene.posture(&angles_rad);
        let mean = BodyParticle { angles_rad, ends_m: posture.ends, ..self.before };
        let observed = observed(&scene.surface(&posture), limbs, blocks);
        if dt_s > MIN_DT_S && !led.is_some_and(|(_, is_rival)| is_rival) {
            self.velocity.follow(&self.before, &mean, dt_s);
        }
        if let Some(pace) = &self.options.pace {
            self.noise.follow((pace, limbs), &self.velocity.last.ends_m_per_s, (&observed, &scene.radii_m), dt_s);
        }
        let jitter_std_m =
            standard_error_m.map(|error_m| self.options.jitter_std_m + self.options.jitter_std_errors * error_m);
        let reported = *self.deadband.filter((scene, limbs), &mean, &jitter_std_m, dt_s);
        self.before = mean;
        BodyEstimate {
            angles_rad: reported.angles_rad,
            ends_m: reported.ends_m,
            spread_m,
            observed,
            effective_sample_size,
            log_evidence: whole.unwrap_or(0.0),
            tempering,
            is_degenerate: whole.is_err(),
        }
    }
}
