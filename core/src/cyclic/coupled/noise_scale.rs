//! How much of the noise that was told is in the measurements: somebody who tells six degrees may have four.
//!
//! The share r of the told variances R follows from the innovations by maximum likelihood, frame by frame (Mehra 1972, adaptive
//! filtering). Of an innovation nu whose variance is S = P + r R the log-likelihood changes with ln r by rho (nu^2 / S - 1) / 2,
//! rho = r R / S: where the prediction is unsure it says little. Each frame moves r a small way up that slope.
//!
//! Noise that moves slowly looks the same from frame to frame as noise that is not there. So a share is believed for the means, within
//! [`MIN_SHARE`], and never for the bands: see [`NoiseScale::band_scale`].

use crate::math::{clamp, min, sqrt};
use crate::saved_state::{SavedState, StateVisitor};
use core::f32::consts::PI;

/// Share that chance stays above where noise is as it was told, since its logarithm is known to 0.1: nothing changes down to it.
const INDISTINGUISHABLE_FROM_ONE: f32 = 0.7;
/// Least share that is believed: half of the standard deviation.
const MIN_SHARE: f32 = 0.25;
/// Innovations over which the share is learned: those of eight frames with 13 angles.
const INNOVATIONS: f32 = 100.0;
/// Innovations of a frame that it counts as to have been told: predictions are as a rule somewhat surer than their variance.
const PRIOR_WEIGHT: f32 = 1.0;
/// Greatest normalised square that an innovation counts with.
const MAX_SQUARE: f32 = 9.0;

/// What the innovations of a frame say about the share: twice the derivative of their log-likelihood by its logarithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NoiseScore {
    /// Share at which that is said.
    share: f32,
    derivative: f32,
}

impl NoiseScore {
    /// Adds the innovation of an angle, `innovation_rad` the shorter way round: its variances by the noise that was told and by the
    /// prediction.
    #[inline]
    pub(super) fn add(&mut self, told_variance: f32, predicted_variance: f32, innovation_rad: f32) {
        let noise_variance = self.share * told_variance;
        let variance = predicted_variance + noise_variance;
        let inverse = 1.0 / variance;
        let square = innovation_rad * innovation_rad * inverse * wrapping(variance);
        self.derivative += noise_variance * inverse * (min(square, MAX_SQUARE) - 1.0);
    }
}

/// The share of the noise variances told that is there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NoiseScale {
    likeliest: f32,
}

impl SavedState for NoiseScale {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.real(&mut self.likeliest, &(INDISTINGUISHABLE_FROM_ONE * MIN_SHARE..=1.0));
    }
}

impl NoiseScale {
    /// Noise is as it was told.
    pub(super) const fn new() -> Self {
        Self { likeliest: 1.0 }
    }

    /// Factor of the told variances for the gains, in [[`MIN_SHARE`], 1].
    #[inline]
    pub(super) fn share(&self) -> f32 {
        min(self.likeliest * (1.0 / INDISTINGUISHABLE_FROM_ONE), 1.0)
    }

    /// Factor of the angles' variances for the bands: what the gains' noise makes of them is taken back.
    #[inline]
    pub(super) fn band_scale(&self) -> f32 {
        1.0 / self.share()
    }

    /// Nothing seen yet of a frame.
    #[inline]
    pub(super) const fn score(&self) -> NoiseScore {
        NoiseScore { share: self.likeliest, derivative: 0.0 }
    }

    /// Takes in what a frame's [`Self::score`] has become.
    pub(super) fn see(&mut self, score: &NoiseScore) {
        let derivative = score.derivative + PRIOR_WEIGHT * (1.0 - self.likeliest);
        self.likeliest =
            clamp(self.likeliest * (1.0 + derivative / INNOVATIONS), INDISTINGUISHABLE_FROM_ONE * MIN_SHARE, 1.0);
    }
}

/// Times that the mean square of a normal angle known up to whole turns, which ends at pi^2 / 3, is below its `variance`. Within 8 %,
/// too high where it is off: noise is then taken for larger.
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

    /// The share after so many frames of 13 angles that a filter of variance `predicted` sees, told `told`, with noise of which `truly` of
    /// the variance is there.
    fn share(told: f32, predicted: f32, truly: f32, frames: u64) -> f32 {
        let mut noise = NoiseScale::new();
        for frame in 0..frames {
            let mut stream = Stream::new(3, frame, 0);
            let mut score = noise.score();
            for _ in 0..13 {
                score.add(told, predicted, wrap_angle(sqrt(predicted + truly * told) * stream.normal()));
            }
            noise.see(&score);
        }
        noise.share()
    }

    #[test]
    fn noise_as_told_is_believed_whatever_its_size() {
        for told in [3.0e-4, 0.01, 0.25, 4.0] {
            for frames in 1..200 {
                assert!(share(told, 0.3 * told, 1.0, frames) > 0.999, "{told} rad^2, frame {frames}");
            }
        }
    }

    /// The mean of [`share`] over many numbers of frames.
    fn mean_share(predicted: f32, truly: f32) -> f32 {
        (100..300).map(|frames| share(0.01, predicted, truly, frames)).sum::<f32>() / 200.0
    }

    #[test]
    fn half_of_the_variance_is_hardly_told_from_all_and_less_is() {
        for (truly, expected) in
            [(1.0, 0.999..=1.0), (0.8, 0.97..=1.0), (0.5, 0.7..=0.8), (0.3, 0.45..=0.55), (0.1, 0.25..=0.32)]
        {
            let mean = mean_share(1.0e-3, truly);
            assert!(expected.contains(&mean), "{truly}: {mean}");
        }
        assert!((MIN_SHARE - 1.0e-6..MIN_SHARE + 1.0e-6).contains(&share(0.01, 1.0e-3, 0.0, 60)), "a bound");
    }

    #[test]
    fn where_the_prediction_is_unsure_little_is_said_about_noise() {
        assert!(share(1.0e-4, 0.01, 0.0, 10) > 0.999);
    }

    #[test]
    fn it_comes_back_when_noise_does() {
        let mut noise = NoiseScale { likeliest: INDISTINGUISHABLE_FROM_ONE * MIN_SHARE };
        for frame in 0..30 {
            let mut stream = Stream::new(4, frame, 0);
            let mut score = noise.score();
            (0..13).for_each(|_| score.add(0.01, 0.001, 0.105 * stream.normal()));
            noise.see(&score);
        }
        assert!(noise.share() > 0.9, "{noise:?}");
    }

    #[test]
    fn a_wrapped_angle_has_about_the_mean_square_that_is_said() {
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
