//! The paper's particle filter over many threads: the core's stages on chunks of particles (cyclic paper, section 3.3).
//!
//! Every particle draws from its own stream and the chunks' sums are added in their order, so the result has the same bits on
//! any number of threads.

use rayon::prelude::*;
use sinew_core::angle::split_turns;
use sinew_core::cyclic::particle::{
    CHUNK, CyclicParticle, ParticleOptions, advance_and_weigh, ancestors, copy_ancestors, exponentiate, factors_len,
    fill_factors, first_particle, greatest,
};
use sinew_core::cyclic::particle_moments::ParticleMoments;
use sinew_core::cyclic::{AngleMeasurement, CycleStart, CyclicEstimate, MotionModel};
use sinew_core::random::Stream;
use sinew_core::random::normal::LOG_SQRT_TAU;

/// Stream that the resampling of a frame draws from; particles have the numbers below.
const RESAMPLING_STREAM: u32 = u32::MAX;

/// State of a particle filter.
#[derive(Debug, Clone)]
pub struct ParticleFilter<const N: usize> {
    options: ParticleOptions,
    seed: u64,
    frame: u64,
    factors: Vec<f32>,
    particles: Vec<CyclicParticle<N>>,
    next: Vec<CyclicParticle<N>>,
    weights: Vec<f32>,
    ancestors: Vec<u32>,
    last: CyclicEstimate<N>,
}

impl<const N: usize> ParticleFilter<N> {
    /// `count` particles about `start`, whose estimate is `first`.
    #[must_use]
    pub fn new(
        model: &MotionModel<'_>,
        options: ParticleOptions,
        start: &CycleStart<N>,
        first: CyclicEstimate<N>,
        count: usize,
        seed: u64,
    ) -> Self {
        let mut factors = vec![0.0; factors_len(model)];
        fill_factors(model, &mut factors);
        let particles: Vec<CyclicParticle<N>> =
            (0..count as u32).into_par_iter().map(|index| first_particle(start, &options, seed, index)).collect();
        Self {
            options,
            seed,
            frame: 0,
            factors,
            next: particles.clone(),
            particles,
            weights: vec![0.0; count],
            ancestors: vec![0; count],
            last: first,
        }
    }

    /// One frame: predict, weigh, estimate, resample.
    pub fn step(&mut self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>) -> CyclicEstimate<N> {
        self.frame += 1;
        let best = self.predict(model, measurement);
        let (total, mut estimate) = self.estimate(best);
        self.count_turns(&mut estimate);
        let present = measurement.present(model.angle_count());
        if present > 0 {
            let scale: f32 = (0..model.angle_count())
                .filter(|&i| measurement.angle_rad(i).is_some())
                .map(|i| measurement.std_rad()[i].ln() + LOG_SQRT_TAU)
                .sum();
            estimate.log_likelihood = best + (total / self.particles.len() as f32).ln() - scale;
            self.resample(total);
        }
        self.last = estimate;
        estimate
    }

    /// Moves and weighs all particles; returns the greatest log-weight.
    fn predict(&mut self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>) -> f32 {
        let (factors, options, seed, frame) = (&self.factors, &self.options, self.seed, self.frame);
        let chunks = self.particles.par_chunks_mut(CHUNK).zip(self.weights.par_chunks_mut(CHUNK));
        let best: Vec<f32> = chunks
            .enumerate()
            .map(|(chunk, (particles, weights))| {
                let key = (seed, frame, (chunk * CHUNK) as u32);
                advance_and_weigh(model, factors, options, measurement, key, particles, weights);
                greatest(weights)
            })
            .collect();
        greatest(&best)
    }

    /// Sum of the weights relative to `best`, and the weighted circular means.
    fn estimate(&mut self, best: f32) -> (f32, CyclicEstimate<N>) {
        let reference = self.particles[0];
        let chunks = self.particles.par_chunks(CHUNK).zip(self.weights.par_chunks_mut(CHUNK));
        let sums: Vec<(f32, ParticleMoments<N>)> = chunks
            .map(|(particles, weights)| {
                let total = exponentiate(best, weights);
                (total, ParticleMoments::of(particles, weights, &reference))
            })
            .collect();
        let mut all = ParticleMoments::nothing();
        let mut total = 0.0;
        for (sum, moments) in &sums {
            total += sum;
            all.merge(moments);
        }
        (total, all.estimate(&reference))
    }

    fn resample(&mut self, total: f32) {
        let offset = Stream::new(self.seed, self.frame, RESAMPLING_STREAM).uniform();
        ancestors(&self.weights, total, offset, &mut self.ancestors);
        let particles = &self.particles;
        let jobs = self.next.par_chunks_mut(CHUNK).zip(self.ancestors.par_chunks(CHUNK));
        jobs.for_each(|(next, from)| copy_ancestors(particles, from, next));
        std::mem::swap(&mut self.particles, &mut self.next);
    }

    /// Whole turns since the start, by the shorter way from the last estimate.
    fn count_turns(&self, estimate: &mut CyclicEstimate<N>) {
        for i in 0..N {
            let (_, turned) = split_turns(estimate.angles_rad[i] - self.last.angles_rad[i]);
            // A difference beyond half a turn went over the seam.
            estimate.turns[i] = self.last.turns[i] - turned;
        }
    }
}
