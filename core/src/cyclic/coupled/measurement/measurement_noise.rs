//! Noise of each measured angle, learned from the innovations.
//!
//! An innovation nu has the variance P + r R, with the prediction's variance P, the stated R and a
//! scale r. So has half the squared difference of two in a row, d^2 / 2. A person whom the model
//! does not fit has innovations that hardly change from frame to frame, and they cancel in d. So
//! (d^2 / 2 - P) / R estimates r. Each counts with the information that it has on r, the square of
//! the noise's share r R / (P + r R): scoring by Fisher. Sources: Mehra 1972, Approaches to
//! Adaptive Filtering, IEEE Transactions on Automatic Control 17 (innovations); von Neumann et al.
//! 1941, The Mean Square Successive Difference, Annals of Mathematical Statistics 12 (differences).
//!
//! Noise that is correlated from frame to frame looks like absent noise. So a scale below one
//! applies to the gains, at least [`MIN_SCALE`], and never to the bands: see
//! [`MeasurementNoise::band_scale`].

use crate::cyclic::coupled::ablation::{Part, is_on};
use crate::cyclic::coupled::constants::{KEPT, MAX_SQUARE, MIN_SCALE, SHARED_FRAMES, STATED_FRAMES};
use crate::cyclic::coupled::person::spread_scale::MAX_SCALE;
use crate::math::{clamp, exp, least_angle, ln, max, min, sqrt};
use crate::saved_state::{NOT_NEGATIVE, SavedState, StateVisitor};
use core::f32::consts::PI;

/// Scale of the stated noise variance of each angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MeasurementNoise<const N: usize> {
    /// Weighted sum of what the innovations' squares have beyond the prediction's variance, in
    /// stated variances.
    sums: [f32; N],
    /// Sum of the weights, frames.
    frames: [f32; N],
    /// Scale of all angles together.
    shared: f32,
}

impl<const N: usize> SavedState for MeasurementNoise<N> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        const MOST: f32 = 1.01 / (1.0 - KEPT);
        // A square is at most nine variances, and the noise's share of those is the weight's root.
        visitor.reals(&mut self.sums, &(-MOST * MAX_SQUARE * MAX_SCALE..=MOST * MAX_SQUARE * MAX_SCALE));
        visitor.reals(&mut self.frames, &(*NOT_NEGATIVE.start()..=MOST));
        visitor.real(&mut self.shared, &(MIN_SCALE..=MAX_SCALE));
    }
}

impl<const N: usize> MeasurementNoise<N> {
    /// Noise as stated.
    pub(crate) const fn new() -> Self {
        Self { shared: 1.0, ..Self::zero() }
    }

    /// Zeros, for a filter that has not begun.
    pub(crate) const fn zero() -> Self {
        Self { sums: [0.0; N], frames: [0.0; N], shared: 0.0 }
    }

    /// Factor of the stated variance of the angle at `index` for the gains, in [[`MIN_SCALE`],
    /// [`MAX_SCALE`]]: between its own and that of all angles together.
    #[inline]
    pub(crate) fn scale(&self, index: usize) -> f32 {
        if !is_on(Part::NoiseScale) {
            return 1.0;
        }
        let own = self.sums.get(index).zip(self.frames.get(index));
        own.map_or(1.0, |(sum, frames)| {
            clamp((sum + SHARED_FRAMES * self.shared) / (frames + SHARED_FRAMES), MIN_SCALE, MAX_SCALE)
        })
    }

    /// Factor of the variance of the angle at `index` for the bands: the inverse of a scale below
    /// one.
    #[inline]
    pub(crate) fn band_scale(&self, index: usize) -> f32 {
        1.0 / min(self.scale(index), 1.0)
    }

    /// Adds the wrapped innovations of the angle at `index` in this frame and the last one, rad,
    /// with the variances of stated noise, scaled noise and prediction, rad^2.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    #[cfg_attr(not(target_arch = "x86_64"), inline)]
    pub(crate) fn add(&mut self, index: usize, [stated, noise, predicted]: [f32; 3], innovations_rad: [f32; 2]) {
        let (Some(sum), Some(frames)) = (self.sums.get_mut(index), self.frames.get_mut(index)) else { return };
        let variance = predicted + noise;
        let share = noise / variance;
        let change_rad = least_angle(innovations_rad[0] - innovations_rad[1]);
        let square = min(0.5 * change_rad * change_rad * wrapping(2.0 * variance), MAX_SQUARE * variance);
        // Of the square, the noise's part in stated variances, times the weight share^2.
        let beyond = noise / stated * share * (square - predicted) / variance;
        *sum = KEPT * *sum + beyond;
        *frames = KEPT * *frames + share * share;
    }

    /// Estimates the scale of all angles together, their geometric mean.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub(crate) fn update(&mut self) {
        let (mut logarithms, mut count) = (0.0, 0.0);
        for (sum, frames) in self.sums.iter().zip(&self.frames) {
            if *frames > 0.0 {
                logarithms += ln(clamp((sum + STATED_FRAMES) / (frames + STATED_FRAMES), MIN_SCALE, MAX_SCALE));
                count += 1.0;
            }
        }
        self.shared = clamp(exp(logarithms / max(count, 1.0)), MIN_SCALE, MAX_SCALE);
    }
}

/// Ratio of a normal angle's `variance`, rad^2, to the mean square of the wrapped angle.
///
/// The mean square is at most pi^2 / 3. Within 8 %, and at most 1 % too low (asserted by a test).
#[inline]
fn wrapping(variance: f32) -> f32 {
    let spread = variance * (3.0 / (PI * PI));
    sqrt(1.0 + spread * spread)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::wrap_angle;
    use crate::random::Stream;

    const N: usize = 13;

    /// Scales after `frames` with predicted and stated variances, where the true noise variance of
    /// each angle is `truly` of the stated one.
    fn scales([stated, predicted]: [f32; 2], truly: impl Fn(usize) -> f32, frames: u64) -> [f32; N] {
        let (mut noise, mut last_rad) = (MeasurementNoise::<N>::new(), [0.0; N]);
        for frame in 0..frames {
            let mut stream = Stream::new(3, frame, 0);
            for i in 0..N {
                let innovation = wrap_angle(sqrt(predicted + truly(i) * stated) * stream.normal());
                noise.add(i, [stated, noise.scale(i) * stated, predicted], [innovation, last_rad[i]]);
                last_rad[i] = innovation;
            }
            noise.update();
        }
        core::array::from_fn(|i| noise.scale(i))
    }

    fn mean(scales: [f32; N]) -> f32 {
        scales.iter().sum::<f32>() / N as f32
    }

    #[test]
    fn the_scale_of_all_angles_is_found_in_half_a_second_up_and_down() {
        for (truly, expected) in [(0.5, 0.4..0.62), (1.0, 0.85..1.12), (4.0, 3.2..4.6), (9.0, 6.8..10.0)] {
            for stated in [3.0e-4, 0.01] {
                let mean = mean(scales([stated, 0.3 * stated], |_| truly, 30));
                assert!(expected.contains(&mean), "{truly} times {stated} rad^2: {mean}");
            }
        }
    }

    #[test]
    fn an_angle_with_other_noise_is_found_among_the_others() {
        // In 400 frames of which each weighs a half, the others still pull at it.
        for (truly, expected) in [(0.4, 0.5..0.8), (3.0, 1.8..2.9)] {
            let found = scales([0.01, 0.002], |i| if i == 4 { truly } else { 1.0 }, 400);
            assert!(expected.contains(&found[4]), "{truly}: {found:?}");
            assert!(found.iter().enumerate().all(|(i, scale)| i == 4 || (0.7..1.4).contains(scale)), "{found:?}");
        }
    }

    #[test]
    fn what_a_model_does_not_fit_is_no_noise() {
        let (mut noise, mut last_rad) = (MeasurementNoise::<N>::new(), [0.0; N]);
        for frame in 0..120_u16 {
            let mut stream = Stream::new(3, u64::from(frame), 0);
            for i in 0..N {
                // Two standard deviations off, up and down once in a cycle of 60 frames.
                let off_rad = 0.2 * crate::math::sin_cos(f32::from(frame) * PI / 30.0 + i as f32).0;
                let innovation = off_rad + 0.1 * stream.normal();
                noise.add(i, [0.01, 0.01 * noise.scale(i), 1.0e-3], [innovation, last_rad[i]]);
                last_rad[i] = innovation;
            }
            noise.update();
        }
        let mean = mean(core::array::from_fn(|i| noise.scale(i)));
        assert!((0.85..1.25).contains(&mean), "{mean}; by the innovations' squares it would be 3");
    }

    #[test]
    fn the_scales_have_bounds_and_an_uncertain_prediction_hardly_moves_them() {
        assert!((0.25..0.26).contains(&mean(scales([0.01, 1.0e-3], |_| 0.0, 100))));
        assert!((15.9..=16.0).contains(&mean(scales([1.0e-4, 1.0e-5], |_| 100.0, 200))));
        assert!((0.9..1.1).contains(&mean(scales([1.0e-4, 0.01], |_| 0.0, 10))));
    }

    #[test]
    fn bands_are_never_narrower_than_the_stated_noise_makes_them() {
        let noise = MeasurementNoise { sums: [-400.0, 400.0], frames: [100.0; 2], shared: 1.0 };
        assert_eq!([noise.band_scale(0), noise.band_scale(1), noise.band_scale(2)], [4.0, 1.0, 1.0]);
        assert!(noise.scale(1) > 2.5);
    }

    #[test]
    fn the_ratio_of_a_wrapped_angle_is_within_eight_percent() {
        for variance in [0.5, 1.0, 2.0, 4.0, 20.0_f32] {
            let mut stream = Stream::new(5, 0, 0);
            let square = |_| {
                let wrapped = wrap_angle(sqrt(variance) * stream.normal());
                f64::from(wrapped * wrapped)
            };
            let mean = (0..100_000).map(square).sum::<f64>() / 100_000.0;
            let off = f64::from(variance / wrapping(variance)) / mean;
            assert!((0.92..1.01).contains(&off), "{variance}: {mean}, {off} times");
        }
    }
}
