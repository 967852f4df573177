//! One step of the particle filter on one thread, stage by stage, with the shipped model of walking.

use sinew_core::cyclic::particle::{
    CHUNK, CyclicParticle, ParticleOptions, advance_and_weigh, ancestors, copy_ancestors, exponentiate, factors_len,
    fill_factors, first_particle, greatest,
};
use sinew_core::cyclic::particle_moments::ParticleMoments;
use sinew_core::cyclic::{AngleMeasurement, CycleStart, MotionModel};
use std::hint::black_box;
use std::time::Instant;

use super::walk::{ANGLES, Walk};

/// Names of what [`ParticleStep::run`] times.
pub const STAGES: [&str; 4] = ["predict and weigh", "weights and moments", "ancestors", "copies"];

/// A particle filter and where it stands.
pub struct ParticleStep<'a> {
    model: MotionModel<'a>,
    walk: &'a Walk,
    factors: Vec<f32>,
    particles: Vec<CyclicParticle<ANGLES>>,
    next: Vec<CyclicParticle<ANGLES>>,
    weights: Vec<f32>,
    ancestors: Vec<u32>,
    frame: usize,
}

impl<'a> ParticleStep<'a> {
    pub fn new(model: MotionModel<'a>, walk: &'a Walk, count: usize) -> Self {
        let mut factors = vec![0.0; factors_len(&model)];
        fill_factors(&model, &mut factors);
        let start = CycleStart::standard(&model, walk.angles(0), None, None).expect("a sound start");
        let options = ParticleOptions::default();
        let draw = |index| first_particle(&model, &[], &start, &options, (1, index));
        let particles: Vec<_> = (0..count as u32).map(draw).collect();
        Self {
            model,
            walk,
            factors,
            next: particles.clone(),
            particles,
            weights: vec![0.0; count],
            ancestors: vec![0; count],
            frame: 0,
        }
    }

    /// Seconds of each stage of the next step.
    pub fn run(&mut self) -> [f64; STAGES.len()] {
        self.frame += 1;
        let measurement = self.walk.measurement(self.frame);
        let start = Instant::now();
        let best = self.predict(&measurement);
        let predicted = start.elapsed();
        let total = self.estimate(best);
        let estimated = start.elapsed();
        ancestors(&self.weights, total, 0.5, &mut self.ancestors);
        let chosen = start.elapsed();
        copy_ancestors(&self.particles, &self.ancestors, &mut self.next);
        std::mem::swap(&mut self.particles, &mut self.next);
        let copied = start.elapsed();
        [predicted, estimated - predicted, chosen - estimated, copied - chosen].map(|part| part.as_secs_f64())
    }

    fn predict(&mut self, measurement: &AngleMeasurement<ANGLES>) -> f32 {
        let options = ParticleOptions::default();
        let mut best = f32::NEG_INFINITY;
        let chunks = self.particles.chunks_mut(CHUNK).zip(self.weights.chunks_mut(CHUNK));
        for (chunk, (particles, weights)) in chunks.enumerate() {
            let key = (1, self.frame as u64, (chunk * CHUNK) as u32);
            advance_and_weigh(&self.model, &self.factors, &options, measurement, key, particles, weights);
            best = best.max(greatest(weights));
        }
        best
    }

    fn estimate(&mut self, best: f32) -> f32 {
        let reference = self.particles[0];
        let (mut total, mut all) = (0.0, ParticleMoments::nothing());
        for (particles, weights) in self.particles.chunks(CHUNK).zip(self.weights.chunks_mut(CHUNK)) {
            total += exponentiate(best, weights);
            all.merge(&ParticleMoments::of(particles, weights, &reference));
        }
        black_box(all.estimate(&reference));
        total
    }
}
