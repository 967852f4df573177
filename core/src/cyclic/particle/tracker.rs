//! The particle filter with a capacity known at compile time: for firmware, a few hundred
//! particles, nothing allocated.

use crate::angle::split_turns;
use crate::cyclic::particle::computed_factors::ComputedFactors;
use crate::cyclic::particle::factors::{Accelerations, ParticleTable};
use crate::cyclic::particle::moments::ParticleMoments;
use crate::cyclic::particle::propose::{CyclicParticle, ParticleOptions, Spread, fill_positions, first_particle};
use crate::cyclic::particle::sweep::{CHUNK, SweepMemory, sweep_by};
use crate::cyclic::particle::{resample::Comb, weigh::ParticleTarget, weights::WeightShare};
use crate::cyclic::{AngleMeasurement, CycleStart, CyclicEstimate, MotionModel};
use crate::error::{ParameterError, Rule};
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
    /// How many of the particles are used.
    count: usize,
    particles: [CyclicParticle<N>; P],
    next: [CyclicParticle<N>; P],
    weights: [f32; P],
    last: CyclicEstimate<N>,
    memory: SweepMemory<N>,
    /// The sums of all chunks.
    all: ParticleMoments<N>,
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
        let mut tracker = Self::empty();
        (tracker.options, tracker.seed, tracker.count, tracker.last) = (options, seed, P, start.estimate());
        for (index, particle) in tracker.particles.iter_mut().enumerate() {
            *particle = first_particle(model, tables.positions, start, &options, (seed, index as u32));
        }
        tracker
    }

    /// A tracker before [`Self::begin`], for static memory: all zeros, and it takes no stack. Its
    /// estimates are meaningless.
    #[must_use]
    pub const fn empty() -> Self {
        const { assert!(P > 0 && P <= MAX_CHUNKS * CHUNK, "at least one particle, at most 8192") };
        let particle =
            CyclicParticle { angles_rad: [0.0; N], velocities: [0.0; N], cycle_position: 0.0, cycle_velocity: 0.0 };
        Self {
            options: ParticleOptions::NOTHING,
            seed: 0,
            frame: 0,
            count: 0,
            particles: [particle; P],
            next: [particle; P],
            weights: [0.0; P],
            last: CyclicEstimate::NOTHING,
            memory: SweepMemory::empty(),
            all: ParticleMoments::ZERO,
        }
    }

    /// Takes over options and a number of particles for the next [`Self::begin`] or saved state.
    ///
    /// # Errors
    /// From 1 to `P` particles; the tracker is as before then.
    pub fn configure(&mut self, options: ParticleOptions, particles: usize) -> Result<(), ParameterError> {
        if particles == 0 || particles > P {
            return Err(ParameterError::new("particles", Rule::Within { low: 1.0, high: P as f32 }));
        }
        (self.options, self.count) = (options, particles);
        Ok(())
    }

    /// Begins, or begins anew, with particles about `start`, in place, after [`Self::configure`].
    /// It needs no table: positions of a uniform start are spread over `P` places of the cycle.
    ///
    /// ```
    /// # #[cfg(feature = "walking-model")] {
    /// # use sinew_core::cyclic::model::walking::WALKING;
    /// use sinew_core::cyclic::particle::propose::{ParticleOptions, Spread};
    /// use sinew_core::cyclic::{AngleMeasurement, CycleStart, ParticleTracker};
    ///
    /// # let model = WALKING.model()?;
    /// # let seen = AngleMeasurement::new(&model.mean_pose_rad::<13>(model.point(0.3)).map(Some), 0.1)?;
    /// // Fifty of the hundred particles that there is room for, anywhere that the first pose allows.
    /// let mut tracker = ParticleTracker::<13, 100>::empty();
    /// let start = CycleStart::standard(&model, seen.angles_rad(), None, None)?;
    /// let options = ParticleOptions { spread: Spread::UniformPosition, ..ParticleOptions::default() };
    /// tracker.configure(options, 50)?;
    /// tracker.begin(&model, &start, 1)?;
    /// let estimate = tracker.step_without_table(&model, &seen);
    /// assert!((estimate.cycle_position - 0.3).abs() < 0.05);
    /// # }
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The start as [`CycleStart::check`] asks. The tracker is as before then.
    pub fn begin(&mut self, model: &MotionModel<'_>, start: &CycleStart<N>, seed: u64) -> Result<(), ParameterError> {
        start.check()?;
        (self.seed, self.frame) = (seed, 0);
        if self.options.spread == Spread::UniformPosition {
            fill_positions(model, start, &mut self.weights);
        }
        for (index, particle) in self.particles.iter_mut().enumerate().take(self.count) {
            *particle = first_particle(model, &self.weights, start, &self.options, (seed, index as u32));
        }
        self.last = start.estimate();
        Ok(())
    }

    /// One frame: predict, weigh, estimate, resample.
    pub fn step(
        &mut self,
        model: &MotionModel<'_>,
        tables: ParticleTables<'_>,
        measurement: &AngleMeasurement<N>,
    ) -> CyclicEstimate<N> {
        self.step_by(model, &mut ParticleTable::new(model, tables.factors), measurement)
    }

    /// As [`Self::step`], to the bit, without the table of 83 KB: the factors of the model's
    /// covariances are computed where particles need them, for a third more instructions.
    pub fn step_without_table(
        &mut self,
        model: &MotionModel<'_>,
        measurement: &AngleMeasurement<N>,
    ) -> CyclicEstimate<N> {
        self.step_by(model, &mut ComputedFactors::new(model), measurement)
    }

    #[inline(always)]
    fn step_by(
        &mut self,
        model: &MotionModel<'_>,
        table: &mut impl Accelerations<N>,
        measurement: &AngleMeasurement<N>,
    ) -> CyclicEstimate<N> {
        self.frame += 1;
        let target = ParticleTarget::new(measurement, model.angle_count(), &self.last);
        let mut shares = [WeightShare::NOTHING; MAX_CHUNKS];
        self.sweep((model, table), &target, measurement.step_frames(), &mut shares);
        let mut estimate = self.all.estimate(&target);
        count_turns(&mut estimate, &self.last);
        if measurement.present(model.angle_count()) > 0 {
            let share = self.all.share();
            estimate.log_likelihood = log_likelihood(measurement, model.angle_count(), share, self.count);
            self.resample(share, &shares);
        }
        self.last = estimate;
        estimate
    }

    /// The particles after the last step, equally likely where it had a measurement.
    #[must_use]
    pub fn particles(&self) -> &[CyclicParticle<N>] {
        self.particles.get(..self.count).unwrap_or_default()
    }

    /// The last estimate; after [`Self::begin`] the start.
    #[must_use]
    pub const fn estimate(&self) -> &CyclicEstimate<N> {
        &self.last
    }

    /// Moves, weighs and sums all particles, and writes each chunk's share of the weights.
    #[inline(always)]
    fn sweep(
        &mut self,
        (model, table): (&MotionModel<'_>, &mut impl Accelerations<N>),
        target: &ParticleTarget<N>,
        step_frames: f32,
        shares: &mut [WeightShare; MAX_CHUNKS],
    ) {
        self.all.clear();
        for (chunk, share) in (0..self.count.div_ceil(CHUNK)).zip(shares) {
            let first = chunk * CHUNK;
            let range = first..self.count.min(first + CHUNK);
            let Some(particles) = self.particles.get_mut(range.clone()) else { break };
            let weights = self.weights.get_mut(range).unwrap_or_default();
            let key = (self.seed, self.frame, first as u32);
            let (seen, chunk) = ((target, step_frames), (particles, weights));
            sweep_by((model, table), &self.options, seen, key, chunk, &mut self.memory);
            self.all.merge(&self.memory.moments);
            *share = self.memory.moments.share();
        }
    }

    /// The next generation, chunk by chunk.
    fn resample(&mut self, all: WeightShare, shares: &[WeightShare; MAX_CHUNKS]) {
        let count = self.count;
        let comb = Comb::new(all, resampling_offset(self.seed, self.frame), count);
        let shares = shares.get(..count.div_ceil(CHUNK)).unwrap_or_default();
        let mut rest: &mut [CyclicParticle<N>] = &mut self.next;
        let particles = self.particles.get(..count).unwrap_or_default();
        let chunks = particles.chunks(CHUNK).zip(self.weights.chunks(CHUNK));
        for ((particles, weights), teeth) in chunks.zip(comb.teeth(shares)) {
            let (next, others) = rest.split_at_mut_checked(teeth.count).unwrap_or_default();
            comb.choose(particles, weights, &teeth, next);
            rest = others;
        }
        // Not exchanged: that would take a copy of all particles on the stack.
        for (particle, next) in self.particles.iter_mut().zip(&self.next) {
            *particle = *next;
        }
    }
}

impl<const N: usize, const P: usize> SavedState for ParticleTracker<N, P> {
    /// A state is for a tracker with as many particles. The next generation and the weights are
    /// written before they are read.
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.long(&mut self.seed);
        visitor.long(&mut self.frame);
        for particle in self.particles.iter_mut().take(self.count) {
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

    /// Both from the start that needs positions, with particles left over and gaps.
    #[test]
    fn steps_without_a_table_have_the_bits_of_those_with_one() {
        let table = synthetic::table(4.0e-3, 9);
        let model = table.model().unwrap();
        let (mut factors, mut positions) = (vec![0.0; factors_len(&model)], vec![0.0; model.position_count()]);
        fill_factors(&model, &mut factors);
        let pose = |frame: u8| core::array::from_fn(|i| Some(synthetic::mean_angle(i, f32::from(frame) / 65.0)));
        let start = CycleStart::<13>::standard(&model, &pose(0), None, None).unwrap();
        fill_positions(&model, &start, &mut positions);
        let tables = ParticleTables { factors: &factors, positions: &positions };
        let options = ParticleOptions { spread: Spread::UniformPosition, ..ParticleOptions::default() };
        let mut with = Box::new(ParticleTracker::<13, 70>::new(&model, tables, options, &start, 5));
        let mut without = Box::new(ParticleTracker::<13, 100>::empty());
        assert!(without.configure(options, 101).is_err() && without.configure(options, 0).is_err());
        without.configure(options, 70).unwrap();
        for _ in 0..2 {
            without.begin(&model, &start, 5).unwrap();
            let mut with = with.clone();
            for frame in 1..=65_u8 {
                let measurement = match frame {
                    20..25 => AngleMeasurement::nothing(),
                    _ => AngleMeasurement::new(&pose(frame), 0.3).unwrap(),
                };
                let measurement = measurement.after(if frame == 40 { 2.5 } else { 1.0 }).unwrap();
                let found = without.step_without_table(&model, &measurement);
                assert_eq!(found, with.step(&model, tables, &measurement), "frame {frame}");
            }
            assert!(with.particles() == without.particles());
        }
        with.step(&model, tables, &AngleMeasurement::nothing());
    }

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
