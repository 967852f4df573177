//! Which of several motions is it? The likelihoods of filters that run side by side, compared with a bounded memory.

use super::CyclicEstimate;
use crate::math::{exp, max};
use core::f32::consts::TAU;

/// Frames after which a frame's evidence counts 1/e.
pub const DEFAULT_MEMORY_FRAMES: f32 = 60.0;

/// Recursive log-likelihood of `MOTIONS` motions against "none of these".
///
/// "None" says that every angle is uniform on the circle, ln 1 / (2 pi) an angle. Older evidence fades, so that the scores
/// stay bounded and a change of motion is noticed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionBank<const MOTIONS: usize> {
    /// Log-likelihood of each motion above that of none.
    scores: [f32; MOTIONS],
    keep: f32,
}

/// Greatest size of a score: beyond it there is no doubt.
const SCORE_LIMIT: f32 = 1.0e4;

impl<const MOTIONS: usize> MotionBank<MOTIONS> {
    /// No evidence yet; `memory_frames` below one counts as one.
    #[must_use]
    pub fn new(memory_frames: f32) -> Self {
        Self { scores: [0.0; MOTIONS], keep: exp(-1.0 / max(memory_frames, 1.0)) }
    }

    /// Takes in a frame with `present_angles` angles seen and the log-likelihood that each motion's filter gave it.
    pub fn add(&mut self, log_likelihoods: &[f32; MOTIONS], present_angles: usize) {
        let none = -(present_angles as f32) * crate::math::ln(TAU);
        for (score, &log_likelihood) in self.scores.iter_mut().zip(log_likelihoods) {
            let gain = if log_likelihood.is_finite() { log_likelihood - none } else { -SCORE_LIMIT };
            *score = crate::math::clamp(self.keep * *score + gain, -SCORE_LIMIT, SCORE_LIMIT);
        }
    }

    /// The same from the estimates of the filters.
    pub fn add_estimates<const N: usize>(&mut self, estimates: &[CyclicEstimate<N>; MOTIONS], present_angles: usize) {
        self.add(&core::array::from_fn(|i| estimates[i].log_likelihood), present_angles);
    }

    /// Index of the likeliest motion; `None` where none of these is likelier.
    #[must_use]
    pub fn likeliest(&self) -> Option<usize> {
        let mut best = (0.0, None);
        for (index, &score) in self.scores.iter().enumerate() {
            if score > best.0 {
                best = (score, Some(index));
            }
        }
        best.1
    }

    /// Probability of each motion, all motions and "none of these" being equally likely before.
    #[must_use]
    pub fn probabilities(&self) -> [f32; MOTIONS] {
        let greatest = self.scores.iter().fold(0.0, |best, &score| max(score, best));
        let weights = self.scores.map(|score| exp(score - greatest));
        let sum = exp(-greatest) + weights.iter().sum::<f32>();
        weights.map(|weight| weight / sum)
    }
}

#[cfg(test)]
mod tests {
    use super::super::kalman::KalmanFilter;
    use super::super::{AngleMeasurement, CycleStart, KalmanOptions, synthetic};
    use super::*;
    use crate::random::Stream;

    #[test]
    fn the_motion_is_named_and_nonsense_is_none_of_these() {
        let table = synthetic::table(4.0e-3, 9);
        let mut other = table.clone();
        for row in &mut other.mean_acceleration {
            for value in row {
                *value *= -1.0;
            }
        }
        let models = [other.model().unwrap(), table.model().unwrap()];
        let first: [_; 13] = core::array::from_fn(|i| Some(synthetic::mean_angle(i, 0.0)));
        let options = KalmanOptions::default();
        let mut filters = models.map(|model| {
            let start = CycleStart::standard(&model, &first, Some(0.0), None).unwrap();
            KalmanFilter::<13>::new(&model, &options, &start).unwrap()
        });
        let mut bank = MotionBank::<2>::new(DEFAULT_MEMORY_FRAMES);
        let mut stream = Stream::new(4, 0, 0);
        assert_eq!(bank.likeliest(), None);
        for frame in 1..130_u8 {
            let seen = core::array::from_fn(|i| {
                Some(synthetic::mean_angle(i, f32::from(frame) / 65.0) + 0.05 * stream.normal())
            });
            let seen = AngleMeasurement::new(&seen, 0.05).unwrap();
            let estimates = core::array::from_fn(|m| filters[m].step(&models[m], &options, &seen));
            bank.add_estimates(&estimates, 13);
        }
        assert_eq!(bank.likeliest(), Some(1));
        assert!(bank.probabilities()[1] > 0.9);
        for _ in 0..130 {
            let seen = core::array::from_fn(|_| Some(TAU * stream.uniform()));
            let seen = AngleMeasurement::new(&seen, 0.05).unwrap();
            let estimates = core::array::from_fn(|m| filters[m].step(&models[m], &options, &seen));
            bank.add_estimates(&estimates, 13);
        }
        assert_eq!(bank.likeliest(), None);
    }
}
