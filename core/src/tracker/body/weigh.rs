//! Weights of one group of bones, flattened where they would leave too few effective particles.

use super::state::BodyTracker;
use super::tempering::temper;
use crate::math::{min, sqrt};
use crate::particle::Degenerate;
use crate::pik::motion::BodyParticle;

/// Particles that the least effective share is meant for. Chosen: a round number.
const SHARE_PARTICLES: f32 = 100.0;

impl<const BONES: usize, const ANGLES: usize, const N: usize, S> BodyTracker<BONES, ANGLES, N, S>
where
    S: AsRef<[BodyParticle<BONES, ANGLES>]> + AsMut<[BodyParticle<BONES, ANGLES>]>,
{
    /// Weighs one group and normalises, flattened; gives ln of the mean weight before it is
    /// flattened, and the exponent.
    pub(super) fn weigh(&mut self, group: usize) -> (Result<f32, Degenerate>, f32) {
        self.set_weights(group, 1.0);
        let log_mean = self.weights.normalise();
        let least_share = self.options.least_effective_share;
        if !(least_share > 0.0) || log_mean.is_err() {
            return (log_mean, 1.0);
        }
        let count = self.weights.len() as f32;
        let exponent = temper(&self.weights, min(least_share * sqrt(SHARE_PARTICLES * count), count));
        if exponent < 1.0 {
            self.set_weights(group, exponent);
            // One weight was above zero, so the greatest of these is too.
            let _ = self.weights.normalise();
        }
        (log_mean, exponent)
    }

    fn set_weights(&mut self, group: usize, exponent: f32) {
        for (index, particle) in self.particles.as_ref().iter().enumerate() {
            let log = particle.log_weights.get(group).copied().unwrap_or(f32::NEG_INFINITY);
            self.weights.set_log(index, exponent * log);
        }
    }
}
