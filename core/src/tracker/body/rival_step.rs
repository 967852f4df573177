//! A body whose legs are exchanged, followed beside the particles until it explains the points
//! better, or much worse.

use super::exchange::{exchange, pairs};
use super::modes::is_alike;
use super::rival::Rival;
use super::state::BodyTracker;
use super::step::MIN_DT_S;
use super::velocity::EstimateVelocity;
use crate::pik::motion::{BodyMotion, BodyParticle, Climbed, FramePast};
use crate::skeleton::Limbs;

/// A rival lighter by so many switch costs is given up. Chosen: as modes are.
const GIVEN_UP_COSTS: f32 = 3.0;

impl<const BONES: usize, const ANGLES: usize, const N: usize, S> BodyTracker<BONES, ANGLES, N, S>
where
    S: AsRef<[BodyParticle<BONES, ANGLES>]> + AsMut<[BodyParticle<BONES, ANGLES>]>,
{
    /// The rival that is followed: its pose, and the log of its weight over that of the estimate.
    #[must_use]
    pub fn rival(&self) -> Option<(&BodyParticle<BONES, ANGLES>, f32)> {
        self.rival.as_ref().map(|rival| (&rival.pose, rival.log_weight))
    }

    /// The pose that is reported in place of the particles' mean, and whether it is the rival's;
    /// the tracker's velocity is the rival's then. `None` of a model that reports the mean.
    pub(super) fn lead<M: BodyMotion<BONES, ANGLES>>(
        &mut self,
        motion: &M,
        past: &FramePast<'_, BONES, ANGLES>,
        limbs: &Limbs<BONES>,
        mean_rad: &[f32; ANGLES],
    ) -> Option<([f32; ANGLES], bool)> {
        let climbed = motion.climb(past, &self.before, Some(mean_rad))?;
        if past.blocks.is_empty() || !(past.dt_s > MIN_DT_S) {
            // Its past would have a gap.
            self.rival = None;
            return Some((climbed.angles_rad, false));
        }
        let rival_rad = self.judge_rival(motion, past, limbs, &climbed);
        Some(rival_rad.map_or((climbed.angles_rad, false), |rival_rad| (rival_rad, true)))
    }

    /// Follows the rival beside `leader`, what the particles' mean climbed to. One that has gained
    /// more than it cost to begin leads (a cumulative sum test, Page 1954): all particles are put
    /// at its pose, which is returned, and the leader becomes the rival.
    // Not inlined: the solver's memory is not that of the weights.
    #[inline(never)]
    fn judge_rival<M: BodyMotion<BONES, ANGLES>>(
        &mut self,
        motion: &M,
        past: &FramePast<'_, BONES, ANGLES>,
        limbs: &Limbs<BONES>,
        leader: &Climbed<ANGLES>,
    ) -> Option<[f32; ANGLES]> {
        let options = self.options.rival?;
        let led = self.as_rival(past, (self.before, self.velocity), leader, -options.switch_cost);
        let mut rival = self.rival.take().or_else(|| self.exchanged_legs((past, limbs), options.switch_cost))?;
        let velocity = rival.velocity.expected(self.options.acceleration_share, past.dt_s);
        let own = FramePast {
            angle_velocity_per_s: velocity.angles_per_s,
            velocity_m_per_s: &velocity.ends_m_per_s,
            ..*past
        };
        let climbed = motion.climb(&own, &rival.pose, None)?;
        let gain = options.evidence_share * (climbed.log_density - leader.log_density);
        rival = self.as_rival(past, (rival.pose, rival.velocity), &climbed, rival.log_weight + gain);
        if !(rival.log_weight > 0.0) {
            let is_given_up = !(rival.log_weight > -GIVEN_UP_COSTS * options.switch_cost);
            self.rival = Some(rival).filter(|_| !is_given_up && !is_alike(&rival.pose.ends_m, &led.pose.ends_m));
            return None;
        }
        for particle in self.particles.as_mut() {
            *particle = BodyParticle { log_weights: particle.log_weights, ..rival.pose };
        }
        (self.velocity, self.rival) = (rival.velocity, Some(led));
        Some(rival.pose.angles_rad)
    }

    /// The estimate before with its legs exchanged; none of a body without legs, or whose legs are
    /// alike.
    fn exchanged_legs(
        &self,
        (past, limbs): (&FramePast<'_, BONES, ANGLES>, &Limbs<BONES>),
        switch_cost: f32,
    ) -> Option<Rival<BONES, ANGLES>> {
        let skeleton = &past.scene.skeleton;
        let [_, legs] = pairs(skeleton, limbs)[..] else { return None };
        let (mut pose, mut velocity) = (self.before, self.velocity);
        exchange((skeleton, limbs), &mut pose, &mut velocity, legs);
        let is_other = !is_alike(&pose.ends_m, &self.before.ends_m);
        is_other.then_some(Rival { pose, velocity, log_weight: -switch_cost })
    }

    /// Who climbed from `pose`.
    fn as_rival(
        &self,
        past: &FramePast<'_, BONES, ANGLES>,
        (before, mut velocity): (BodyParticle<BONES, ANGLES>, EstimateVelocity<BONES, ANGLES>),
        climbed: &Climbed<ANGLES>,
        log_weight: f32,
    ) -> Rival<BONES, ANGLES> {
        let mut pose = BodyParticle { angles_rad: climbed.angles_rad, ..before };
        pose.reshape(&past.scene.skeleton);
        velocity.follow(&before, &pose, past.dt_s);
        Rival { pose, velocity, log_weight }
    }
}
