//! Which of several motions is it? Filters that run side by side, compared with a bounded memory.
//!
//! ```
//! # #[cfg(feature = "walking-model")] {
//! use sinew_core::cyclic::models::walking::WALKING;
//! use sinew_core::cyclic::motion_bank::{DEFAULT_MEMORY_S, MotionBank, MotionEvidence};
//! use sinew_core::cyclic::{AngleMeasurement, CoupledFilter};
//!
//! // One motion to choose from: is it walking, or none?
//! let model = WALKING.model().expect("the shipped model is sound");
//! let seen = |frame: usize| {
//!     let pose = model.mean_pose_rad::<13>(model.point(frame as f32 * model.mean_cycle_velocity()));
//!     AngleMeasurement::new(&pose.map(Some), 0.1).expect("a standard deviation above zero")
//! };
//! let mut filter = CoupledFilter::<13>::new(&model, &seen(0), None, None).expect("13 angles");
//! let mut bank = MotionBank::<1, 13>::new(1, &seen(0), DEFAULT_MEMORY_S);
//! for frame in 1..120 {
//!     let estimate = filter.step(&model, &seen(frame));
//!     let evidence = MotionEvidence::new(&model, &seen(frame), estimate.cycle_position, estimate.log_likelihood);
//!     bank.add(&seen(frame), 1.0 / 60.0, &[evidence]);
//! }
//! assert_eq!(bank.likeliest(), Some(0));
//! # }
//! ```

use super::angle_walk::AngleWalk;
use super::{AngleMeasurement, MotionModel};
use crate::math::{clamp, exp, ln, max, min, wrap_angle};
use core::f32::consts::{LN_2, TAU};

/// Seconds after which a frame's evidence counts 1/e.
pub const DEFAULT_MEMORY_S: f32 = 1.0;
/// Spread of people's poses about the mean cycle, rad (25 degrees): the same for every motion and angle.
const POSE_SPREAD_RAD: f32 = 0.44;
/// Beyond so many standard deviations an angle counts no more: short links that wind in a side view would decide alone.
const POSE_LIMIT_SIGMAS: f32 = 1.5;

/// What a frame says of one motion.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::AngleMeasurement;
/// use sinew_core::cyclic::models::walking::WALKING;
/// use sinew_core::cyclic::motion_bank::MotionEvidence;
///
/// // The pose of position 0.2 lies nearer to itself than to the opposite one.
/// let model = WALKING.model()?;
/// let seen = AngleMeasurement::new(&model.mean_pose_rad::<13>(model.point(0.2)).map(Some), 0.1)?;
/// let near = MotionEvidence::new(&model, &seen, 0.2, 0.0);
/// let far = MotionEvidence::new(&model, &seen, 0.7, 0.0);
/// assert!(near.pose_distance < 1e-6 && far.pose_distance > 0.5);
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MotionEvidence {
    /// Log-likelihood that the motion's filter gave the frame.
    pub log_likelihood: f32,
    /// Half the squared distance of the angles seen from the motion's mean pose, relative to their spread.
    pub pose_distance: f32,
}

impl MotionEvidence {
    /// From a measurement and what the filter of `model` answered to it.
    #[must_use]
    pub fn new<const N: usize>(
        model: &MotionModel<'_>,
        measurement: &AngleMeasurement<N>,
        cycle_position: f32,
        log_likelihood: f32,
    ) -> Self {
        let pose = model.mean_pose_rad::<N>(model.point(cycle_position));
        let limit = POSE_LIMIT_SIGMAS * POSE_LIMIT_SIGMAS;
        let distance = |i: usize| {
            let apart = wrap_angle(measurement.angle_rad(i)? - pose[i]);
            let std = measurement.std_rad()[i];
            Some(0.5 * min(apart * apart / (POSE_SPREAD_RAD * POSE_SPREAD_RAD + std * std), limit))
        };
        Self { log_likelihood, pose_distance: (0..model.angle_count().min(N)).filter_map(distance).sum() }
    }
}

/// Recursive comparison of `MOTIONS` motions of up to `N` angles with each other and with "none of these".
///
/// Among the motions the one whose mean cycle the pose lies nearest to is the likeliest, by one spread for all: after a few
/// cycles a filter has learned the person's deviations, whatever the motion, and predicts almost as well with a wrong model as with the right one.
/// It is named if its filter predicts better than "none", which is one half a walk at random from where each angle was,
/// as any motion may be taken, and one half an angle anywhere on the circle. Older evidence fades, so that the
/// scores stay bounded and a change of motion is noticed.
///
/// ```
/// use sinew_core::cyclic::AngleMeasurement;
/// use sinew_core::cyclic::motion_bank::{DEFAULT_MEMORY_S, MotionBank, MotionEvidence};
///
/// // Two motions of one angle. For a second the filter of the second one predicts well, that of the first badly.
/// let seen = AngleMeasurement::new(&[Some(0.2)], 0.1)?;
/// let mut bank = MotionBank::<2, 1>::new(2, &seen, DEFAULT_MEMORY_S);
/// let bad = MotionEvidence { log_likelihood: -8.0, pose_distance: 1.0 };
/// let good = MotionEvidence { log_likelihood: 1.3, pose_distance: 0.1 };
/// for _ in 0..60 {
///     bank.add(&seen, 1.0 / 60.0, &[bad, good]);
/// }
/// assert_eq!(bank.likeliest(), Some(1));
/// let [first, second] = bank.probabilities();
/// assert!(first < 0.01 && second > 0.9);
/// assert!((first + second + bank.none_probability() - 1.0).abs() < 1e-5);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionBank<const MOTIONS: usize, const N: usize> {
    /// Log-likelihood of each motion above that of uniform angles.
    scores: [f32; MOTIONS],
    /// Sum of each motion's pose distances.
    distances: [f32; MOTIONS],
    /// Log-likelihood of the walk above that of uniform angles.
    walk_score: f32,
    walk: AngleWalk<N>,
    motions: usize,
    memory_s: f32,
}

/// Greatest size of a score: beyond it there is no doubt.
const SCORE_LIMIT: f32 = 1.0e4;
/// Most that one frame speaks against a motion and for none, nats: frames far off a model whose normal density has no tails would
/// outweigh many good ones.
const SURPRISE_LIMIT: f32 = 1.5;
/// Least memory, seconds.
const LEAST_MEMORY_S: f32 = 0.01;

impl<const MOTIONS: usize, const N: usize> MotionBank<MOTIONS, N> {
    /// No evidence yet: `first` is the measurement from which the filters of the first `motions` (at most `MOTIONS`) began.
    /// A memory of less than a hundredth of a second counts as that.
    #[must_use]
    pub fn new(motions: usize, first: &AngleMeasurement<N>, memory_s: f32) -> Self {
        let mut walk = AngleWalk::default();
        walk.step(first, 0.0);
        Self {
            scores: [0.0; MOTIONS],
            distances: [0.0; MOTIONS],
            walk_score: 0.0,
            walk,
            motions: motions.min(MOTIONS),
            memory_s: max(memory_s, LEAST_MEMORY_S),
        }
    }

    /// Takes in a frame that came `step_s` seconds after the last, with what it says of each motion.
    pub fn add(&mut self, measurement: &AngleMeasurement<N>, step_s: f32, evidence: &[MotionEvidence]) {
        let keep = exp(-max(step_s, 0.0) / self.memory_s);
        let uniform = -(measurement.present(N) as f32) * ln(TAU);
        let faded = |score: f32, log_likelihood: f32| {
            let gain = if log_likelihood.is_finite() { log_likelihood - uniform } else { -SCORE_LIMIT };
            clamp(keep * score + gain, -SCORE_LIMIT, SCORE_LIMIT)
        };
        let walked = self.walk.step(measurement, max(step_s, 0.0));
        for ((score, distance), evidence) in self.scores.iter_mut().zip(&mut self.distances).zip(evidence) {
            let told = evidence.log_likelihood;
            let bounded = if told.is_finite() { max(told, walked - SURPRISE_LIMIT) } else { told };
            *score = faded(*score, bounded);
            *distance = keep * *distance + min(evidence.pose_distance, SCORE_LIMIT);
        }
        self.walk_score = faded(self.walk_score, walked);
    }

    /// Log-likelihood of "none of these" above that of uniform angles.
    fn none_score(&self) -> f32 {
        let greater = max(self.walk_score, 0.0);
        greater + ln(exp(-greater) + exp(self.walk_score - greater)) - LN_2
    }

    /// Index of the motion that is likeliest among them, whether or not it is likelier than none; 0 where there is no evidence.
    #[must_use]
    pub fn best(&self) -> usize {
        let mut best = (f32::INFINITY, 0);
        for (index, &distance) in self.distances.iter().take(self.motions).enumerate() {
            if distance < best.0 {
                best = (distance, index);
            }
        }
        best.1
    }

    /// Index of the likeliest motion; `None` where none of these is likelier.
    #[must_use]
    pub fn likeliest(&self) -> Option<usize> {
        let best = self.best();
        self.scores.get(best).is_some_and(|score| *score > self.none_score()).then_some(best)
    }

    /// Probability of each motion, 0 beyond the motions there are: that the likeliest is one at all, times its share among them.
    #[must_use]
    pub fn probabilities(&self) -> [f32; MOTIONS] {
        let (best, mut weights) = (self.best(), [0.0; MOTIONS]);
        let (Some(&score), Some(&least)) = (self.scores.get(best), self.distances.get(best)) else { return weights };
        for (weight, &distance) in weights.iter_mut().zip(&self.distances).take(self.motions) {
            *weight = exp(least - distance);
        }
        let sum = (1.0 + exp(min(self.none_score() - score, 80.0))) * max(weights.iter().sum::<f32>(), 1.0);
        weights.map(|weight| weight / sum)
    }

    /// Probability of "none of these".
    #[must_use]
    pub fn none_probability(&self) -> f32 {
        max(1.0 - self.probabilities().iter().sum::<f32>(), 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::super::kalman::KalmanFilter;
    use super::super::{CycleStart, KalmanOptions, synthetic};
    use super::*;
    use crate::random::Stream;

    /// Three seconds of the motion, of another one, and of nonsense, watched by both models.
    #[test]
    fn the_motion_is_named_and_anything_else_is_none_of_these() {
        let table = synthetic::table(4.0e-3, 9);
        let mut other = table.clone();
        for value in other.mean_acceleration.iter_mut().chain(&mut other.mean_pose_rad).flatten() {
            *value *= -1.0;
        }
        let models = [other.model().unwrap(), table.model().unwrap()];
        let first: [_; 13] = core::array::from_fn(|i| Some(synthetic::mean_angle(i, 0.0)));
        let options = KalmanOptions::default();
        let mut filters = models.map(|model| {
            let start = CycleStart::standard(&model, &first, Some(0.0), None).unwrap();
            KalmanFilter::<13>::new(&model, &options, &start).unwrap()
        });
        let first = AngleMeasurement::new(&first, 0.05).unwrap();
        let mut bank = MotionBank::<4, 13>::new(2, &first, 1.0);
        let mut stream = Stream::new(4, 0, 0);
        assert_eq!((bank.likeliest(), bank.best()), (None, 0));
        let mut watch = |angle: &dyn Fn(usize, f32, &mut Stream) -> f32| {
            for frame in 1..=180_u8 {
                let seen = core::array::from_fn(|i| Some(angle(i, f32::from(frame), &mut stream)));
                let seen = AngleMeasurement::new(&seen, 0.05).unwrap();
                let all: [_; 2] = core::array::from_fn(|m| {
                    let estimate = filters[m].step(&models[m], &options, &seen);
                    MotionEvidence::new(&models[m], &seen, estimate.cycle_position, estimate.log_likelihood)
                });
                bank.add(&seen, 1.0 / 60.0, &all);
            }
            let sum = bank.probabilities().iter().sum::<f32>() + bank.none_probability();
            assert!((sum - 1.0).abs() < 1.0e-5, "{sum}");
            bank
        };
        let named = watch(&|i, frame, stream| synthetic::mean_angle(i, frame / 65.0) + 0.05 * stream.normal());
        assert_eq!(named.likeliest(), Some(1));
        assert!(named.probabilities()[1] > 0.9);
        let squats = watch(&|i, frame, stream| (0.3 * i as f32 * (frame / 40.0).sin()) + 0.05 * stream.normal());
        assert_eq!(squats.likeliest(), None);
        assert!(squats.none_probability() > 0.9);
        assert_eq!(watch(&|_, _, stream| TAU * stream.uniform()).likeliest(), None);
    }

    #[test]
    fn without_measurements_nothing_changes_its_place() {
        let mut bank = MotionBank::<2, 13>::new(2, &AngleMeasurement::nothing(), 1.0);
        let seen = AngleMeasurement::new(&[Some(0.3); 13], 0.1).unwrap();
        let evidence = |log_likelihood, pose_distance| MotionEvidence { log_likelihood, pose_distance };
        bank.add(&seen, 0.1, &[evidence(10.0, 9.0), evidence(10.0, 3.0)]);
        assert_eq!(bank.likeliest(), Some(1));
        bank.add(&AngleMeasurement::nothing(), 2.0, &[MotionEvidence::default(); 2]);
        assert_eq!(bank.likeliest(), Some(1));
        let probabilities = bank.probabilities();
        assert!(probabilities[1] > 0.5 && probabilities[0] > 0.2, "little is known any more: {probabilities:?}");
        bank.add(&seen, 0.1, &[evidence(0.0, 9.0), evidence(f32::NAN, 3.0)]);
        assert_eq!((bank.best(), bank.likeliest()), (1, None));
    }
}
