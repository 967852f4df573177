//! The paper's particle filter over many threads: the core's stages on chunks of particles (cyclic paper, section 3.3).
//!
//! Every particle draws from its own stream and the chunks' sums are added in their order, so the result has the same bits on
//! any number of threads.

use rayon::prelude::*;
use sinew_core::cyclic::particle::{
    CHUNK, CyclicParticle, ParticleOptions, advance_and_weigh, ancestors, copy_ancestors, exponentiate, factors_len,
    fill_factors, fill_positions, first_particle, greatest,
};
use sinew_core::cyclic::particle_moments::ParticleMoments;
use sinew_core::cyclic::particle_tracker::{count_turns, log_likelihood, resampling_offset};
use sinew_core::cyclic::{AngleMeasurement, CycleStart, CyclicEstimate, MotionModel};

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
        let mut positions = vec![0.0; model.position_count()];
        fill_positions(model, start, &mut positions);
        let draw = |index| first_particle(model, &positions, start, &options, (seed, index));
        let particles: Vec<CyclicParticle<N>> = (0..count as u32).into_par_iter().map(draw).collect();
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
        count_turns(&mut estimate, &self.last);
        if measurement.present(model.angle_count()) > 0 {
            let count = self.particles.len();
            estimate.log_likelihood = log_likelihood(measurement, model.angle_count(), (best, total), count);
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
        let offset = resampling_offset(self.seed, self.frame);
        ancestors(&self.weights, total, offset, &mut self.ancestors);
        let particles = &self.particles;
        let jobs = self.next.par_chunks_mut(CHUNK).zip(self.ancestors.par_chunks(CHUNK));
        jobs.for_each(|(next, from)| copy_ancestors(particles, from, next));
        std::mem::swap(&mut self.particles, &mut self.next);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::CyclicModel;
    use sinew_core::cyclic::ParticleTracker;
    use sinew_core::cyclic::particle::Spread;
    use sinew_core::cyclic::particle_tracker::ParticleTables;
    use sinew_core::skeleton::stick_figure::HUMAN_ANGLES;

    const PARTICLES: usize = 1500;

    fn pool(threads: usize) -> rayon::ThreadPool {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap()
    }

    #[test]
    fn any_number_of_threads_and_the_firmware_filter_give_the_same_bits() {
        let shipped = CyclicModel::from_option("walking").unwrap();
        let model = shipped.view();
        let pose = |frame: u8| {
            let position = f32::from(frame) * model.mean_cycle_velocity();
            model.mean_pose_rad::<HUMAN_ANGLES>(model.point(position)).map(Some)
        };
        let (mut factors, mut positions) = (vec![0.0; factors_len(&model)], vec![0.0; model.position_count()]);
        fill_factors(&model, &mut factors);
        for spread in [Spread::Standard, Spread::UniformPosition] {
            let options = ParticleOptions { spread, ..ParticleOptions::default() };
            let start = CycleStart::standard(&model, &pose(0), None, None).unwrap();
            fill_positions(&model, &start, &mut positions);
            let tables = ParticleTables { factors: &factors, positions: &positions };
            let new = || ParticleFilter::new(&model, options, &start, start.estimate(), PARTICLES, 7);
            let (mut one, mut three) = (pool(1).install(new), pool(3).install(new));
            let mut small =
                Box::new(ParticleTracker::<HUMAN_ANGLES, PARTICLES>::new(&model, tables, options, &start, 7));
            for frame in 1..=20 {
                let mut seen = pose(frame);
                seen[usize::from(frame) % HUMAN_ANGLES] = None;
                let measurement = AngleMeasurement::new(&seen, 0.3).unwrap();
                let estimate = pool(1).install(|| one.step(&model, &measurement));
                assert_eq!(pool(3).install(|| three.step(&model, &measurement)), estimate);
                assert_eq!(small.step(&model, tables, &measurement), estimate);
            }
            assert_eq!(one.particles.as_slice(), small.particles().as_slice());
        }
    }
}
