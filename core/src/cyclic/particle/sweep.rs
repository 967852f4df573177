//! A frame's work on the particles: move, weigh and sum them, chunk by chunk.
//!
//! What is done for each particle is inlined into [`sweep`], so that a caller may compile it for wider vectors than its target
//! has: the bits stay the same, as every operation is one of single numbers.
//!
//! A chunk's result depends on its particles alone and chunks are added in their order: the bits are the same however the
//! chunks are spread over threads.

use crate::cyclic::particle::angle_blocks::AngleBlocks;
use crate::cyclic::particle::factors::ParticleTable;
use crate::cyclic::particle::moments::ParticleMoments;
use crate::cyclic::particle::propose::{CyclicParticle, ParticleOptions, advance};
use crate::cyclic::particle::resample::exponentiate;
use crate::cyclic::substeps::Substeps;
use crate::cyclic::{AngleMeasurement, CyclicEstimate, MotionModel};
use crate::math::{least_angle, wrap_angle};
use crate::random::StreamLanes;
use crate::random::lanes::LANES;

/// Particles whose sums are taken together.
pub const CHUNK: usize = 1024;

/// What a frame's particles are compared with: the measured angles, and the last estimate's where none was seen.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// # use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::particle::propose::{ParticleOptions, first_particle};
/// use sinew_core::cyclic::particle::sweep::{ParticleTarget, sweep};
/// use sinew_core::cyclic::{AngleMeasurement, CycleStart};
///
/// # let model = WALKING.model()?;
/// # let start = CycleStart::<13>::standard(&model, &[Some(0.0); 13], Some(0.3), None)?;
/// // Nothing was seen but the first angle, so two particles that differ in another one weigh the same.
/// let mut angles_rad = [None; 13];
/// angles_rad[0] = Some(0.1);
/// let target = ParticleTarget::new(&AngleMeasurement::new(&angles_rad, 0.1)?, 13, &start.estimate());
/// let options = ParticleOptions::default();
/// let mut particles = [first_particle(&model, &[], &start, &options, (1, 0)); 2];
/// particles[1].angles_rad[4] += 0.5;
/// let mut weights = [0.0; 2];
/// sweep(&model, &[], &options, (&target, 1.0), (1, 1, 0), &mut particles, &mut weights);
/// assert_eq!(weights, [1.0, 1.0]);
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct ParticleTarget<const N: usize> {
    pub(super) angles_rad: [f32; N],
    /// Zero where nothing was seen, so that weighing needs no question.
    root_precision: [f32; N],
    pub(super) cycle_position: f32,
    pub(super) cycle_velocity: f32,
}

impl<const N: usize> ParticleTarget<N> {
    /// The target of a frame after `last`.
    #[must_use]
    pub fn new(measurement: &AngleMeasurement<N>, angle_count: usize, last: &CyclicEstimate<N>) -> Self {
        let mut target = Self {
            angles_rad: last.angles_rad.map(wrap_angle),
            root_precision: [0.0; N],
            cycle_position: last.cycle_position,
            cycle_velocity: last.cycle_velocity_per_frame,
        };
        for i in 0..N.min(angle_count) {
            if let Some(measured) = measurement.angle_rad(i) {
                target.angles_rad[i] = wrap_angle(measured);
                target.root_precision[i] = 1.0 / measurement.std_rad()[i];
            }
        }
        target
    }
}

/// Up to [`LANES`] particles relative to a target, number by number side by side.
pub(super) struct ParticleLanes<const N: usize> {
    /// Angles less the target's, in [-pi, pi].
    pub(super) off_rad: [[f32; LANES]; N],
    /// Cycle positions less the target's.
    pub(super) lead: [f32; LANES],
    /// Cycle velocities less the target's.
    pub(super) haste: [f32; LANES],
    /// Log-weights; negative infinity where there is no particle.
    pub(super) log_weights: [f32; LANES],
}

impl<const N: usize> ParticleLanes<N> {
    const fn empty() -> Self {
        Self { off_rad: [[0.0; LANES]; N], lead: [0.0; LANES], haste: [0.0; LANES], log_weights: [0.0; LANES] }
    }

    /// Takes `particles` and compares them with `target`.
    #[inline(always)]
    fn take(&mut self, particles: &[CyclicParticle<N>], target: &ParticleTarget<N>) {
        for (lane, particle) in particles.iter().enumerate().take(LANES) {
            for i in 0..N {
                self.off_rad[i][lane] = particle.angles_rad[i];
            }
            self.lead[lane] = particle.cycle_position - target.cycle_position;
            self.haste[lane] = particle.cycle_velocity - target.cycle_velocity;
        }
        let mut squares = [0.0; LANES];
        for i in 0..N {
            let (angle, root_precision) = (target.angles_rad[i], target.root_precision[i]);
            for (off, square) in self.off_rad[i].iter_mut().zip(&mut squares) {
                *off = least_angle(*off - angle);
                let scaled = *off * root_precision;
                *square += scaled * scaled;
            }
        }
        self.log_weights = squares.map(|square| -0.5 * square);
        for nobody in self.log_weights.iter_mut().skip(particles.len()) {
            *nobody = f32::NEG_INFINITY;
        }
    }
}

/// Moves `particles`, of which the first has number `first_index`, over the measurement's step. Writes their weights relative to
/// the greatest and returns their sums.
///
/// `factors` is what [`crate::cyclic::particle::factors::fill_factors`] wrote; `key` is (seed, frame, `first_index`).
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// # use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::particle::propose::{ParticleOptions, fill_factors, first_particle};
/// use sinew_core::cyclic::particle::sweep::{ParticleTarget, sweep};
/// use sinew_core::cyclic::{AngleMeasurement, CycleStart};
///
/// # let model = WALKING.model()?;
/// # let start = CycleStart::<13>::standard(&model, &[Some(0.0); 13], Some(0.3), None)?;
/// # let seen = AngleMeasurement::new(&[Some(0.05); 13], 0.1)?;
/// # let mut factors = [0.0; 20_800];
/// # fill_factors(&model, &mut factors);
/// // The first frame of a hundred particles, under seed 1.
/// let options = ParticleOptions::default();
/// let draw = |index: usize| first_particle(&model, &[], &start, &options, (1, index as u32));
/// let mut particles = core::array::from_fn::<_, 100, _>(draw);
/// let target = ParticleTarget::new(&seen, 13, &start.estimate());
/// let mut weights = [0.0; 100];
/// let moments = sweep(&model, &factors, &options, (&target, 1.0), (1, 1, 0), &mut particles, &mut weights);
/// assert!((moments.share().weight - weights.iter().sum::<f32>()).abs() < 1e-3);
/// assert!(weights.iter().all(|weight| (0.0..=1.0).contains(weight)), "relative to the greatest");
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[inline(always)]
pub fn sweep<const N: usize>(
    model: &MotionModel<'_>,
    factors: &[f32],
    options: &ParticleOptions,
    (target, step_frames): (&ParticleTarget<N>, f32),
    key: (u64, u64, u32),
    particles: &mut [CyclicParticle<N>],
    weights: &mut [f32],
) -> ParticleMoments<N> {
    let (seed, frame, first_index) = key;
    let table = ParticleTable::new(model, factors);
    let mut draws = [AngleBlocks::default(); LANES];
    let mut lanes = ParticleLanes::empty();
    let mut moments = ParticleMoments::nothing();
    let blocks = particles.chunks_mut(LANES).zip(weights.chunks_mut(LANES));
    for (block, (particles, log_weights)) in blocks.enumerate() {
        let mut streams = StreamLanes::new(seed, frame, first_index.wrapping_add((block * LANES) as u32));
        for step in Substeps::of(step_frames) {
            let random = (&mut streams, &mut draws);
            advance(model, &table, options.temporal_acceleration_std, step, random, particles);
        }
        lanes.take(particles, target);
        for (log_weight, value) in log_weights.iter_mut().zip(&lanes.log_weights) {
            *log_weight = *value;
        }
        moments.add(&lanes);
    }
    let weight = exponentiate(moments.share().greatest_log_weight, weights);
    moments.weighing(weight)
}
