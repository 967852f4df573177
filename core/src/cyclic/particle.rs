//! The particle filter of the cyclic paper, section 3.3: stages that work on slices, so that a caller may split them.
//!
//! Each particle draws from its own stream, and sums are taken over chunks of [`CHUNK`] particles whose results are added
//! in order: the result has the same bits however the chunks are spread over threads.

use super::angle_blocks::{AngleBlocks, BLOCK, blocks_of, used_blocks, write_back};
use super::particle_table::ParticleTable;
use super::phase::wrap_position;
use super::start::{CycleStart, LEAST_SPREAD_RAD};
use super::substeps::Substeps;
use super::{AngleMeasurement, MotionModel};
use crate::angle::angle_difference;
use crate::math::{clamp, exp_small, least_angle, max, sqrt, wrap_angle, wrap_angle_small};
use crate::random::lanes::LANES;
use crate::random::{Stream, StreamLanes};
use core::f32::consts::PI;

pub use super::particle_table::{factors_len, fill_factors};

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
    /// Any position of the cycle, as far as the first pose allows (see [`fill_positions`]), each particle with the mean
    /// velocities of its own position.
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

/// Particle number `index` of the first generation.
///
/// `positions` says where in the cycle a uniform start may be, as [`fill_positions`] wrote it; the other starts do not read it.
#[must_use]
pub fn first_particle<const N: usize>(
    model: &MotionModel<'_>,
    positions: &[f32],
    start: &CycleStart<N>,
    options: &ParticleOptions,
    (seed, index): (u64, u32),
) -> CyclicParticle<N> {
    let mut stream = Stream::new(seed, 0, index);
    let mut particle = CyclicParticle {
        angles_rad: start.angles_rad.map(wrap_angle),
        velocities: start.velocities,
        cycle_position: start.cycle_position,
        cycle_velocity: start.cycle_velocity + options.velocity_std * stream.normal(),
    };
    if options.spread == Spread::UniformPosition {
        particle.cycle_position = drawn_position(positions, stream.uniform());
        let ratio = model.speed_ratio(particle.cycle_velocity);
        let point = model.point(particle.cycle_position);
        particle.velocities = model.mean_velocity::<N>(point).map(|velocity| ratio * velocity);
    }
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
    match options.spread {
        Spread::Standard => {
            particle.cycle_position = wrap_position(start.cycle_position + options.position_std * stream.normal());
        }
        Spread::Random => particle.cycle_position = stream.uniform(),
        Spread::UniformPosition => {}
    }
    particle
}

/// Writes how far a uniform start is spread over the model's stored positions, as running sums: each has a weight by how well
/// its mean pose, with the model's spread between people, agrees with the angles that the first frame shows.
///
/// Every position is as likely as any other before the first frame, which is known when the particles are drawn. Without any
/// angle seen, or a spread in the model, the sums rise evenly. `positions` has one number for each stored position.
pub fn fill_positions<const N: usize>(model: &MotionModel<'_>, start: &CycleStart<N>, positions: &mut [f32]) {
    let spread = model.deviation_std_rad::<N>();
    let count = model.position_count() as f32;
    for (index, value) in positions.iter_mut().enumerate() {
        let pose = model.mean_pose_rad::<N>(model.point(index as f32 / count));
        let mut squared = 0.0;
        for i in (0..N.min(model.angle_count())).filter(|&i| start.extra_variance_rad2[i] == 0.0 && spread[i] > 0.0) {
            let scaled = angle_difference(start.angles_rad[i], pose[i]) / max(spread[i], LEAST_SPREAD_RAD);
            squared += scaled * scaled;
        }
        *value = -0.5 * squared;
    }
    let best = greatest(positions);
    let mut sum = 0.0;
    for value in positions {
        sum += crate::math::exp(*value - best);
        *value = sum;
    }
}

/// The position at which the running sums reach `uniform` of their last; `uniform` itself without sums.
fn drawn_position(sums: &[f32], uniform: f32) -> f32 {
    let Some(&total) = sums.last() else { return uniform };
    let wanted = uniform * total;
    let index = sums.partition_point(|&sum| sum <= wanted).min(sums.len() - 1);
    let below = if index == 0 { 0.0 } else { sums.get(index - 1).copied().unwrap_or(0.0) };
    let weight = sums.get(index).map_or(0.0, |sum| sum - below);
    let part = if weight > 0.0 { (wanted - below) / weight } else { 0.5 };
    // A stored position stands for what is nearer to it than to its neighbours.
    wrap_position((index as f32 + part - 0.5) / sums.len() as f32)
}

/// A draw for each of up to [`LANES`] particles from the transition of eq. (11) over `step` <= 1 frame.
///
/// Between two stored positions the noise is that of one of them, drawn with the probabilities of linear
/// interpolation: the covariance is then exactly the interpolated one.
#[inline]
fn advance<const N: usize>(
    model: &MotionModel<'_>,
    table: &ParticleTable<'_>,
    temporal_std: f32,
    step: f32,
    (streams, draws): (&mut StreamLanes, &mut [AngleBlocks; LANES]),
    particles: &mut [CyclicParticle<N>],
) {
    let noise_factor = if step < 1.0 { 1.0 / sqrt(step) } else { 1.0 };
    let side = streams.uniform();
    for i in 0..model.angle_count().min(MAX_ANGLES) {
        let drawn = streams.normal();
        for lane in 0..LANES {
            draws[lane].as_flattened_mut()[i] = drawn[lane];
        }
    }
    let temporal = streams.normal();
    let temporal_scale = temporal_std * noise_factor;
    for (lane, particle) in particles.iter_mut().enumerate().take(LANES) {
        let point = model.point(particle.cycle_position);
        let ratio = model.speed_ratio(particle.cycle_velocity);
        let squared_ratio = ratio * ratio;
        let place = if side[lane] < point.fraction { point.after } else { point.before };
        let accelerations = table.accelerations(
            (point.before, point.after, point.fraction),
            place,
            (squared_ratio, squared_ratio * noise_factor),
            &draws[lane],
        );
        particle.move_by(&accelerations, temporal_scale * temporal[lane], step);
    }
}

impl<const N: usize> CyclicParticle<N> {
    /// Moves angles and cycle over `step` with constant accelerations. An angle beyond the model's keeps its velocity.
    #[inline]
    fn move_by(&mut self, accelerations: &AngleBlocks, temporal: f32, step: f32) {
        let half_square = 0.5 * step * step;
        let (mut angles, mut velocities) = (blocks_of(&self.angles_rad), blocks_of(&self.velocities));
        for block in 0..const { used_blocks::<N>() } {
            let (angle, velocity, acceleration) = (&mut angles[block], &mut velocities[block], &accelerations[block]);
            for i in 0..BLOCK {
                angle[i] = wrap_angle_small(angle[i] + step * velocity[i] + half_square * acceleration[i]);
                velocity[i] = clamp(velocity[i] + step * acceleration[i], -PI, PI);
            }
        }
        write_back(&angles, &mut self.angles_rad);
        write_back(&velocities, &mut self.velocities);
        let position = self.cycle_position + step * self.cycle_velocity + half_square * temporal;
        self.cycle_position = wrap_position(position);
        self.cycle_velocity += step * temporal;
    }
}

/// Measured angles with a precision of zero where nothing was seen, so that weighing needs no question.
struct Target<const N: usize> {
    angles_rad: AngleBlocks,
    root_precision: AngleBlocks,
}

impl<const N: usize> Target<N> {
    fn new(measurement: &AngleMeasurement<N>, angle_count: usize) -> Self {
        let (mut angles_rad, mut root_precision) = ([0.0; N], [0.0; N]);
        for i in 0..N.min(angle_count) {
            if let Some(measured) = measurement.angle_rad(i) {
                angles_rad[i] = wrap_angle(measured);
                root_precision[i] = 1.0 / measurement.std_rad()[i];
            }
        }
        Self { angles_rad: blocks_of(&angles_rad), root_precision: blocks_of(&root_precision) }
    }

    /// -1/2 of the sum of squared differences in standard deviations, summed in four parts.
    #[inline]
    fn log_weight(&self, angles_rad: &[f32; N]) -> f32 {
        let angles = blocks_of(angles_rad);
        let mut sums = [0.0; BLOCK];
        for block in 0..const { used_blocks::<N>() } {
            for i in 0..BLOCK {
                let difference = least_angle(self.angles_rad[block][i] - angles[block][i]);
                let scaled = difference * self.root_precision[block][i];
                sums[i] += scaled * scaled;
            }
        }
        -0.5 * ((sums[0] + sums[1]) + (sums[2] + sums[3]))
    }
}

/// Moves `particles`, of which the first has number `first_index`, over the measurement's step and writes their log-weights.
///
/// `factors` is what [`super::particle_table::fill_factors`] wrote; `key` is (seed, frame, `first_index`).
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
    let table = ParticleTable::new(model, factors);
    let target = Target::new(measurement, model.angle_count());
    let mut draws = [AngleBlocks::default(); LANES];
    let blocks = particles.chunks_mut(LANES).zip(log_weights.chunks_mut(LANES));
    for (block, (particles, log_weights)) in blocks.enumerate() {
        let mut streams = StreamLanes::new(seed, frame, first_index.wrapping_add((block * LANES) as u32));
        for step in Substeps::of(measurement.step_frames()) {
            let random = (&mut streams, &mut draws);
            advance(model, &table, options.temporal_acceleration_std, step, random, particles);
        }
        for (particle, log_weight) in particles.iter().zip(log_weights) {
            *log_weight = target.log_weight(&particle.angles_rad);
        }
    }
}

/// Turns log-weights into weights relative to `greatest` and returns their sum, taken in eight parts; NaN weighs nothing.
pub fn exponentiate(greatest: f32, weights: &mut [f32]) -> f32 {
    let weight = |log_weight: f32| {
        let below = log_weight - greatest;
        let value = exp_small(below);
        if below > -40.0 { value } else { 0.0 }
    };
    let mut sums = [0.0; 8];
    let (eights, rest) = weights.as_chunks_mut::<8>();
    for eight in eights {
        for i in 0..8 {
            eight[i] = weight(eight[i]);
            sums[i] += eight[i];
        }
    }
    let mut sum = 0.0;
    for value in rest {
        *value = weight(*value);
        sum += *value;
    }
    sums.iter().fold(sum, |all, part| all + part)
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
        let mut factors = vec![0.0; factors_len(&model)];
        fill_factors(&model, &mut factors);
        let first = core::array::from_fn(|i| Some(synthetic::mean_angle(i, 0.0)));
        let start = CycleStart::standard(&model, &first, Some(0.0), None).unwrap();
        let mut positions = vec![0.0; model.position_count()];
        fill_positions(&model, &start, &mut positions);
        let first = |i| first_particle(&model, &positions, &start, options, (3, i as u32));
        let mut particles: Vec<_> = (0..count).map(first).collect();
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
