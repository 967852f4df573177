//! One step of the particle filter on one thread, stage by stage, with the shipped model of
//! walking.

use sinew::cyclic::tracking::wide_vectors::particle_sweep;
use sinew_core::cyclic::particle::moments::ParticleMoments;
use sinew_core::cyclic::particle::propose::{
    CyclicParticle, ParticleOptions, factors_len, fill_factors, first_particle,
};
use sinew_core::cyclic::particle::sweep::CHUNK;
use sinew_core::cyclic::particle::{resample::Comb, weigh::ParticleTarget, weights::WeightShare};
use sinew_core::cyclic::{CycleStart, CyclicEstimate, MotionModel};
use std::hint::black_box;
use std::time::Instant;

use super::walk::{ANGLES, Walk};

/// Names of what [`ParticleStep::run`] times.
pub const STAGES: [&str; 3] = ["move, weigh and sum", "estimate", "resample"];

/// A particle filter and where it stands.
pub struct ParticleStep<'a> {
    model: MotionModel<'a>,
    walk: &'a Walk,
    factors: Vec<f32>,
    particles: Vec<CyclicParticle<ANGLES>>,
    next: Vec<CyclicParticle<ANGLES>>,
    weights: Vec<f32>,
    shares: Vec<WeightShare>,
    last: CyclicEstimate<ANGLES>,
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
            shares: Vec::new(),
            last: start.estimate(),
            frame: 0,
        }
    }

    /// Seconds of each stage of the next step.
    pub fn run(&mut self) -> [f64; STAGES.len()] {
        self.frame += 1;
        let measurement = self.walk.measurement(self.frame);
        let start = Instant::now();
        let target = ParticleTarget::new(&measurement, ANGLES, &self.last);
        let all = self.sweep(&target);
        let swept = start.elapsed();
        self.last = black_box(all.estimate(&target));
        let estimated = start.elapsed();
        self.resample(all.share());
        [swept, estimated - swept, start.elapsed() - estimated].map(|part| part.as_secs_f64())
    }

    fn sweep(&mut self, target: &ParticleTarget<ANGLES>) -> ParticleMoments<ANGLES> {
        let options = ParticleOptions::default();
        let mut all = ParticleMoments::nothing();
        self.shares.clear();
        let chunks = self.particles.chunks_mut(CHUNK).zip(self.weights.chunks_mut(CHUNK));
        for (chunk, (particles, weights)) in chunks.enumerate() {
            let key = (1, self.frame as u64, (chunk * CHUNK) as u32);
            let moments = particle_sweep(&self.model, &self.factors, &options, (target, 1.0), key, particles, weights);
            self.shares.push(moments.share());
            all.merge(&moments);
        }
        all
    }

    fn resample(&mut self, all: WeightShare) {
        let comb = Comb::new(all, 0.5, self.particles.len());
        let chunks = self.particles.chunks(CHUNK).zip(self.weights.chunks(CHUNK));
        for ((particles, weights), teeth) in chunks.zip(comb.teeth(&self.shares)) {
            comb.choose(particles, weights, &teeth, &mut self.next[teeth.first..teeth.first + teeth.count]);
        }
        std::mem::swap(&mut self.particles, &mut self.next);
    }
}
