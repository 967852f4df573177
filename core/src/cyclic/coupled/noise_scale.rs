//! Scale of the measurement noise below the stated one, learned from the innovations.
//!
//! The scale r of the stated variances R follows by maximum likelihood, frame by frame. Source:
//! Mehra 1972, Approaches to Adaptive Filtering, IEEE Transactions on Automatic Control 17. An
//! innovation nu has variance S = P + r R. Its log-likelihood has the slope rho (nu^2 / S - 1) / 2
//! by ln r, with rho = r R / S. The slope is small where the prediction is uncertain. Each frame
//! moves r up it.
//!
//! Noise that is correlated from frame to frame looks like absent noise. So the scale applies to
//! the gains, at least [`MIN_SCALE`], and never to the bands: see [`NoiseScale::band_scale`].

use crate::math::{clamp, min, sqrt};
use crate::saved_state::{SavedState, StateVisitor};
use core::f32::consts::PI;

/// Scale down to which nothing changes. Chosen: the estimate of ln r has a standard deviation of
/// about 0.1 where the noise is as stated, so it stays above.
const INDISTINGUISHABLE_FROM_ONE: f32 = 0.7;
/// Smallest scale that the gains use.
///
/// Chosen: half of the stated standard deviation. With 1/16 the exact-mean error falls by another
/// fifth, but the bands of slow noise hold half of the truth.
const MIN_SCALE: f32 = 0.25;
/// Innovations over which the scale is averaged. Chosen: eight frames with 13 angles.
const INNOVATIONS: f32 = 100.0;
/// Weight of the prior r = 1 in a frame, innovations. Chosen: one, since predicted variances are
/// inflated and pull r down.
const PRIOR_WEIGHT: f32 = 1.0;
/// Largest normalised square that an innovation counts with. Chosen: three standard deviations.
const MAX_SQUARE: f32 = 9.0;

/// Score of a frame's innovations: twice the derivative of their log-likelihood by ln r.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NoiseScore {
    /// Scale r at which the derivative is taken.
    scale: f32,
    derivative: f32,
}

impl NoiseScore {
    /// Adds the wrapped innovation of an angle, with the variances of stated noise and prediction,
    /// rad^2.
    #[inline]
    pub(super) fn add(&mut self, stated_variance: f32, predicted_variance: f32, innovation_rad: f32) {
        let noise_variance = self.scale * stated_variance;
        let variance = predicted_variance + noise_variance;
        let inverse = 1.0 / variance;
        let square = innovation_rad * innovation_rad * inverse * wrapping(variance);
        self.derivative += noise_variance * inverse * (min(square, MAX_SQUARE) - 1.0);
    }
}

/// Scale of the stated noise variances.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NoiseScale {
    /// Maximum-likelihood estimate of r.
    likeliest: f32,
}

impl SavedState for NoiseScale {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.real(&mut self.likeliest, &(INDISTINGUISHABLE_FROM_ONE * MIN_SCALE..=1.0));
    }
}

impl NoiseScale {
    /// Noise as stated.
    pub(super) const fn new() -> Self {
        Self { likeliest: 1.0 }
    }

    /// Factor of the stated variances for the gains, in [[`MIN_SCALE`], 1].
    #[inline]
    pub(super) fn scale(&self) -> f32 {
        min(self.likeliest * (1.0 / INDISTINGUISHABLE_FROM_ONE), 1.0)
    }

    /// Factor of the angles' variances for the bands: the inverse of [`Self::scale`].
    #[inline]
    pub(super) fn band_scale(&self) -> f32 {
        1.0 / self.scale()
    }

    /// Score of a frame without innovations so far.
    #[inline]
    pub(super) const fn score(&self) -> NoiseScore {
        NoiseScore { scale: self.likeliest, derivative: 0.0 }
    }

    /// Moves the scale by a frame's score.
    pub(super) fn update(&mut self, score: &NoiseScore) {
        let derivative = score.derivative + PRIOR_WEIGHT * (1.0 - self.likeliest);
        self.likeliest =
            clamp(self.likeliest * (1.0 + derivative / INNOVATIONS), INDISTINGUISHABLE_FROM_ONE * MIN_SCALE, 1.0);
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

    /// Scale after `frames` of 13 angles, with predicted and stated variances, where the true noise
    /// variance is `truly` of the stated one.
    fn scale(stated: f32, predicted: f32, truly: f32, frames: u64) -> f32 {
        let mut noise = NoiseScale::new();
        for frame in 0..frames {
            let mut stream = Stream::new(3, frame, 0);
            let mut score = noise.score();
            for _ in 0..13 {
                score.add(stated, predicted, wrap_angle(sqrt(predicted + truly * stated) * stream.normal()));
            }
            noise.update(&score);
        }
        noise.scale()
    }

    #[test]
    fn noise_as_stated_keeps_the_scale_at_one() {
        for stated in [3.0e-4, 0.01, 0.25, 4.0] {
            for frames in 1..200 {
                assert!(scale(stated, 0.3 * stated, 1.0, frames) > 0.999, "{stated} rad^2, frame {frames}");
            }
        }
    }

    /// Mean of [`scale`] over many numbers of frames.
    fn mean_scale(predicted: f32, truly: f32) -> f32 {
        (100..300).map(|frames| scale(0.01, predicted, truly, frames)).sum::<f32>() / 200.0
    }

    #[test]
    fn noise_below_half_of_the_stated_variance_is_found() {
        for (truly, expected) in
            [(1.0, 0.999..=1.0), (0.8, 0.97..=1.0), (0.5, 0.7..=0.8), (0.3, 0.45..=0.55), (0.1, 0.25..=0.32)]
        {
            let mean = mean_scale(1.0e-3, truly);
            assert!(expected.contains(&mean), "{truly}: {mean}");
        }
        assert!((MIN_SCALE - 1.0e-6..MIN_SCALE + 1.0e-6).contains(&scale(0.01, 1.0e-3, 0.0, 60)), "a bound");
    }

    #[test]
    fn an_uncertain_prediction_leaves_the_scale_at_one() {
        assert!(scale(1.0e-4, 0.01, 0.0, 10) > 0.999);
    }

    #[test]
    fn the_scale_returns_to_one_with_the_noise() {
        let mut noise = NoiseScale { likeliest: INDISTINGUISHABLE_FROM_ONE * MIN_SCALE };
        for frame in 0..30 {
            let mut stream = Stream::new(4, frame, 0);
            let mut score = noise.score();
            (0..13).for_each(|_| score.add(0.01, 0.001, 0.105 * stream.normal()));
            noise.update(&score);
        }
        assert!(noise.scale() > 0.9, "{noise:?}");
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
