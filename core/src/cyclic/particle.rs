//! The particle filter of the cyclic paper, section 3.3: stages that work on slices, so that a caller may split them.
//!
//! Each particle draws from its own stream, and sums are taken over chunks of [`CHUNK`] particles whose results are added
//! in order: the result has the same bits however the chunks are spread over threads.

use super::phase::wrap_position;
use super::semi_definite::{packed_len, semi_cholesky};
use super::start::CycleStart;
use super::substeps::Substeps;
use super::{AngleMeasurement, MotionModel};
use crate::angle::angle_difference;
use crate::math::{exp, max, sqrt, wrap_angle};
use crate::random::Stream;
use core::f32::consts::PI;

/// Particles whose sums are taken together.
pub const CHUNK: usize = 1024;

/// Greatest number of angles that a particle holds.
const MAX_ANGLES: usize = super::model::MAX_ANGLES;

/// One hypothesis: the paper's state vector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CyclicParticle<const N: usize> {
    /// Angles in (-pi, pi].
    pub angles_rad: [f32; N],
    /// Angular velocities, rad per frame.
    pub velocities: [f32; N],
    /// Position in the cycle, [0, 1).
    pub cycle_position: f32,
    /// Velocity through the cycle, cycles per frame.
    pub cycle_velocity: f32,
}

/// How the first particles are spread.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Spread {
    /// About the start, with the standard deviations of [`ParticleOptions`].
    #[default]
    Standard,
    /// The same, but uniform over the cycle position.
    UniformPosition,
    /// Angles and velocities uniform in [-pi, pi], cycle position uniform: the paper's random start.
    Random,
}

/// Options of the particle filter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParticleOptions {
    /// How the first particles are spread.
    pub spread: Spread,
    /// First standard deviation of each angle (rad) and each velocity (rad per frame).
    pub start_std: f32,
    /// First standard deviation of the cycle position, cycles.
    pub position_std: f32,
    /// First standard deviation of the cycle velocity, cycles per frame.
    pub velocity_std: f32,
    /// Standard deviation of the temporal acceleration, cycles per frame^2.
    pub temporal_acceleration_std: f32,
}

impl Default for ParticleOptions {
    /// The square roots of the Kalman filters' first variances.
    fn default() -> Self {
        Self {
            spread: Spread::Standard,
            start_std: 1.0e-2,
            position_std: 3.162_277_7e-3,
            velocity_std: 1.0e-3,
            temporal_acceleration_std: 1.0e-4,
        }
    }
}

/// Writes the Cholesky factors of the covariances at all positions: l packed lower triangles, computed once a model.
pub fn fill_factors(model: &MotionModel<'_>, factors: &mut [f32]) {
    let packed = packed_len(model.angle_count());
    let covariances = model.parts().acceleration_covariance.chunks_exact(packed);
    for (covariance, factor) in covariances.zip(factors.chunks_exact_mut(packed)) {
        semi_cholesky(covariance, model.angle_count(), factor);
    }
}

/// Particle number `index` of the first generation.
#[must_use]
pub fn first_particle<const N: usize>(
    start: &CycleStart<N>,
    options: &ParticleOptions,
    seed: u64,
    index: u32,
) -> CyclicParticle<N> {
    let mut stream = Stream::new(seed, 0, index);
    let mut particle = CyclicParticle {
        angles_rad: start.angles_rad.map(wrap_angle),
        velocities: start.velocities,
        cycle_position: start.cycle_position,
        cycle_velocity: start.cycle_velocity + options.velocity_std * stream.normal(),
    };
    for i in 0..N {
        if options.spread == Spread::Random {
            particle.angles_rad[i] = wrap_angle(PI * (2.0 * stream.uniform() - 1.0));
            particle.velocities[i] = PI * (2.0 * stream.uniform() - 1.0);
        } else {
            let std = sqrt(options.start_std * options.start_std + start.extra_variance_rad2[i]);
            particle.angles_rad[i] = wrap_angle(particle.angles_rad[i] + std * stream.normal());
            particle.velocities[i] += options.start_std * stream.normal();
        }
    }
    particle.cycle_position = if options.spread == Spread::Standard {
        wrap_position(start.cycle_position + options.position_std * stream.normal())
    } else {
        stream.uniform()
    };
    particle
}

impl<const N: usize> CyclicParticle<N> {
    /// A draw from the transition of eq. (11) over `step` <= 1 frame.
    ///
    /// Between two stored positions the noise is that of one of them, drawn with the probabilities of linear
    /// interpolation: the covariance is then exactly the interpolated one.
    #[inline]
    pub fn advance(
        &mut self,
        model: &MotionModel<'_>,
        factors: &[f32],
        temporal_std: f32,
        step: f32,
        stream: &mut Stream,
    ) {
        let n = model.angle_count().min(N).min(MAX_ANGLES);
        let point = model.point(self.cycle_position);
        let ratio = model.speed_ratio(self.cycle_velocity);
        let squared_ratio = ratio * ratio;
        let noise_scale = if step < 1.0 { squared_ratio / sqrt(step) } else { squared_ratio };
        let place = if stream.uniform() < point.fraction { point.after } else { point.before };
        let packed = packed_len(model.angle_count());
        let mut factor = factors.get(place * packed..(place + 1) * packed).unwrap_or_default();
        let mean = model.mean_acceleration::<N>(point);
        let mut draws = [0.0; N];
        for i in 0..n {
            draws[i] = stream.normal();
            let Some((row, rest)) = factor.split_at_checked(i + 1) else { break };
            factor = rest;
            let mut noise = 0.0;
            for (a, b) in row.iter().zip(&draws) {
                noise += a * b;
            }
            let acceleration = squared_ratio * mean[i] + noise_scale * noise;
            let moved = self.angles_rad[i] + step * self.velocities[i] + 0.5 * step * step * acceleration;
            self.angles_rad[i] = angle_difference(moved, 0.0);
            self.velocities[i] = crate::math::clamp(self.velocities[i] + step * acceleration, -PI, PI);
        }
        let temporal = temporal_std * stream.normal() / if step < 1.0 { sqrt(step) } else { 1.0 };
        let position = self.cycle_position + step * self.cycle_velocity + 0.5 * step * step * temporal;
        self.cycle_position = wrap_position(position);
        self.cycle_velocity += step * temporal;
    }
}

/// Moves `particles`, of which the first has number `first_index`, over the measurement's step and writes their log-weights.
pub fn advance_and_weigh<const N: usize>(
    model: &MotionModel<'_>,
    factors: &[f32],
    options: &ParticleOptions,
    measurement: &AngleMeasurement<N>,
    key: (u64, u64, u32),
    particles: &mut [CyclicParticle<N>],
    log_weights: &mut [f32],
) {
    let (seed, frame, first_index) = key;
    let precision: [f32; N] = measurement.std_rad().map(|std| 1.0 / std);
    for (offset, (particle, log_weight)) in particles.iter_mut().zip(log_weights).enumerate() {
        let mut stream = Stream::new(seed, frame, first_index.wrapping_add(offset as u32));
        for step in Substeps::of(measurement.step_frames()) {
            particle.advance(model, factors, options.temporal_acceleration_std, step, &mut stream);
        }
        let mut squared = 0.0;
        for i in 0..N.min(model.angle_count()) {
            if let Some(measured) = measurement.angle_rad(i) {
                let scaled = angle_difference(wrap_angle(measured), particle.angles_rad[i]) * precision[i];
                squared += scaled * scaled;
            }
        }
        *log_weight = -0.5 * squared;
    }
}

/// Turns log-weights into weights relative to `greatest` and returns their sum; NaN weighs nothing.
pub fn exponentiate(greatest: f32, weights: &mut [f32]) -> f32 {
    let mut sum = 0.0;
    for weight in weights {
        let below = *weight - greatest;
        *weight = if below > -40.0 { exp(below) } else { 0.0 };
        sum += *weight;
    }
    sum
}

/// Greatest of the log-weights; negative infinity where there is none.
#[must_use]
pub fn greatest(log_weights: &[f32]) -> f32 {
    log_weights.iter().fold(f32::NEG_INFINITY, |best, &value| max(value, best))
}

/// Systematic resampling over many particles: writes the number of each new particle's ancestor, in ascending order.
///
/// `weights` need not sum to one: their sum is `total`. Kahan's summation keeps 100,000 of them in `f32` exact enough.
pub fn ancestors(weights: &[f32], total: f32, offset: f32, ancestors: &mut [u32]) {
    let spacing = total / ancestors.len() as f32;
    let last = weights.len().saturating_sub(1);
    let (mut index, mut lost) = (0, 0.0);
    let mut cumulative = weights.first().copied().unwrap_or(0.0);
    for (i, ancestor) in ancestors.iter_mut().enumerate() {
        let position = (i as f32 + offset) * spacing;
        while position >= cumulative && index < last {
            index += 1;
            let term = weights.get(index).copied().unwrap_or(0.0) - lost;
            let sum = cumulative + term;
            lost = (sum - cumulative) - term;
            cumulative = sum;
        }
        *ancestor = index as u32;
    }
}

/// Copies the ancestors' states into `next`.
pub fn copy_ancestors<const N: usize>(
    particles: &[CyclicParticle<N>],
    ancestors: &[u32],
    next: &mut [CyclicParticle<N>],
) {
    for (slot, &ancestor) in next.iter_mut().zip(ancestors) {
        if let Some(particle) = particles.get(ancestor as usize) {
            *slot = *particle;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::particle_moments::ParticleMoments;
    use super::super::synthetic;
    use super::*;

    const N: usize = 13;

    /// Runs `count` particles for some frames in chunks of `split` and returns the last mean of each angle.
    fn run(count: usize, split: usize, options: &ParticleOptions) -> [f32; N] {
        let table = synthetic::table(4.0e-3, 9);
        let model = table.model().unwrap();
        let mut factors = vec![0.0; model.parts().acceleration_covariance.len()];
        fill_factors(&model, &mut factors);
        let first = core::array::from_fn(|i| Some(synthetic::mean_angle(i, 0.0)));
        let start = CycleStart::standard(&model, &first, Some(0.0), None).unwrap();
        let mut particles: Vec<_> = (0..count).map(|i| first_particle(&start, options, 3, i as u32)).collect();
        let mut next = particles.clone();
        let (mut weights, mut from) = (vec![0.0; count], vec![0; count]);
        let mut mean = [0.0; N];
        for frame in 1..=30_u8 {
            let seen = core::array::from_fn(|i| Some(synthetic::mean_angle(i, f32::from(frame) / 65.0)));
            let seen = AngleMeasurement::new(&seen, 0.3).unwrap();
            let chunks = particles.chunks_mut(split).zip(weights.chunks_mut(split)).enumerate();
            for (chunk, (particles, weights)) in chunks {
                let key = (3, u64::from(frame), (chunk * split) as u32);
                advance_and_weigh(&model, &factors, options, &seen, key, particles, weights);
            }
            let best = greatest(&weights);
            let total = exponentiate(best, &mut weights);
            let reference = particles[weights.iter().position(|&w| w == 1.0).unwrap()];
            mean = ParticleMoments::of(&particles, &weights, &reference).estimate(&reference).angles_rad;
            ancestors(&weights, total, 0.5, &mut from);
            copy_ancestors(&particles, &from, &mut next);
            core::mem::swap(&mut particles, &mut next);
        }
        mean
    }

    #[test]
    fn the_bits_do_not_depend_on_how_the_particles_are_split() {
        let options = ParticleOptions::default();
        assert_eq!(run(500, 500, &options), run(500, 7, &options));
    }

    #[test]
    fn a_few_hundred_particles_follow_the_motion_from_both_starts() {
        for spread in [Spread::Standard, Spread::UniformPosition] {
            let mean = run(800, CHUNK, &ParticleOptions { spread, ..ParticleOptions::default() });
            let error: f32 = (0..N)
                .map(|i| angle_difference(mean[i], wrap_angle(synthetic::mean_angle(i, 30.0 / 65.0))).abs() / N as f32)
                .sum();
            assert!(error < 0.25, "{spread:?}: {error} rad");
        }
    }

    #[test]
    fn ancestors_are_taken_in_proportion_to_their_weights() {
        let weights = [0.1_f32, 0.0, 0.5, 0.4];
        let mut from = [0; 1000];
        ancestors(&weights, 1.0, 0.3, &mut from);
        for (i, weight) in weights.iter().enumerate() {
            let taken = from.iter().filter(|&&a| a as usize == i).count() as f32;
            assert!((taken - 1000.0 * weight).abs() <= 1.0, "ancestor {i} taken {taken} times");
        }
    }
}
