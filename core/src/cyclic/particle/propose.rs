//! The particle filter of the cyclic paper, section 3.3: stages that work on slices, so that a
//! caller may split them.
//!
//! Each particle draws from its own stream. [`crate::cyclic::particle::sweep`] moves, weighs and
//! sums them, [`crate::cyclic::particle::resample`] chooses the next generation.

use crate::angle::angle_difference;
use crate::cyclic::MotionModel;
use crate::cyclic::particle::angle_blocks::{AngleBlocks, BLOCK, blocks_of, used_blocks, write_back};
use crate::cyclic::particle::factors::Accelerations;
use crate::cyclic::phase::{POSITIONS_IN_CYCLE, wrap_position};
use crate::cyclic::saved_ranges::NUMBER;
use crate::cyclic::start::{CycleStart, MIN_SPREAD_RAD};
use crate::math::{clamp, max, sqrt, wrap_angle, wrap_angle_small};
use crate::random::lanes::LANES;
use crate::random::{Stream, StreamLanes};
use crate::saved_state::{SavedState, StateVisitor};
use core::f32::consts::PI;

pub use crate::cyclic::particle::factors::{factors_len, fill_factors};

/// Most angles of a particle.
const MAX_ANGLES: usize = crate::cyclic::model::coupled_model::MAX_ANGLES;

/// One hypothesis: the paper's state vector.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// # use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::particle::propose::{CyclicParticle, ParticleOptions, first_particle};
/// use sinew_core::cyclic::{CycleStart, MotionModel};
///
/// /// How far a hypothesis has the first angle off the mean cycle at its own position.
/// fn off_rad(model: &MotionModel<'_>, particle: &CyclicParticle<13>) -> f32 {
///     let [mean_rad, ..] = model.mean_pose_rad::<13>(model.point(particle.cycle_position));
///     (particle.angles_rad[0] - mean_rad).abs()
/// }
///
/// # let model = WALKING.model()?;
/// let pose_rad = model.mean_pose_rad::<13>(model.point(0.3));
/// let start = CycleStart::standard(&model, &pose_rad.map(Some), Some(0.3), None)?;
/// let particle = first_particle(&model, &[], &start, &ParticleOptions::default(), (1, 0));
/// assert!(off_rad(&model, &particle) < 0.1);
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
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
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// # use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::CycleStart;
/// use sinew_core::cyclic::particle::propose::{ParticleOptions, Spread, first_particle};
///
/// # let model = WALKING.model()?;
/// # let start = CycleStart::<13>::standard(&model, &[Some(0.0); 13], Some(0.5), None)?;
/// // How many of a hundred particles begin in the half of the cycle about the start at 0.5.
/// let near = |spread| {
///     let options = ParticleOptions { spread, ..ParticleOptions::default() };
///     let position = |index| first_particle(&model, &[], &start, &options, (1, index)).cycle_position;
///     (0..100).filter(|&index| (0.25..0.75).contains(&position(index))).count()
/// };
/// assert_eq!(near(Spread::Standard), 100);
/// assert!((30..70).contains(&near(Spread::Random)));
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Spread {
    /// About the start, with the standard deviations of [`ParticleOptions`].
    #[default]
    Standard,
    /// Any position of the cycle, as far as the first pose allows (see [`fill_positions`]), each
    /// particle with the mean velocities of its own position.
    UniformPosition,
    /// Angles and velocities uniform in [-pi, pi], cycle position uniform: the paper's random
    /// start.
    Random,
}

/// Options of the particle filter.
///
/// ```
/// use sinew_core::cyclic::KalmanOptions;
/// use sinew_core::cyclic::particle::propose::{ParticleOptions, Spread};
///
/// // By default the first angles have the variance of the Kalman filters.
/// let (particles, kalman) = (ParticleOptions::default(), KalmanOptions::default());
/// assert!((particles.start_std * particles.start_std / kalman.angle_variance - 1.0).abs() < 1e-5);
/// // An unknown phase: positions by the first frame, with a standard deviation of 20 % in speed.
/// let anywhere = ParticleOptions { spread: Spread::UniformPosition, velocity_std: 0.2 / 64.0, ..particles };
/// assert!(anywhere.velocity_std > particles.velocity_std);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParticleOptions {
    /// How the first particles are spread.
    pub spread: Spread,
    /// First standard deviation of each angle (rad), and of the velocity (rad per frame) of an
    /// angle without deviation in the model.
    pub start_std: f32,
    /// First standard deviation of each other velocity, as a share of
    /// `deviation_velocity_std` of the model.
    pub deviation_velocity_share: f32,
    /// First standard deviation of the cycle position, cycles.
    pub position_std: f32,
    /// First standard deviation of the cycle velocity, cycles per frame.
    pub velocity_std: f32,
    /// Standard deviation of the temporal acceleration, cycles per frame^2.
    pub temporal_acceleration_std: f32,
}

impl Default for ParticleOptions {
    /// The angles' first variance is the Kalman filters', the other spreads are those between
    /// people (`docs/cyclic_tracker.md`).
    fn default() -> Self {
        Self {
            spread: Spread::Standard,
            start_std: 1.0e-2,
            deviation_velocity_share: 0.6,
            position_std: 3.0e-2,
            velocity_std: 1.5e-3,
            temporal_acceleration_std: 8.0e-4,
        }
    }
}

impl ParticleOptions {
    /// No spread at all, all zeros.
    pub(super) const NOTHING: Self = Self {
        spread: Spread::Standard,
        start_std: 0.0,
        deviation_velocity_share: 0.0,
        position_std: 0.0,
        velocity_std: 0.0,
        temporal_acceleration_std: 0.0,
    };

    /// First standard deviation of each angle's velocity, rad per frame.
    fn first_velocity_std<const N: usize>(&self, model: &MotionModel<'_>) -> [f32; N] {
        model
            .deviation_velocity_std::<N>()
            .map(|std| if std > 0.0 { self.deviation_velocity_share * std } else { self.start_std })
    }
}

/// Particle number `index` of the first generation.
///
/// `positions` holds the running sums of [`fill_positions`] for a uniform start; the other starts
/// ignore it.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::CycleStart;
/// use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::particle::propose::{ParticleOptions, first_particle};
///
/// let model = WALKING.model()?;
/// let start = CycleStart::<13>::standard(&model, &[Some(0.2); 13], Some(0.5), None)?;
/// // Particle 7 under seed 1 does not depend on the order of the draws.
/// let draw = |seed, index| first_particle(&model, &[], &start, &ParticleOptions::default(), (seed, index));
/// assert_eq!(draw(1, 7), draw(1, 7));
/// assert!(draw(1, 7) != draw(1, 8) && draw(1, 7) != draw(2, 7));
/// assert!((draw(1, 7).angles_rad[0] - 0.2).abs() < 0.07, "a hundredth of a radian of spread");
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
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
    let velocity_std = options.first_velocity_std::<N>(model);
    for i in 0..N {
        if options.spread == Spread::Random {
            particle.angles_rad[i] = wrap_angle(PI * (2.0 * stream.uniform() - 1.0));
            particle.velocities[i] = PI * (2.0 * stream.uniform() - 1.0);
        } else {
            let std = sqrt(options.start_std * options.start_std + start.extra_variance_rad2[i]);
            particle.angles_rad[i] = wrap_angle(particle.angles_rad[i] + std * stream.normal());
            particle.velocities[i] += velocity_std[i] * stream.normal();
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

/// Writes how far a uniform start is spread over the model's stored positions, as running sums. A
/// position's weight says how well its mean pose agrees with the angles that the first frame shows,
/// given the model's spread between people.
///
/// Every position is as likely as any other before the first frame, which is known when the
/// particles are drawn. Without any angle seen, or a spread in the model, the sums rise evenly.
/// `positions` has one number for each stored position; where it has another number of them, they
/// lie evenly in the cycle.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::CycleStart;
/// use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::particle::propose::fill_positions;
///
/// // A first picture of the pose at 0.3: nearly all of the weight lies about there.
/// let model = WALKING.model()?;
/// let first_rad = model.mean_pose_rad::<13>(model.point(0.3)).map(Some);
/// let start = CycleStart::standard(&model, &first_rad, None, None)?;
/// let mut sums = [0.0; 100];
/// fill_positions(&model, &start, &mut sums);
/// assert!((sums[40] - sums[20]) / sums[99] > 0.9);
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub fn fill_positions<const N: usize>(model: &MotionModel<'_>, start: &CycleStart<N>, positions: &mut [f32]) {
    let spread = model.deviation_std_rad::<N>();
    let count = positions.len() as f32;
    for (index, value) in positions.iter_mut().enumerate() {
        let pose = model.mean_pose_rad::<N>(model.point(index as f32 / count));
        let mut squared = 0.0;
        for i in 0..N {
            if i >= model.angle_count() || start.extra_variance_rad2[i] != 0.0 || !(spread[i] > 0.0) {
                continue;
            }
            let scaled = angle_difference(start.angles_rad[i], pose[i]) / max(spread[i], MIN_SPREAD_RAD);
            squared += scaled * scaled;
        }
        *value = -0.5 * squared;
    }
    let best = crate::cyclic::particle::weights::greatest(positions);
    let mut sum = 0.0;
    for value in positions {
        sum += crate::math::exp(*value - best);
        *value = sum;
    }
}

/// The position at which the running sums reach `uniform` of their last; `uniform` itself without
/// sums.
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

/// A draw for each of up to [`LANES`] particles from the transition of cyclic (11) over `step` <= 1
/// frame.
///
/// Between two stored positions the noise is that of one of them, drawn with the probabilities of
/// linear interpolation. The covariance is then exactly the interpolated one.
#[inline(always)]
pub(super) fn advance<const N: usize>(
    model: &MotionModel<'_>,
    table: &mut impl Accelerations<N>,
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
    // All points of the model first, so that a processor prefetches them.
    let mut points = [model.point(0.0); LANES];
    for (point, particle) in points.iter_mut().zip(particles.iter()) {
        *point = model.point(particle.cycle_position);
    }
    for (lane, particle) in (0..LANES).zip(particles) {
        let point = points[lane];
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

impl<const N: usize> SavedState for CyclicParticle<N> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.reals(&mut self.angles_rad, &(-PI..=PI));
        visitor.reals(&mut self.velocities, &NUMBER);
        visitor.real(&mut self.cycle_position, &POSITIONS_IN_CYCLE);
        visitor.real(&mut self.cycle_velocity, &NUMBER);
    }
}

impl<const N: usize> CyclicParticle<N> {
    /// Moves angles and cycle over `step` with constant accelerations. An angle beyond the model's
    /// keeps its velocity.
    #[inline(always)]
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::synthetic;
    use crate::cyclic::{Deviation, ModelParts};

    #[test]
    fn first_velocities_spread_as_far_as_the_models_people_differ() {
        const COUNT: u32 = 4096;
        let table = synthetic::table(4.0e-3, 9);
        let of = |deviation| MotionModel::new(ModelParts { deviation, ..table.model().unwrap().parts() }).unwrap();
        let unknown = of(Deviation::default());
        let known = of(Deviation {
            offset_std_rad: &[0.1; 13],
            cosine_std_rad: &[0.2; 13],
            sine_std_rad: &[0.2; 13],
            rest_std_rad: &[0.05; 13],
            rest_rate_per_cycle: &[20.0; 13],
        });
        // A swing of 0.2 rad moves by 1.26 rad in a cycle, the rest by 1; a person's velocity by
        // six tenths of both.
        let of_people = 0.6 * 1.26_f32.hypot(1.0) * known.mean_cycle_velocity();
        for (model, wanted) in [(unknown, 0.01), (known, of_people)] {
            let start = CycleStart::<13>::standard(&model, &[Some(0.0); 13], Some(0.3), None).unwrap();
            let options = ParticleOptions::default();
            let particles: Vec<_> =
                (0..COUNT).map(|index| first_particle(&model, &[], &start, &options, (1, index))).collect();
            for i in 0..13 {
                let squares = particles.iter().map(|particle| (particle.velocities[i] - start.velocities[i]).powi(2));
                let std = (squares.sum::<f32>() / COUNT as f32).sqrt();
                assert!((std / wanted - 1.0).abs() < 0.06, "angle {i}: {std} for {wanted}");
            }
        }
    }

    /// The transition's mean and spread are those of cyclic (11): particles that starts at one
    /// point.
    #[test]
    fn particles_move_with_the_mean_acceleration_and_spread_with_the_models_covariance() {
        const COUNT: usize = 4096;
        let table = synthetic::table(4.0e-3, 9);
        let model = table.model().unwrap();
        let mut factors = vec![0.0; factors_len(&model)];
        fill_factors(&model, &mut factors);
        let mut particle_table = crate::cyclic::particle::factors::ParticleTable::new(&model, &factors);
        let first =
            CyclicParticle { angles_rad: [0.2; 13], velocities: [0.0; 13], cycle_position: 0.3, cycle_velocity: 0.01 };
        let mut particles = vec![first; COUNT];
        let mut draws = [AngleBlocks::default(); LANES];
        for (block, particles) in particles.chunks_mut(LANES).enumerate() {
            let mut streams = StreamLanes::new(4, 1, (block * LANES) as u32);
            advance(&model, &mut particle_table, 0.0, 1.0, (&mut streams, &mut draws), particles);
        }
        let mean = model.mean_acceleration::<13>(model.point(0.3));
        let position = (0.3 * model.position_count() as f32) as usize;
        for i in 0..13 {
            let moved: Vec<f32> = particles.iter().map(|particle| particle.velocities[i]).collect();
            let average = moved.iter().sum::<f32>() / COUNT as f32;
            let variance = moved.iter().map(|v| (v - average) * (v - average)).sum::<f32>() / COUNT as f32;
            let packed = crate::numeric::semi_definite::packed_index(i, i);
            let wanted = model.parts().acceleration_covariance[91 * position + packed];
            assert!((average - mean[i]).abs() < 5.0 * (wanted / COUNT as f32).sqrt() + 1.0e-6, "angle {i}: {average}");
            assert!((variance / wanted - 1.0).abs() < 0.12, "angle {i}: {variance} for {wanted}");
        }
    }
}
