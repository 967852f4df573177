//! The particle filter with a capacity known at compile time: for firmware, a few hundred
//! particles, nothing allocated.

use crate::angle::split_turns;
use crate::cyclic::particle::moments::ParticleMoments;
use crate::cyclic::particle::propose::{CyclicParticle, ParticleOptions, first_particle};
use crate::cyclic::particle::sweep::{CHUNK, sweep};
use crate::cyclic::particle::{resample::Comb, weigh::ParticleTarget, weights::WeightShare};
use crate::cyclic::{AngleMeasurement, CycleStart, CyclicEstimate, MotionModel};
use crate::math::ln;
use crate::random::Stream;
use crate::random::normal::LOG_SQRT_TAU;
use crate::saved_state::{SavedState, StateVisitor};

/// Stream that the resampling of a frame draws from; particles have the numbers below.
const RESAMPLING_STREAM: u32 = u32::MAX;

/// Most chunks of particles, of 1024 each. Chosen: more particles are for the host.
const MAX_CHUNKS: usize = 8;

/// Tables of the model for the particles, in the caller's memory.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// # use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::particle::propose::{ParticleOptions, Spread, fill_factors, fill_positions};
/// use sinew_core::cyclic::particle::tracker::ParticleTables;
/// use sinew_core::cyclic::{CycleStart, ParticleTracker};
///
/// # let model = WALKING.model()?;
/// # let first_rad = model.mean_pose_rad::<13>(model.point(0.3)).map(Some);
/// // A start anywhere that the first pose allows needs both tables; `factors` may be shared by several trackers.
/// let start = CycleStart::standard(&model, &first_rad, None, None)?;
/// let (mut factors, mut positions) = ([0.0; 20_800], [0.0; 100]);
/// fill_factors(&model, &mut factors);
/// fill_positions(&model, &start, &mut positions);
/// let tables = ParticleTables { factors: &factors, positions: &positions };
/// let options = ParticleOptions { spread: Spread::UniformPosition, ..ParticleOptions::default() };
/// let tracker = ParticleTracker::<13, 100>::new(&model, tables, options, &start, 1);
/// let near = tracker.particles().iter().filter(|particle| (0.2..0.4).contains(&particle.cycle_position));
/// assert!(near.count() > 85);
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct ParticleTables<'a> {
    /// Written by [`crate::cyclic::particle::propose::fill_factors`]; borrowed in every step, best
    /// from a `static`.
    pub factors: &'a [f32],
    /// Written by [`crate::cyclic::particle::propose::fill_positions`]; read at the start alone.
    /// Empty for a start that is not uniform.
    pub positions: &'a [f32],
}

/// `P` particles of up to `N` angles. The same seed and number of particles give the bits of the
/// host's parallel filter.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::particle::propose::{ParticleOptions, fill_factors};
/// use sinew_core::cyclic::particle::tracker::ParticleTables;
/// use sinew_core::cyclic::{AngleMeasurement, CycleStart, ParticleTracker};
///
/// let model = WALKING.model()?;
/// let mut factors = [0.0; 20_800];
/// fill_factors(&model, &mut factors);
/// let tables = ParticleTables { factors: &factors, positions: &[] };
/// let pose_rad = |frame: u8| model.mean_pose_rad::<13>(model.point(f32::from(frame) * model.mean_cycle_velocity()));
/// let start = CycleStart::standard(&model, &pose_rad(0).map(Some), Some(0.0), None)?;
/// let mut tracker = ParticleTracker::<13, 200>::new(&model, tables, ParticleOptions::default(), &start, 1);
/// let mut estimate = start.estimate();
/// for frame in 1..=30 {
///     estimate = tracker.step(&model, tables, &AngleMeasurement::new(&pose_rad(frame).map(Some), 0.1)?);
/// }
/// assert!((estimate.angles_rad[0] - pose_rad(30)[0]).abs() < 0.1);
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct ParticleTracker<const N: usize, const P: usize> {
    options: ParticleOptions,
    seed: u64,
    frame: u64,
    particles: [CyclicParticle<N>; P],
    next: [CyclicParticle<N>; P],
    weights: [f32; P],
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
        const { assert!(P > 0 && P <= MAX_CHUNKS * CHUNK, "at least one particle, at most 8192") };
        let draw = |index| first_particle(model, tables.positions, start, &options, (seed, index as u32));
        let particles = core::array::from_fn(draw);
        Self { options, seed, frame: 0, next: particles, particles, weights: [0.0; P], last: start.estimate() }
    }

    /// One frame: predict, weigh, estimate, resample.
    pub fn step(
        &mut self,
        model: &MotionModel<'_>,
        tables: ParticleTables<'_>,
        measurement: &AngleMeasurement<N>,
    ) -> CyclicEstimate<N> {
        self.frame += 1;
        let target = ParticleTarget::new(measurement, model.angle_count(), &self.last);
        let (moments, shares) = self.sweep(model, tables.factors, &target, measurement.step_frames());
        let mut estimate = moments.estimate(&target);
        count_turns(&mut estimate, &self.last);
        if measurement.present(model.angle_count()) > 0 {
            estimate.log_likelihood = log_likelihood(measurement, model.angle_count(), moments.share(), P);
            self.resample(moments.share(), &shares);
        }
        self.last = estimate;
        estimate
    }

    /// The particles after the last step, equally likely where it had a measurement.
    #[must_use]
    pub const fn particles(&self) -> &[CyclicParticle<N>; P] {
        &self.particles
    }

    /// Moves and weighs all particles; returns their sums and each chunk's share of the weights.
    fn sweep(
        &mut self,
        model: &MotionModel<'_>,
        factors: &[f32],
        target: &ParticleTarget<N>,
        step_frames: f32,
    ) -> (ParticleMoments<N>, [WeightShare; MAX_CHUNKS]) {
        let mut all = ParticleMoments::nothing();
        let mut shares = [WeightShare::NOTHING; MAX_CHUNKS];
        let chunks = self.particles.chunks_mut(CHUNK).zip(self.weights.chunks_mut(CHUNK));
        for ((chunk, (particles, weights)), share) in chunks.enumerate().zip(&mut shares) {
            let key = (self.seed, self.frame, (chunk * CHUNK) as u32);
            let moments = sweep(model, factors, &self.options, (target, step_frames), key, particles, weights);
            all.merge(&moments);
            *share = moments.share();
        }
        (all, shares)
    }

    /// The next generation, chunk by chunk.
    fn resample(&mut self, all: WeightShare, shares: &[WeightShare; MAX_CHUNKS]) {
        let comb = Comb::new(all, resampling_offset(self.seed, self.frame), P);
        let shares = shares.get(..P.div_ceil(CHUNK)).unwrap_or_default();
        let mut rest: &mut [CyclicParticle<N>] = &mut self.next;
        let chunks = self.particles.chunks(CHUNK).zip(self.weights.chunks(CHUNK));
        for ((particles, weights), teeth) in chunks.zip(comb.teeth(shares)) {
            let (next, others) = rest.split_at_mut_checked(teeth.count).unwrap_or_default();
            comb.choose(particles, weights, &teeth, next);
            rest = others;
        }
        core::mem::swap(&mut self.particles, &mut self.next);
    }
}

impl<const N: usize, const P: usize> SavedState for ParticleTracker<N, P> {
    /// The next generation and the weights are written before they are read.
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.long(&mut self.seed);
        visitor.long(&mut self.frame);
        for particle in &mut self.particles {
            particle.visit(visitor);
        }
        self.last.visit(visitor);
    }
}

/// ln of the density of a measurement given those before, from the weights of all `count`
/// particles.
///
/// ```
/// use sinew_core::cyclic::AngleMeasurement;
/// use sinew_core::cyclic::particle::weights::WeightShare;
/// use sinew_core::cyclic::particle::tracker::log_likelihood;
/// use sinew_core::random::normal::log_density;
///
/// // A hundred particles, all of them exactly at the measured angle: the density at a normal's mean, std 0.1 rad.
/// let seen = AngleMeasurement::new(&[Some(0.4)], 0.1)?;
/// let all = WeightShare { greatest_log_weight: 0.0, weight: 100.0 };
/// let expected = log_density(0.0) - sinew_core::math::ln(0.1);
/// assert!((log_likelihood(&seen, 1, all, 100) - expected).abs() < 1e-5);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[must_use]
pub fn log_likelihood<const N: usize>(
    measurement: &AngleMeasurement<N>,
    angle_count: usize,
    all: WeightShare,
    count: usize,
) -> f32 {
    let mut scale = 0.0;
    for i in 0..N.min(angle_count) {
        if measurement.angle_rad(i).is_some() {
            scale += ln(measurement.std_rad()[i]) + LOG_SQRT_TAU;
        }
    }
    all.greatest_log_weight + ln(all.weight / count as f32) - scale
}

/// Whole turns since the start, by the shorter way from the last estimate.
///
/// ```
/// # use sinew_core::cyclic::CycleStart;
/// use sinew_core::cyclic::particle::tracker::count_turns;
///
/// # let at = |angle_rad: f32| {
/// #     let (angles_rad, extra_variance_rad2, velocities) = ([angle_rad], [0.0], [0.0]);
/// #     CycleStart { angles_rad, extra_variance_rad2, velocities, cycle_position: 0.0, cycle_velocity: 0.0 }.estimate()
/// # };
/// // From 3.1 to -3.1 rad the short way leads over the seam: one turn more.
/// let (last, mut estimate) = (at(3.1), at(-3.1));
/// count_turns(&mut estimate, &last);
/// assert_eq!(estimate.turns, [last.turns[0] + 1]);
/// ```
pub fn count_turns<const N: usize>(estimate: &mut CyclicEstimate<N>, last: &CyclicEstimate<N>) {
    for i in 0..N {
        let (_, turned) = split_turns(estimate.angles_rad[i] - last.angles_rad[i]);
        // A difference beyond half a turn went over the seam.
        estimate.turns[i] = last.turns[i].saturating_sub(turned);
    }
}

/// The random offset of a frame's systematic resampling, in [0, 1).
///
/// ```
/// use sinew_core::cyclic::particle::tracker::resampling_offset;
///
/// // The same on every machine, another one in every frame.
/// assert_eq!(resampling_offset(1, 20), resampling_offset(1, 20));
/// assert_ne!(resampling_offset(1, 20), resampling_offset(1, 21));
/// assert!((0.0..1.0).contains(&resampling_offset(1, 20)));
/// ```
#[must_use]
pub fn resampling_offset(seed: u64, frame: u64) -> f32 {
    Stream::new(seed, frame, RESAMPLING_STREAM).uniform()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::angle::angle_difference;
    use crate::cyclic::particle::propose::{Spread, factors_len, fill_factors, fill_positions};
    use crate::cyclic::synthetic;
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
