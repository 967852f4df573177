//! Weighting: log-weights of particles by their distance from a measurement, in lanes.

use crate::cyclic::particle::propose::CyclicParticle;
use crate::cyclic::{AngleMeasurement, CyclicEstimate};
use crate::math::{least_angle, wrap_angle};
use crate::random::lanes::LANES;

/// Target of a frame's particles: the measured angles, and the last estimate's where one is
/// missing.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// # use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::particle::propose::{ParticleOptions, first_particle};
/// use sinew_core::cyclic::particle::{sweep::sweep, weigh::ParticleTarget};
/// use sinew_core::cyclic::{AngleMeasurement, CycleStart};
///
/// # let model = WALKING.model()?;
/// # let start = CycleStart::<13>::standard(&model, &[Some(0.0); 13], Some(0.3), None)?;
/// // Only the first angle is measured, so two particles that differ in another one weigh the same.
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
    /// Zero where an angle is missing, so that weighting needs no branch.
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
#[derive(Debug, Clone)]
pub(super) struct ParticleLanes<const N: usize> {
    /// Angles minus the target's, in [-pi, pi].
    pub(super) off_rad: [[f32; LANES]; N],
    /// Cycle positions minus the target's, cycles.
    pub(super) phase_offset: [f32; LANES],
    /// Cycle velocities minus the target's, cycles per frame.
    pub(super) velocity_offset: [f32; LANES],
    /// Log-weights; negative infinity where there is no particle.
    pub(super) log_weights: [f32; LANES],
}

impl<const N: usize> ParticleLanes<N> {
    pub(super) const fn empty() -> Self {
        Self {
            off_rad: [[0.0; LANES]; N],
            phase_offset: [0.0; LANES],
            velocity_offset: [0.0; LANES],
            log_weights: [0.0; LANES],
        }
    }

    /// Takes `particles` and compares them with `target`.
    #[inline(always)]
    pub(super) fn take(&mut self, particles: &[CyclicParticle<N>], target: &ParticleTarget<N>) {
        for (lane, particle) in (0..LANES).zip(particles) {
            for (off_rad, angle_rad) in self.off_rad.iter_mut().zip(&particle.angles_rad) {
                off_rad[lane] = *angle_rad;
            }
            self.phase_offset[lane] = particle.cycle_position - target.cycle_position;
            self.velocity_offset[lane] = particle.cycle_velocity - target.cycle_velocity;
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
        for unused in self.log_weights.iter_mut().skip(particles.len()) {
            *unused = f32::NEG_INFINITY;
        }
    }
}
