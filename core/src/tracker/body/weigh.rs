//! Weights of one group of bones, flattened where they would leave too few effective particles.

use super::state::BodyTracker;
use super::tempering::temper;
use crate::math::{min, sqrt};
use crate::particle::Weights;
use crate::pik::motion::BodyParticle;

/// Particles that the least effective share is meant for. Chosen: a round number.
const SHARE_PARTICLES: f32 = 100.0;

impl<const BONES: usize, const ANGLES: usize, const N: usize, S> BodyTracker<BONES, ANGLES, N, S>
where
    S: AsRef<[BodyParticle<BONES, ANGLES>]> + AsMut<[BodyParticle<BONES, ANGLES>]>,
{
    /// Sets the log-weights of one group, flattened; gives the exponent.
    pub(super) fn weigh(&mut self, group: usize) -> f32 {
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
