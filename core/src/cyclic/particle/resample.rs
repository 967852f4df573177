//! Systematic resampling over chunks of particles, each by itself. Where a chunk's part of the next
//! generation begins follows from the weights of the chunks before it.

use crate::cyclic::particle::propose::CyclicParticle;
use crate::cyclic::particle::weights::WeightShare;

/// A comb of `count` equidistant teeth over the sum of all weights: each tooth takes the particle
/// that it hits.
///
/// ```
/// use sinew_core::cyclic::particle::propose::CyclicParticle;
/// use sinew_core::cyclic::particle::{resample::Comb, weights::WeightShare};
///
/// // Three particles with weights 1, 1/2 and 1/2; the next generation has four.
/// let particles = [0.1, 0.2, 0.3].map(|angle_rad| CyclicParticle {
///     angles_rad: [angle_rad],
///     velocities: [0.0],
///     cycle_position: 0.0,
///     cycle_velocity: 0.0,
/// });
/// let all = WeightShare { greatest_log_weight: 0.0, weight: 2.0 };
/// let comb = Comb::new(all, 0.3, 4);
/// let mut next = [particles[0]; 4];
/// for teeth in comb.teeth(&[all]) {
///     comb.choose(&particles, &[1.0, 0.5, 0.5], &teeth, &mut next);
/// }
/// assert_eq!(next.map(|particle| particle.angles_rad[0]), [0.1, 0.1, 0.2, 0.3]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Comb {
    all: WeightShare,
    spacing: f32,
    offset: f32,
    count: usize,
}

/// The teeth that hit one chunk of particles.
///
/// ```
/// use sinew_core::cyclic::particle::{resample::{ChunkTeeth, Comb}, weights::WeightShare};
///
/// // Two chunks of which the first weighs three times as much gets three quarters of 400 new particles; each may be
/// // resampled by a thread of its own.
/// let share = |weight| WeightShare { greatest_log_weight: 0.0, weight };
/// let comb = Comb::new(share(80.0), 0.5, 400);
/// let mut ends = [0; 2];
/// for (end, ChunkTeeth { first, count, .. }) in ends.iter_mut().zip(comb.teeth(&[share(60.0), share(20.0)])) {
///     *end = first + count;
/// }
/// assert_eq!(ends, [300, 400]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChunkTeeth {
    /// Number of the first tooth.
    pub first: usize,
    /// Number of teeth.
    pub count: usize,
    /// Sum of all weights before the chunk.
    below: f32,
    /// Factor of the chunk's weights relative to all.
    scale: f32,
}

impl Comb {
    /// A comb over the weights of `all` particles, moved by `offset` in [0, 1) of the spacing.
    #[must_use]
    pub fn new(all: WeightShare, offset: f32, count: usize) -> Self {
        Self { all, spacing: all.weight / count as f32, offset, count }
    }

    /// Number of teeth below the running sum `sum`.
    fn teeth_below(&self, sum: f32) -> usize {
        let teeth = sum / self.spacing - self.offset;
        let whole = teeth as usize;
        (if (whole as f32) < teeth { whole + 1 } else { whole }).min(self.count)
    }

    /// The teeth of each chunk, given the chunks' shares in their order: all teeth, none twice.
    pub fn teeth<'a>(&'a self, shares: &'a [WeightShare]) -> impl Iterator<Item = ChunkTeeth> + 'a {
        let (mut below, mut first) = (0.0, 0);
        shares.iter().enumerate().map(move |(chunk, share)| {
            let scale = share.scale(self.all.greatest_log_weight);
            let above = below + scale * share.weight;
            let end = if chunk + 1 == shares.len() { self.count } else { self.teeth_below(above) };
            let teeth = ChunkTeeth { first, count: end.saturating_sub(first), below, scale };
            (below, first) = (above, first + teeth.count);
            teeth
        })
    }

    /// Writes the next generation's particles that a chunk gives; `next` begins with the chunk's
    /// first tooth. `weights` are relative to the chunk's greatest.
    pub fn choose<const N: usize>(
        &self,
        particles: &[CyclicParticle<N>],
        weights: &[f32],
        teeth: &ChunkTeeth,
        next: &mut [CyclicParticle<N>],
    ) {
        let mut candidates = particles.iter().zip(weights);
        let Some((mut chosen, weight)) = candidates.next() else { return };
        let mut sum = teeth.scale * weight;
        for (tooth, slot) in (teeth.first..).zip(next) {
            let place = (tooth as f32 + self.offset) * self.spacing - teeth.below;
            while place >= sum {
                // Rounding may let the last teeth end beyond the chunk: they take its last
                // particle.
                let Some((particle, weight)) = candidates.next() else { break };
                chosen = particle;
                sum += teeth.scale * weight;
            }
            *slot = *chosen;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn particles_are_taken_in_proportion_to_their_weights_over_chunks_of_any_scale() {
        let particle = |index: usize| CyclicParticle {
            angles_rad: [index as f32],
            velocities: [0.0],
            cycle_position: 0.0,
            cycle_velocity: 0.0,
        };
        let weights = [0.1_f32, 0.0, 0.5, 0.4, 0.25, 0.05];
        let particles: Vec<_> = (0..weights.len()).map(particle).collect();
        let total: f32 = weights.iter().sum();
        let share = |from: usize, to: usize, scale: f32| WeightShare {
            greatest_log_weight: scale.ln(),
            weight: weights[from..to].iter().sum::<f32>() / scale,
        };
        let chunks = [(0, 2, 0.5), (2, 4, 1.0), (4, 6, 0.125)];
        let shares = chunks.map(|(from, to, scale)| share(from, to, scale));
        let comb = Comb::new(WeightShare { greatest_log_weight: 0.0, weight: total }, 0.3, 1000);
        let mut next = vec![particle(99); 1000];
        for (teeth, (from, to, scale)) in comb.teeth(&shares).zip(chunks) {
            let relative: Vec<f32> = weights[from..to].iter().map(|weight| weight / scale).collect();
            comb.choose(&particles[from..to], &relative, &teeth, &mut next[teeth.first..teeth.first + teeth.count]);
        }
        for (i, weight) in weights.iter().enumerate() {
            let taken = next.iter().filter(|particle| particle.angles_rad[0] as usize == i).count() as f32;
            assert!((taken - 1000.0 * weight / total).abs() <= 1.01, "particle {i} taken {taken} times");
        }
    }

    #[test]
    fn teeth_are_counted_exactly_and_never_beyond_the_last() {
        let of = |weight: f32| Comb::new(WeightShare { greatest_log_weight: 0.0, weight }, 0.5, 10);
        let comb = of(10.0);
        for (sum, teeth) in [(0.0, 0), (0.49, 0), (0.51, 1), (5.2, 5), (9.9, 10), (50.0, 10), (-1.0, 0)] {
            assert_eq!(comb.teeth_below(sum), teeth, "{sum}");
        }
        assert_eq!(of(0.0).teeth_below(0.0), 0, "no weight at all");
    }
}
