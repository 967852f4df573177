//! The particle filter with a capacity known at compile time: for firmware, a few hundred particles, nothing allocated.

use super::particle::{
    CHUNK, CyclicParticle, ParticleOptions, advance_and_weigh, ancestors, copy_ancestors, exponentiate, first_particle,
    greatest,
};
use super::particle_moments::ParticleMoments;
use super::{AngleMeasurement, CycleStart, CyclicEstimate, MotionModel};
use crate::angle::split_turns;
use crate::math::ln;
use crate::random::Stream;
use crate::random::normal::LOG_SQRT_TAU;

/// Stream that the resampling of a frame draws from; particles have the numbers below.
const RESAMPLING_STREAM: u32 = u32::MAX;

/// What the model holds ready for the particles, in the caller's memory.
#[derive(Debug, Clone, Copy)]
pub struct ParticleTables<'a> {
    /// Written by [`super::particle::fill_factors`]; borrowed in every step, best from a `static`.
    pub factors: &'a [f32],
    /// Written by [`super::particle::fill_positions`]; read at the start alone. Empty for a start that is not uniform.
    pub positions: &'a [f32],
}

/// `P` particles of up to `N` angles. The same seed and number of particles give the bits of the host's parallel filter.
#[derive(Debug, Clone)]
pub struct ParticleTracker<const N: usize, const P: usize> {
    options: ParticleOptions,
    seed: u64,
    frame: u64,
    particles: [CyclicParticle<N>; P],
    next: [CyclicParticle<N>; P],
    weights: [f32; P],
    ancestors: [u32; P],
    last: CyclicEstimate<N>,
}

impl<const N: usize, const P: usize> ParticleTracker<N, P> {
    /// Particles about `start`.
    #[must_use]
    pub fn new(
        model: &MotionModel<'_>,
        tables: ParticleTables<'_>,
        options: ParticleOptions,
        start: &CycleStart<N>,
        seed: u64,
    ) -> Self {
        const { assert!(P > 0, "at least one particle") };
        let draw = |index| first_particle(model, tables.positions, start, &options, (seed, index as u32));
        let particles = core::array::from_fn(draw);
        Self {
            options,
            seed,
            frame: 0,
            next: particles,
            particles,
            weights: [0.0; P],
            ancestors: [0; P],
            last: start.estimate(),
        }
    }

    /// One frame: predict, weigh, estimate, resample.
    pub fn step(
        &mut self,
        model: &MotionModel<'_>,
        tables: ParticleTables<'_>,
        measurement: &AngleMeasurement<N>,
    ) -> CyclicEstimate<N> {
        self.frame += 1;
        let best = self.predict(model, tables.factors, measurement);
        let (total, mut estimate) = self.estimate(best);
        count_turns(&mut estimate, &self.last);
        if measurement.present(model.angle_count()) > 0 {
            estimate.log_likelihood = log_likelihood(measurement, model.angle_count(), (best, total), P);
            ancestors(&self.weights, total, resampling_offset(self.seed, self.frame), &mut self.ancestors);
            copy_ancestors(&self.particles, &self.ancestors, &mut self.next);
            core::mem::swap(&mut self.particles, &mut self.next);
        }
        self.last = estimate;
        estimate
    }

    /// The particles after the last step, equally likely where it had a measurement.
    #[must_use]
    pub const fn particles(&self) -> &[CyclicParticle<N>; P] {
        &self.particles
    }

    /// Moves and weighs all particles; returns the greatest log-weight.
    fn predict(&mut self, model: &MotionModel<'_>, factors: &[f32], measurement: &AngleMeasurement<N>) -> f32 {
        let mut best = f32::NEG_INFINITY;
        let chunks = self.particles.chunks_mut(CHUNK).zip(self.weights.chunks_mut(CHUNK));
        for (chunk, (particles, weights)) in chunks.enumerate() {
            let key = (self.seed, self.frame, (chunk * CHUNK) as u32);
            advance_and_weigh(model, factors, &self.options, measurement, key, particles, weights);
            best = greatest(&[best, greatest(weights)]);
        }
        best
    }

    /// Sum of the weights relative to `best`, and the weighted circular means.
    fn estimate(&mut self, best: f32) -> (f32, CyclicEstimate<N>) {
        let reference = self.particles[0];
        let (mut total, mut all) = (0.0, ParticleMoments::nothing());
        for (particles, weights) in self.particles.chunks(CHUNK).zip(self.weights.chunks_mut(CHUNK)) {
            total += exponentiate(best, weights);
            all.merge(&ParticleMoments::of(particles, weights, &reference));
        }
        (total, all.estimate(&reference))
    }
}

/// ln of the density of a measurement given those before, from the greatest log-weight and the `count` particles' sum of
/// weights relative to it.
#[must_use]
pub fn log_likelihood<const N: usize>(
    measurement: &AngleMeasurement<N>,
    angle_count: usize,
    (best, total): (f32, f32),
    count: usize,
) -> f32 {
    let mut scale = 0.0;
    for i in 0..N.min(angle_count) {
        if measurement.angle_rad(i).is_some() {
            scale += ln(measurement.std_rad()[i]) + LOG_SQRT_TAU;
        }
    }
    best + ln(total / count as f32) - scale
}

/// Whole turns since the start, by the shorter way from the last estimate.
pub fn count_turns<const N: usize>(estimate: &mut CyclicEstimate<N>, last: &CyclicEstimate<N>) {
    for i in 0..N {
        let (_, turned) = split_turns(estimate.angles_rad[i] - last.angles_rad[i]);
        // A difference beyond half a turn went over the seam.
        estimate.turns[i] = last.turns[i].saturating_sub(turned);
    }
}

/// The random offset of a frame's systematic resampling, in [0, 1).
#[must_use]
pub fn resampling_offset(seed: u64, frame: u64) -> f32 {
    Stream::new(seed, frame, RESAMPLING_STREAM).uniform()
}

#[cfg(test)]
mod tests {
    use super::super::particle::{Spread, factors_len, fill_factors, fill_positions};
    use super::super::synthetic;
    use super::*;
    use crate::angle::angle_difference;
    use crate::math::wrap_angle;

    #[test]
    fn three_hundred_particles_follow_a_cycle_from_a_known_and_an_unknown_phase() {
        let table = synthetic::table(4.0e-3, 9);
        let model = table.model().unwrap();
        let (mut factors, mut positions) = (vec![0.0; factors_len(&model)], vec![0.0; model.position_count()]);
        fill_factors(&model, &mut factors);
        let first = core::array::from_fn(|i| Some(synthetic::mean_angle(i, 0.0)));
        for spread in [Spread::Standard, Spread::UniformPosition] {
            let start = CycleStart::<13>::standard(&model, &first, None, None).unwrap();
            fill_positions(&model, &start, &mut positions);
            let tables = ParticleTables { factors: &factors, positions: &positions };
            let options = ParticleOptions { spread, ..ParticleOptions::default() };
            let mut tracker = Box::new(ParticleTracker::<13, 300>::new(&model, tables, options, &start, 5));
            for frame in 1..=65_u8 {
                let pose: [f32; 13] = core::array::from_fn(|i| synthetic::mean_angle(i, f32::from(frame) / 65.0));
                let measurement = AngleMeasurement::new(&pose.map(Some), 0.3).unwrap();
                let estimate = tracker.step(&model, tables, &measurement);
                let off = |i: usize| angle_difference(estimate.angles_rad[i], wrap_angle(pose[i])).abs();
                let error = (0..13).map(off).sum::<f32>() / 13.0;
                assert!(error < 0.4, "{spread:?} frame {frame}: {error} rad");
                assert!(estimate.log_likelihood.is_finite());
            }
            assert_eq!(tracker.last.turns[12], 1, "angle 12 winds once a cycle");
        }
    }
}
