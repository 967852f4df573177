//! A frame's work on the particles: move, weigh and sum them, chunk by chunk.
//!
//! The work for each particle is inlined into [`sweep`], so that a caller may compile it for wider
//! vectors than its target has. The bits stay the same, as every operation is one of single
//! numbers.
//!
//! A chunk's result depends on its particles alone, and chunks are added in their order. So the
//! bits are the same however the chunks are spread over threads.

use crate::cyclic::MotionModel;
use crate::cyclic::particle::angle_blocks::{AngleBlocks, BLOCK, MAX_BLOCKS};
use crate::cyclic::particle::factors::{Accelerations, ParticleTable};
use crate::cyclic::particle::moments::ParticleMoments;
use crate::cyclic::particle::propose::{CyclicParticle, ParticleOptions, advance};
use crate::cyclic::particle::weigh::{ParticleLanes, ParticleTarget};
use crate::cyclic::particle::weights::exponentiate;
use crate::cyclic::substeps::Substeps;
use crate::random::StreamLanes;
use crate::random::lanes::LANES;

/// Particles whose sums are taken together.
pub const CHUNK: usize = 1024;

/// Moves `particles`, of which the first has number `first_index`, over the measurement's step.
/// Writes their weights relative to the greatest and returns their sums.
///
/// `factors` is what [`crate::cyclic::particle::factors::fill_factors`] wrote; `key` is (seed,
/// frame, `first_index`).
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// # use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::particle::propose::{ParticleOptions, fill_factors, first_particle};
/// use sinew_core::cyclic::particle::{sweep::sweep, weigh::ParticleTarget};
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
    let table = &mut ParticleTable::new(model, factors);
    let mut memory = SweepMemory::empty();
    sweep_by((model, table), options, (target, step_frames), key, (particles, weights), &mut memory);
    memory.moments
}

/// What a sweep needs for a while, 8 KB, and its sums: on the stack of a host, in the memory of a
/// tracker for firmware.
#[derive(Debug, Clone)]
pub(super) struct SweepMemory<const N: usize> {
    draws: [AngleBlocks; LANES],
    lanes: ParticleLanes<N>,
    /// The sums of the last sweep.
    pub(super) moments: ParticleMoments<N>,
}

impl<const N: usize> SweepMemory<N> {
    /// Before the first sweep.
    pub(super) const fn empty() -> Self {
        let draws = [[[0.0; BLOCK]; MAX_BLOCKS]; LANES];
        Self { draws, lanes: ParticleLanes::empty(), moments: ParticleMoments::ZERO }
    }
}

/// As [`sweep`], with accelerations from any `table` and the sums in `memory`, which begins as it
/// was left, or empty.
#[inline(always)]
pub(super) fn sweep_by<const N: usize>(
    (model, table): (&MotionModel<'_>, &mut impl Accelerations<N>),
    options: &ParticleOptions,
    (target, step_frames): (&ParticleTarget<N>, f32),
    (seed, frame, first_index): (u64, u64, u32),
    (particles, weights): (&mut [CyclicParticle<N>], &mut [f32]),
    SweepMemory { draws, lanes, moments }: &mut SweepMemory<N>,
) {
    moments.clear();
    let blocks = particles.chunks_mut(LANES).zip(weights.chunks_mut(LANES));
    for (block, (particles, log_weights)) in blocks.enumerate() {
        let mut streams = StreamLanes::new(seed, frame, first_index.wrapping_add((block * LANES) as u32));
        for step in Substeps::of(step_frames) {
            advance(model, table, options.temporal_acceleration_std, step, (&mut streams, draws), particles);
        }
        lanes.take(particles, target);
        for (log_weight, value) in log_weights.iter_mut().zip(&lanes.log_weights) {
            *log_weight = *value;
        }
        moments.add(lanes);
    }
    let weight = exponentiate(moments.share().greatest_log_weight, weights);
    moments.weigh(weight);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::particle::factors::{factors_len, fill_factors};
    use crate::cyclic::{AngleMeasurement, synthetic};
    use std::vec;

    #[test]
    fn the_mean_across_the_seam_lies_at_the_seam() {
        let table = synthetic::table(1.0e-3, 9);
        let model = table.model().unwrap();
        let mut factors = vec![0.0; factors_len(&model)];
        fill_factors(&model, &mut factors);
        let at = |angle: f32, position: f32| CyclicParticle {
            angles_rad: [angle; 13],
            velocities: [0.0; 13],
            cycle_position: position,
            cycle_velocity: 0.0,
        };
        let start = crate::cyclic::CycleStart::standard(&model, &[Some(3.0); 13], Some(0.9), None).unwrap();
        let target = ParticleTarget::new(&AngleMeasurement::nothing(), 13, &start.estimate());
        let mut particles = [at(3.1, 0.98), at(-3.1, 0.02)];
        let options = ParticleOptions { temporal_acceleration_std: 0.0, ..ParticleOptions::default() };
        let key = (1, 1, 0);
        let moments = sweep(&model, &factors, &options, (&target, 1.0), key, &mut particles, &mut [0.0; 2]);
        let estimate = moments.estimate(&target);
        assert!((estimate.angles_rad[0].abs() - core::f32::consts::PI).abs() < 1.0e-4);
        assert!(crate::cyclic::phase::position_difference(estimate.cycle_position, 0.0).abs() < 1.0e-4);
        assert!((estimate.angle_variance_rad2[0] - 0.0416_f32.powi(2)).abs() < 1.0e-4);
    }
}
