//! The particles' estimate: weighted circular means and spreads, from sums that chunks contribute
//! to.

use crate::cyclic::CyclicEstimate;
use crate::cyclic::particle::weigh::{ParticleLanes, ParticleTarget};
use crate::cyclic::particle::weights::{WeightShare, greatest, relative_weight};
use crate::math::{atan2, clamp, ln, max, round_small, sqrt, wrap_angle};
use crate::random::lanes::LANES;
use core::f32::consts::TAU;

/// Partial sums that are taken side by side.
const PARTS: usize = 8;

/// Weighted sums over the angles that particles are off: of half the sine, half the versed sine,
/// which is 1 - cosine, and the square.
#[derive(Debug, Clone, Copy, PartialEq)]
struct AngleSums {
    half_sine: [f32; PARTS],
    half_versine: [f32; PARTS],
    square: [f32; PARTS],
}

/// Weighted sums over particles relative to a target, weights relative to the greatest.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// # use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::particle::propose::{ParticleOptions, first_particle};
/// use sinew_core::cyclic::particle::moments::ParticleMoments;
/// use sinew_core::cyclic::particle::{sweep::sweep, weigh::ParticleTarget};
/// # use sinew_core::cyclic::{AngleMeasurement, CycleStart};
///
/// # let model = WALKING.model()?;
/// # let start = CycleStart::<13>::standard(&model, &[Some(0.0); 13], Some(0.3), None)?;
/// # let seen = AngleMeasurement::new(&[Some(0.05); 13], 0.1)?;
/// # let target = ParticleTarget::new(&seen, 13, &start.estimate());
/// # let options = ParticleOptions::default();
/// // Two chunks of fifty particles, which two threads may sweep; added in their order they give the estimate.
/// let mut all = ParticleMoments::nothing();
/// for first in [0, 50] {
///     let draw = |i: usize| first_particle(&model, &[], &start, &options, (1, first + i as u32));
///     let (mut particles, mut weights) = (core::array::from_fn::<_, 50, _>(draw), [0.0; 50]);
///     all.merge(&sweep(&model, &[], &options, (&target, 1.0), (1, 1, first), &mut particles, &mut weights));
/// }
/// let estimate = all.estimate(&target);
/// assert!((estimate.cycle_position - (0.3 + model.mean_cycle_velocity())).abs() < 0.01);
/// assert!(all.share().weight <= 100.0);
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParticleMoments<const N: usize> {
    angles: [AngleSums; N],
    phase: AngleSums,
    velocity_offset: [f32; PARTS],
    velocity_offset_square: [f32; PARTS],
    share: WeightShare,
}

/// Coefficients of sin(h) / h and cos(h) in powers of h^2. Minimax fits for |h| up to pi/2; a test
/// asserts their errors, 1e-6 and 1e-5.
const SINE: [f32; 4] = [9.999_966_16e-1, -1.666_482_84e-1, 8.306_325_16e-3, -1.836_365_22e-4];
const COSINE: [f32; 4] = [9.999_932_96e-1, -4.999_124_40e-1, 4.148_774_82e-2, -1.271_209_48e-3];

/// Sine and cosine of half an angle in [-pi, pi] by polynomials; error below 1e-6 and 1e-5. No
/// branch, so that compilers work on several angles at once.
#[inline(always)]
fn half_sine_cosine(angle_rad: f32) -> (f32, f32) {
    let h = 0.5 * angle_rad;
    let h2 = h * h;
    let sine = h * (SINE[0] + h2 * (SINE[1] + h2 * (SINE[2] + h2 * SINE[3])));
    let cosine = COSINE[0] + h2 * (COSINE[1] + h2 * (COSINE[2] + h2 * COSINE[3]));
    (sine, cosine)
}

impl AngleSums {
    const ZERO: Self = Self { half_sine: [0.0; PARTS], half_versine: [0.0; PARTS], square: [0.0; PARTS] };

    #[inline(always)]
    fn add(&mut self, off_rad: &[f32; LANES], weights: &[f32; LANES]) {
        let parts = off_rad.as_chunks::<PARTS>().0.iter().zip(weights.as_chunks::<PARTS>().0);
        for (off_rad, weights) in parts {
            for i in 0..PARTS {
                let (off, weight) = (off_rad[i], weights[i]);
                let (sine, cosine) = half_sine_cosine(off);
                let weighted = weight * sine;
                self.half_sine[i] += weighted * cosine;
                self.half_versine[i] += weighted * sine;
                self.square[i] += weight * off * off;
            }
        }
    }

    fn merge(&mut self, other: &Self, own_scale: f32, other_scale: f32) {
        let pairs = [
            (&mut self.half_sine, &other.half_sine),
            (&mut self.half_versine, &other.half_versine),
            (&mut self.square, &other.square),
        ];
        for (own, other) in pairs {
            merge_parts(own, other, own_scale, other_scale);
        }
    }

    /// Sums of sine and cosine, the weights summing to `weight`, and of the square.
    fn totals(&self, weight: f32) -> (f32, f32, f32) {
        (2.0 * total(&self.half_sine), weight - 2.0 * total(&self.half_versine), total(&self.square))
    }
}

fn merge_parts(own: &mut [f32; PARTS], other: &[f32; PARTS], own_scale: f32, other_scale: f32) {
    for (own, other) in own.iter_mut().zip(other) {
        *own = own_scale * *own + other_scale * other;
    }
}

fn total(parts: &[f32; PARTS]) -> f32 {
    parts.iter().sum()
}

impl<const N: usize> ParticleMoments<N> {
    /// Sums without particles.
    #[must_use]
    pub const fn nothing() -> Self {
        Self {
            angles: [AngleSums::ZERO; N],
            phase: AngleSums::ZERO,
            velocity_offset: [0.0; PARTS],
            velocity_offset_square: [0.0; PARTS],
            share: WeightShare::NOTHING,
        }
    }

    /// All zeros, which is not [`Self::nothing`]: what a static memory begins with.
    pub(super) const ZERO: Self = Self {
        angles: [AngleSums::ZERO; N],
        phase: AngleSums::ZERO,
        velocity_offset: [0.0; PARTS],
        velocity_offset_square: [0.0; PARTS],
        share: WeightShare { greatest_log_weight: 0.0, weight: 0.0 },
    };

    /// Adds particles, without the sum of their weights.
    #[inline(always)]
    pub(super) fn add(&mut self, lanes: &ParticleLanes<N>) {
        let best = greatest(&lanes.log_weights);
        if best > self.share.greatest_log_weight {
            self.relate_to(best);
        }
        let mut weights = [0.0; LANES];
        for (weight, log_weight) in weights.iter_mut().zip(&lanes.log_weights) {
            *weight = relative_weight(*log_weight, self.share.greatest_log_weight);
        }
        for (sums, off_rad) in self.angles.iter_mut().zip(&lanes.off_rad) {
            sums.add(off_rad, &weights);
        }
        self.phase
            .add(&lanes.phase_offset.map(|phase_offset| TAU * (phase_offset - round_small(phase_offset))), &weights);
        let velocity_offsets = lanes.velocity_offset.as_chunks::<PARTS>().0.iter().zip(weights.as_chunks::<PARTS>().0);
        for (velocity_offset, weight) in velocity_offsets {
            for i in 0..PARTS {
                self.velocity_offset[i] += weight[i] * velocity_offset[i];
                self.velocity_offset_square[i] += weight[i] * velocity_offset[i] * velocity_offset[i];
            }
        }
    }

    /// As [`Self::merge`] with no sums at all and a greatest log-weight of `best`, which is
    /// greater: without one more set of sums on the stack.
    fn relate_to(&mut self, best: f32) {
        let own_scale = self.share.scale(best);
        for own in &mut self.angles {
            own.merge(&AngleSums::ZERO, own_scale, 1.0);
        }
        self.phase.merge(&AngleSums::ZERO, own_scale, 1.0);
        merge_parts(&mut self.velocity_offset, &[0.0; PARTS], own_scale, 1.0);
        merge_parts(&mut self.velocity_offset_square, &[0.0; PARTS], own_scale, 1.0);
        self.share = WeightShare { greatest_log_weight: best, weight: own_scale * self.share.weight };
    }

    /// Empties the sums.
    pub(super) fn clear(&mut self) {
        self.angles.fill(AngleSums::ZERO);
        self.phase = AngleSums::ZERO;
        (self.velocity_offset, self.velocity_offset_square) = ([0.0; PARTS], [0.0; PARTS]);
        self.share = WeightShare::NOTHING;
    }

    /// Sets the sum of the weights relative to the greatest.
    pub(super) const fn weigh(&mut self, weight: f32) {
        self.share.weight = weight;
    }

    /// Sum of the particles' weights.
    #[must_use]
    pub const fn share(&self) -> WeightShare {
        self.share
    }

    /// Adds the sums of another chunk with the same target.
    pub fn merge(&mut self, other: &Self) {
        let greatest_log_weight = max(self.share.greatest_log_weight, other.share.greatest_log_weight);
        let scale = |share: &WeightShare| share.scale(greatest_log_weight);
        let (own_scale, other_scale) = (scale(&self.share), scale(&other.share));
        for (own, other) in self.angles.iter_mut().zip(&other.angles) {
            own.merge(other, own_scale, other_scale);
        }
        self.phase.merge(&other.phase, own_scale, other_scale);
        merge_parts(&mut self.velocity_offset, &other.velocity_offset, own_scale, other_scale);
        merge_parts(&mut self.velocity_offset_square, &other.velocity_offset_square, own_scale, other_scale);
        let weight = own_scale * self.share.weight + other_scale * other.share.weight;
        self.share = WeightShare { greatest_log_weight, weight };
    }

    /// Weighted circular mean of each angle (cyclic paper, section 3.3) and of the cycle position,
    /// mean velocity, and their variances.
    ///
    /// `turns` and `log_likelihood` are left at zero.
    #[must_use]
    pub fn estimate(&self, target: &ParticleTarget<N>) -> CyclicEstimate<N> {
        let weight = self.share.weight;
        let share = if weight > 0.0 { 1.0 / weight } else { 0.0 };
        let totals = self.angles.map(|sums| sums.totals(weight));
        let shift = totals.map(|(sine, cosine, _)| atan2(sine, cosine));
        let (phase_sine, phase_cosine, _) = self.phase.totals(weight);
        let resultant = sqrt(phase_sine * phase_sine + phase_cosine * phase_cosine) * share;
        let velocity_offset = total(&self.velocity_offset) * share;
        let position = target.cycle_position + atan2(phase_sine, phase_cosine) / TAU;
        CyclicEstimate {
            angles_rad: core::array::from_fn(|i| wrap_angle(target.angles_rad[i] + shift[i])),
            turns: [0; N],
            angle_variance_rad2: core::array::from_fn(|i| max(totals[i].2 * share - shift[i] * shift[i], 0.0)),
            cycle_position: crate::cyclic::phase::wrap_position(position),
            cycle_position_variance: -2.0 * ln(clamp(resultant, 1.0e-3, 1.0)) / (TAU * TAU),
            cycle_velocity_per_frame: target.cycle_velocity + velocity_offset,
            cycle_velocity_variance: max(
                total(&self.velocity_offset_square) * share - velocity_offset * velocity_offset,
                0.0,
            ),
            log_likelihood: 0.0,
            outlier: false,
            misfit: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::{AngleMeasurement, synthetic};

    #[test]
    fn the_polynomials_are_accurate_over_the_circle() {
        for i in -1000..=1000_i32 {
            let angle = i as f32 * (core::f32::consts::PI / 1000.0);
            let (sine, cosine) = half_sine_cosine(angle);
            let half = 0.5 * angle;
            assert!((sine - half.sin()).abs() < 1.0e-6 && (cosine - half.cos()).abs() < 1.0e-5, "{angle}");
        }
    }

    fn lanes(angles: &[f32], log_weights: &[f32]) -> ParticleLanes<1> {
        let mut lanes = ParticleLanes {
            off_rad: [[0.0; LANES]; 1],
            phase_offset: [0.0; LANES],
            velocity_offset: [0.0; LANES],
            log_weights: [f32::NEG_INFINITY; LANES],
        };
        for (lane, (angle, log_weight)) in angles.iter().zip(log_weights).enumerate() {
            lanes.off_rad[0][lane] = *angle;
            lanes.phase_offset[lane] = 0.9 + angle;
            lanes.velocity_offset[lane] = 0.01 * angle;
            lanes.log_weights[lane] = *log_weight;
        }
        lanes
    }

    fn at_zero() -> ParticleTarget<1> {
        let table = synthetic::table(1.0e-3, 9);
        let model = table.model().unwrap();
        let start = crate::cyclic::CycleStart::standard(&model, &[Some(0.0)], Some(0.0), Some(0.01)).unwrap();
        ParticleTarget::new(&AngleMeasurement::nothing(), 1, &start.estimate())
    }

    /// Two particles of weights 3 : 1, in one chunk or two, whichever of them comes first.
    #[test]
    fn sums_of_chunks_add_up_to_those_of_all() {
        let target = at_zero();
        let low = -(3.0_f32.ln());
        let weighed = |lanes: &ParticleLanes<1>, weight: f32| {
            let mut moments = ParticleMoments::<1>::nothing();
            moments.add(lanes);
            moments.weigh(weight);
            moments
        };
        let together = weighed(&lanes(&[0.2, 0.6], &[-50.0, -50.0 + low]), 4.0 / 3.0);
        let (heavy, light) = (weighed(&lanes(&[0.2], &[-50.0]), 1.0), weighed(&lanes(&[0.6], &[-50.0 + low]), 1.0));
        for (first, second) in [(heavy, light), (light, heavy)] {
            let mut all = ParticleMoments::nothing();
            all.merge(&first);
            all.merge(&second);
            let estimate = all.estimate(&target);
            let mean = (0.75 * 0.2_f32.sin() + 0.25 * 0.6_f32.sin()).atan2(0.75 * 0.2_f32.cos() + 0.25 * 0.6_f32.cos());
            assert!((estimate.angles_rad[0] - mean).abs() < 1.0e-5, "{}", estimate.angles_rad[0]);
            assert!((estimate.angle_variance_rad2[0] - 0.75 * 0.25 * 0.16).abs() < 1.0e-3);
            assert!((estimate.cycle_velocity_per_frame - 0.01 - 0.003).abs() < 1.0e-6);
            let other = together.estimate(&target);
            assert!((estimate.angles_rad[0] - other.angles_rad[0]).abs() < 1.0e-6);
            assert!((estimate.cycle_position - other.cycle_position).abs() < 1.0e-6);
            assert!((all.share().weight - 4.0 / 3.0).abs() < 1.0e-5);
        }
    }
}
