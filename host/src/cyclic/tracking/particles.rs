//! The paper's particle filter over many threads: the core's stages on chunks of particles (cyclic
//! paper, section 3.3).
//!
//! Every particle draws from its own stream, and the chunks' sums are added in their order. So the
//! result has the same bits on any number of threads.

use super::saved_estimate::visit_estimate;
use super::wide_vectors::particle_sweep;
use crate::resume::{real, reals};
use rayon::prelude::*;
use sinew_core::cyclic::particle::moments::ParticleMoments;
use sinew_core::cyclic::particle::propose::{
    CyclicParticle, ParticleOptions, factors_len, fill_factors, fill_positions, first_particle,
};
use sinew_core::cyclic::particle::sweep::CHUNK;
use sinew_core::cyclic::particle::tracker::{count_turns, log_likelihood, resampling_offset};
use sinew_core::cyclic::particle::{resample::Comb, weigh::ParticleTarget, weights::WeightShare};
use sinew_core::cyclic::{AngleMeasurement, CycleStart, CyclicEstimate, MotionModel};
use sinew_core::saved_state::{SavedState, StateVisitor};

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
            last: first,
        }
    }

    /// One frame: predict, weigh, estimate, resample.
    pub fn step(&mut self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>) -> CyclicEstimate<N> {
        self.frame += 1;
        let target = ParticleTarget::new(measurement, model.angle_count(), &self.last);
        let sums = self.sweep(model, &target, measurement.step_frames());
        let mut all = ParticleMoments::nothing();
        for moments in &sums {
            all.merge(moments);
        }
        let mut estimate = all.estimate(&target);
        count_turns(&mut estimate, &self.last);
        if measurement.present(model.angle_count()) > 0 {
            let count = self.particles.len();
            estimate.log_likelihood = log_likelihood(measurement, model.angle_count(), all.share(), count);
            let shares: Vec<WeightShare> = sums.iter().map(ParticleMoments::share).collect();
            self.resample(all.share(), &shares);
        }
        self.last = estimate;
        estimate
    }

    /// Moves and weighs all particles; returns each chunk's sums.
    fn sweep(
        &mut self,
        model: &MotionModel<'_>,
        target: &ParticleTarget<N>,
        step_frames: f32,
    ) -> Vec<ParticleMoments<N>> {
        let (factors, options, seed, frame) = (&self.factors, &self.options, self.seed, self.frame);
        let chunks = self.particles.par_chunks_mut(CHUNK).zip(self.weights.par_chunks_mut(CHUNK));
        chunks
            .enumerate()
            .map(|(chunk, (particles, weights))| {
                let key = (seed, frame, (chunk * CHUNK) as u32);
                particle_sweep(model, factors, options, (target, step_frames), key, particles, weights)
            })
            .collect()
    }

    /// The next generation; every chunk writes its own part of it.
    fn resample(&mut self, all: WeightShare, shares: &[WeightShare]) {
        let comb = Comb::new(all, resampling_offset(self.seed, self.frame), self.particles.len());
        let mut rest: &mut [CyclicParticle<N>] = &mut self.next;
        let mut parts = Vec::with_capacity(shares.len());
        for teeth in comb.teeth(shares) {
            let (next, others) = rest.split_at_mut(teeth.count);
            parts.push((teeth, next));
            rest = others;
        }
        let chunks = self.particles.par_chunks(CHUNK).zip(self.weights.par_chunks(CHUNK));
        chunks.zip(parts).for_each(|((particles, weights), (teeth, next))| {
            comb.choose(particles, weights, &teeth, next);
        });
        std::mem::swap(&mut self.particles, &mut self.next);
    }
}

impl<const N: usize> SavedState for ParticleFilter<N> {
    /// Weights and the next generation are written before they are read.
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.long(&mut self.seed);
        visitor.long(&mut self.frame);
        let mut count = self.particles.len();
        visitor.index(&mut count, u32::MAX as usize);
        if count != self.particles.len() {
            visitor.refuse();
            return;
        }
        for particle in &mut self.particles {
            reals(&mut particle.angles_rad, visitor);
            reals(&mut particle.velocities, visitor);
            real(&mut particle.cycle_position, visitor);
            real(&mut particle.cycle_velocity, visitor);
        }
        visit_estimate(&mut self.last, visitor);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::CyclicModel;
    use sinew_core::cyclic::ParticleTracker;
    use sinew_core::cyclic::particle::propose::Spread;
    use sinew_core::cyclic::particle::tracker::ParticleTables;
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
            assert_eq!(one.particles.as_slice(), small.particles());
        }
    }
}
