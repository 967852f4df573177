//! The particles' estimate: weighted circular means and spreads, from sums that chunks contribute to.

use super::CyclicEstimate;
use super::particle::CyclicParticle;
use crate::angle::angle_difference;
use crate::math::{atan2, clamp, max, sqrt, wrap_angle};
use core::f32::consts::TAU;

/// Weighted sums over particles, angles relative to a reference particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParticleMoments<const N: usize> {
    sine: [f32; N],
    cosine: [f32; N],
    square: [f32; N],
    phase_sine: f32,
    phase_cosine: f32,
    velocity: f32,
    velocity_square: f32,
    weight: f32,
}

/// Sine and cosine of an angle in [-pi, pi] by Taylor's series of half of it; error below 1e-6. No branch, so that
/// compilers work on several angles at once.
#[inline]
fn sin_cos_of_difference(angle_rad: f32) -> (f32, f32) {
    let h = 0.5 * angle_rad;
    let h2 = h * h;
    let sine = h
        * (1.0
            + h2 * (-1.666_666_7e-1
                + h2 * (8.333_333e-3 + h2 * (-1.984_127e-4 + h2 * (2.755_732e-6 - h2 * 2.505_211e-8)))));
    let cosine = 1.0
        + h2 * (-0.5
            + h2 * (4.166_666_6e-2
                + h2 * (-1.388_888_9e-3 + h2 * (2.480_158_7e-5 + h2 * (-2.755_732e-7 + h2 * 2.087_675_7e-9)))));
    (2.0 * sine * cosine, 1.0 - 2.0 * sine * sine)
}

impl<const N: usize> ParticleMoments<N> {
    /// No particle.
    #[must_use]
    pub const fn nothing() -> Self {
        let zero = [0.0; N];
        Self {
            sine: zero,
            cosine: zero,
            square: zero,
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
        for (particle, &weight) in particles.iter().zip(weights) {
            if weight > 0.0 {
                moments.add(particle, weight, reference);
            }
        }
        moments
    }

    #[inline]
    fn add(&mut self, particle: &CyclicParticle<N>, weight: f32, reference: &CyclicParticle<N>) {
        for i in 0..N {
            let difference = angle_difference(particle.angles_rad[i], reference.angles_rad[i]);
            let (sine, cosine) = sin_cos_of_difference(difference);
            self.sine[i] += weight * sine;
            self.cosine[i] += weight * cosine;
            self.square[i] += weight * difference * difference;
        }
        let phase = TAU * super::phase::position_difference(particle.cycle_position, reference.cycle_position);
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
        for i in 0..N {
            self.sine[i] += other.sine[i];
            self.cosine[i] += other.cosine[i];
            self.square[i] += other.square[i];
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
        let shift: [f32; N] = core::array::from_fn(|i| atan2(self.sine[i], self.cosine[i]));
        let phase_shift = atan2(self.phase_sine, self.phase_cosine) / TAU;
        let resultant = sqrt(self.phase_sine * self.phase_sine + self.phase_cosine * self.phase_cosine) * share;
        let velocity = self.velocity * share;
        CyclicEstimate {
            angles_rad: core::array::from_fn(|i| wrap_angle(reference.angles_rad[i] + shift[i])),
            turns: [0; N],
            angle_variance_rad2: core::array::from_fn(|i| max(self.square[i] * share - shift[i] * shift[i], 0.0)),
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
    fn the_short_series_are_accurate_over_the_circle() {
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
