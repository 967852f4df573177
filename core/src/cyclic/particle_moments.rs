//! The particles' estimate: weighted circular means and spreads, from sums that chunks contribute to.

use super::CyclicEstimate;
use super::angle_blocks::{AngleBlocks, BLOCK, MAX_BLOCKS, blocks_of, used_blocks};
use super::particle::CyclicParticle;
use crate::math::{atan2, clamp, least_angle, max, round_small, sqrt, wrap_angle};
use core::f32::consts::TAU;

/// Weighted sums of the sines, cosines and squares of four angles.
#[derive(Debug, Clone, Copy, PartialEq)]
struct AngleSums {
    sine: [f32; BLOCK],
    cosine: [f32; BLOCK],
    square: [f32; BLOCK],
}

/// Weighted sums over particles, angles relative to a reference particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParticleMoments<const N: usize> {
    angles: [AngleSums; MAX_BLOCKS],
    phase_sine: f32,
    phase_cosine: f32,
    velocity: f32,
    velocity_square: f32,
    weight: f32,
}

/// Sine and cosine of an angle in [-pi, pi] by least-squares polynomials of half of it; error below 1e-6. No branch, so that
/// compilers work on several angles at once.
#[inline]
fn sin_cos_of_difference(angle_rad: f32) -> (f32, f32) {
    let h = 0.5 * angle_rad;
    let h2 = h * h;
    let sine = h
        * (9.99999977e-01
            + h2 * (-1.66666476e-01 + h2 * (8.33289922e-03 + h2 * (-1.98008653e-04 + h2 * (2.59043003e-06)))));
    let cosine = 1.00000000e+00
        + h2 * (-4.99999994e-01
            + h2 * (4.16666362e-02 + h2 * (-1.38883608e-03 + h2 * (2.47601355e-05 + h2 * (-2.60510763e-07)))));
    (2.0 * sine * cosine, 1.0 - 2.0 * sine * sine)
}

impl<const N: usize> ParticleMoments<N> {
    /// No particle.
    #[must_use]
    pub const fn nothing() -> Self {
        Self {
            angles: [AngleSums { sine: [0.0; BLOCK], cosine: [0.0; BLOCK], square: [0.0; BLOCK] }; MAX_BLOCKS],
            phase_sine: 0.0,
            phase_cosine: 0.0,
            velocity: 0.0,
            velocity_square: 0.0,
            weight: 0.0,
        }
    }

    /// The sums over `particles`, relative to `reference`.
    #[must_use]
    pub fn of(particles: &[CyclicParticle<N>], weights: &[f32], reference: &CyclicParticle<N>) -> Self {
        let mut moments = Self::nothing();
        let references = blocks_of(&reference.angles_rad);
        for (particle, &weight) in particles.iter().zip(weights) {
            if weight > 0.0 {
                moments.add(particle, weight, reference, &references);
            }
        }
        moments
    }

    #[inline]
    fn add(
        &mut self,
        particle: &CyclicParticle<N>,
        weight: f32,
        reference: &CyclicParticle<N>,
        references: &AngleBlocks,
    ) {
        let angles = blocks_of(&particle.angles_rad);
        for block in 0..const { used_blocks::<N>() } {
            let sums = &mut self.angles[block];
            for i in 0..BLOCK {
                let difference = least_angle(angles[block][i] - references[block][i]);
                let (sine, cosine) = sin_cos_of_difference(difference);
                sums.sine[i] += weight * sine;
                sums.cosine[i] += weight * cosine;
                sums.square[i] += weight * difference * difference;
            }
        }
        let lead = particle.cycle_position - reference.cycle_position;
        let phase = TAU * (lead - round_small(lead));
        let (sine, cosine) = sin_cos_of_difference(phase);
        self.phase_sine += weight * sine;
        self.phase_cosine += weight * cosine;
        let velocity = particle.cycle_velocity - reference.cycle_velocity;
        self.velocity += weight * velocity;
        self.velocity_square += weight * velocity * velocity;
        self.weight += weight;
    }

    /// Adds the sums of another chunk with the same reference.
    pub fn merge(&mut self, other: &Self) {
        for (sums, others) in self.angles.iter_mut().zip(&other.angles) {
            for i in 0..BLOCK {
                sums.sine[i] += others.sine[i];
                sums.cosine[i] += others.cosine[i];
                sums.square[i] += others.square[i];
            }
        }
        self.phase_sine += other.phase_sine;
        self.phase_cosine += other.phase_cosine;
        self.velocity += other.velocity;
        self.velocity_square += other.velocity_square;
        self.weight += other.weight;
    }

    /// Weighted circular mean of each angle (section 3.3) and of the cycle position, mean velocity, and their variances.
    ///
    /// `turns` and `log_likelihood` are left at zero.
    #[must_use]
    pub fn estimate(&self, reference: &CyclicParticle<N>) -> CyclicEstimate<N> {
        let share = if self.weight > 0.0 { 1.0 / self.weight } else { 0.0 };
        let shift: [f32; N] = core::array::from_fn(|i| {
            let sums = &self.angles[i / BLOCK];
            atan2(sums.sine[i % BLOCK], sums.cosine[i % BLOCK])
        });
        let square = |i: usize| self.angles[i / BLOCK].square[i % BLOCK];
        let phase_shift = atan2(self.phase_sine, self.phase_cosine) / TAU;
        let resultant = sqrt(self.phase_sine * self.phase_sine + self.phase_cosine * self.phase_cosine) * share;
        let velocity = self.velocity * share;
        CyclicEstimate {
            angles_rad: core::array::from_fn(|i| wrap_angle(reference.angles_rad[i] + shift[i])),
            turns: [0; N],
            angle_variance_rad2: core::array::from_fn(|i| max(square(i) * share - shift[i] * shift[i], 0.0)),
            cycle_position: super::phase::wrap_position(reference.cycle_position + phase_shift),
            cycle_position_variance: -2.0 * crate::math::ln(clamp(resultant, 1.0e-3, 1.0)) / (TAU * TAU),
            cycle_velocity_per_frame: reference.cycle_velocity + velocity,
            cycle_velocity_variance: max(self.velocity_square * share - velocity * velocity, 0.0),
            log_likelihood: 0.0,
            outlier: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_polynomials_are_accurate_over_the_circle() {
        for i in -1000..=1000_i32 {
            let angle = i as f32 * (core::f32::consts::PI / 1000.0);
            let (sine, cosine) = sin_cos_of_difference(angle);
            assert!((sine - angle.sin()).abs() < 1.0e-6 && (cosine - angle.cos()).abs() < 1.0e-6, "{angle}");
        }
    }

    #[test]
    fn the_mean_across_the_seam_lies_at_the_seam() {
        let at = |angle: f32, position: f32| CyclicParticle {
            angles_rad: [angle],
            velocities: [0.0],
            cycle_position: position,
            cycle_velocity: 0.01,
        };
        let particles = [at(3.1, 0.98), at(-3.1, 0.02), at(3.0, 0.0)];
        let moments = ParticleMoments::of(&particles, &[1.0, 1.0, 0.0], &particles[2]);
        let estimate = moments.estimate(&particles[2]);
        assert!((estimate.angles_rad[0].abs() - core::f32::consts::PI).abs() < 1.0e-4);
        assert!(super::super::phase::position_difference(estimate.cycle_position, 0.0).abs() < 1.0e-4);
        assert!((estimate.angle_variance_rad2[0] - 0.0416_f32.powi(2)).abs() < 1.0e-4);
    }
}
