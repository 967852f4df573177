//! Recognition of one of several motions: filters side by side, compared with a bounded memory.
//!
//! ```
//! # #[cfg(feature = "walking-model")] {
//! use sinew_core::cyclic::model::walking::WALKING;
//! use sinew_core::cyclic::recognition::bank::MotionBank;
//! use sinew_core::cyclic::{AngleMeasurement, CoupledFilter};
//!
//! // One motion to choose from: is it walking, or none?
//! let models = [WALKING.model().expect("the shipped model is sound")];
//! let [model] = &models;
//! let seen = |frame: usize| {
//!     let pose = model.mean_pose_rad::<13>(model.point(frame as f32 * model.mean_cycle_velocity()));
//!     AngleMeasurement::new(&pose.map(Some), 0.1).expect("a standard deviation above zero")
//! };
//! let mut filter = CoupledFilter::<13>::new(model, &seen(0), None, None).expect("13 angles");
//! let mut bank = MotionBank::<1, 13>::new(&models);
//! for frame in 1..120 {
//!     let estimate = filter.step(model, &seen(frame));
//!     bank.add(&models, &seen(frame), &[estimate.cycle_position]);
//! }
//! assert_eq!(bank.likeliest(), Some(0));
//! # }
//! ```

use crate::cyclic::recognition::explained_variance::{ExplainedVariance, STANDARD_ERRORS, cycle_variances_rad2};
use crate::cyclic::{AngleMeasurement, CoupledModel};
use crate::math::{exp, max, min, wrap_angle};
use crate::saved_state::{NOT_NEGATIVE, SavedState, StateVisitor};

/// Spread of people's poses about the mean cycle, rad (25 degrees). Chosen: one for all motions and
/// angles, since a model of few people does not determine its own.
const POSE_SPREAD_RAD: f32 = 0.44;
/// Largest distance of an angle from the mean pose, standard deviations. Chosen: short links that
/// wind in a side view would decide alone.
const POSE_LIMIT_SIGMAS: f32 = 1.5;
/// Largest unexplained share of a recognised motion.
///
/// Measured: of 77 walks and runs 1 % of the frames have more. Of 18 recordings of other exercises
/// and gestures 6 % of the frames have less (`docs/cyclic_tracker.md`).
const MAX_UNEXPLAINED_SHARE: f32 = 0.67;
/// Change of the unexplained share by which the odds of a motion change by e. Measured: logistic
/// regression on the same recordings.
const LOG_ODDS_SCALE: f32 = 0.05;

/// Positions at which the variances over the cycle are computed.
const CYCLE_POSITIONS: u8 = 100;

/// Evidence for one motion.
#[derive(Debug, Clone, Copy, PartialEq)]
struct MotionEvidence<const N: usize> {
    swing: ExplainedVariance<N>,
    /// Variance of each angle over the motion's cycle, rad^2.
    cycle_rad2: [f32; N],
    /// Share of the measured variance that the mean cycle leaves unexplained.
    unexplained_share: Option<f32>,
}

impl<const N: usize> MotionEvidence<N> {
    fn new(model: &CoupledModel<'_>) -> Self {
        let cycle_rad2 = cycle_variances_rad2(model, CYCLE_POSITIONS);
        Self { swing: ExplainedVariance::new(), cycle_rad2, unexplained_share: None }
    }

    fn add(&mut self, cycles: f32, measurement: &AngleMeasurement<N>, pose_rad: &[f32; N]) {
        self.swing.add(cycles, measurement, pose_rad);
        if !measurement.is_empty(N) {
            self.unexplained_share = self.swing.unexplained_share(&self.cycle_rad2, measurement.std_rad());
        }
    }
}

/// Half the squared distance of the measured angles from a motion's mean pose, relative to their
/// spread.
fn pose_distance<const N: usize>(measurement: &AngleMeasurement<N>, pose_rad: &[f32]) -> f32 {
    let limit = POSE_LIMIT_SIGMAS * POSE_LIMIT_SIGMAS;
    let distance = |(i, &pose_rad): (usize, &f32)| {
        let apart = wrap_angle(measurement.angle_rad(i)? - pose_rad);
        let std = measurement.std_rad()[i];
        Some(0.5 * min(apart * apart / (POSE_SPREAD_RAD * POSE_SPREAD_RAD + std * std), limit))
    };
    pose_rad.iter().enumerate().filter_map(distance).sum()
}

/// Recursive comparison of up to `MOTIONS` motions of up to `N` angles with each other and with
/// "none of these".
///
/// The likeliest motion is the one whose mean cycle is nearest to the pose, by one spread for all
/// motions. It is recognised if its mean cycle, at the filter's position, explains a third or more
/// of the measured variance. The filters' likelihoods decide neither: after a few cycles a filter
/// has learned the person's deviations and predicts almost as well with a wrong model. Evidence
/// decays over a cycle. A motion that stops is recognised for about two cycles more.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::AngleMeasurement;
/// use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::recognition::bank::MotionBank;
///
/// // Two seconds of walking, then three of standing.
/// let models = [WALKING.model().expect("the shipped model is sound")];
/// let mut bank = MotionBank::<1, 13>::new(&models);
/// assert_eq!(bank.likeliest(), None);
/// for frame in 0..300_u16 {
///     let position = f32::from(frame.min(120)) / 66.0;
///     let pose = models[0].mean_pose_rad::<13>(models[0].point(position));
///     let seen = AngleMeasurement::new(&pose.map(Some), 0.1).expect("a standard deviation above zero");
///     bank.add(&models, &seen, &[position]);
///     if frame == 120 {
///         assert_eq!(bank.likeliest(), Some(0));
///         assert!(bank.probabilities()[0] > 0.9);
///     }
/// }
/// assert_eq!(bank.likeliest(), None);
/// assert!((bank.probabilities()[0] + bank.none_probability() - 1.0).abs() < 1e-5);
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionBank<const MOTIONS: usize, const N: usize> {
    motions: [Option<MotionEvidence<N>>; MOTIONS],
    /// Sum of each motion's pose distances.
    distances: [f32; MOTIONS],
    /// Mean cycle velocity of the slowest motion, cycles a frame.
    min_velocity: f32,
}

impl<const MOTIONS: usize, const N: usize> MotionBank<MOTIONS, N> {
    /// A bank without evidence, for the first `MOTIONS` of the `models`, each a
    /// [`MotionModel`](crate::cyclic::MotionModel) or a [`CoupledModel`].
    #[must_use]
    pub fn new<'m>(models: &[impl AsRef<CoupledModel<'m>>]) -> Self {
        let velocities = models.iter().take(MOTIONS).map(|model| model.as_ref().mean_cycle_velocity());
        Self {
            motions: core::array::from_fn(|motion| models.get(motion).map(|model| MotionEvidence::new(model.as_ref()))),
            distances: [0.0; MOTIONS],
            min_velocity: velocities.fold(1.0, min),
        }
    }

    /// Adds a frame with the cycle position by the filter of each of the `models`, those of
    /// [`MotionBank::new`].
    pub fn add<'m>(
        &mut self,
        models: &[impl AsRef<CoupledModel<'m>>],
        measurement: &AngleMeasurement<N>,
        cycle_positions: &[f32],
    ) {
        let keep = exp(-measurement.step_frames() * self.min_velocity);
        let filters = models.iter().zip(cycle_positions);
        for ((motion, distance), (model, &position)) in self.motions.iter_mut().zip(&mut self.distances).zip(filters) {
            let model = model.as_ref();
            let pose_rad = model.mean_pose_rad::<N>(model.point(position));
            *distance = keep * *distance + pose_distance(measurement, &pose_rad[..model.angle_count().min(N)]);
            if let Some(motion) = motion {
                motion.add(measurement.step_frames() * model.mean_cycle_velocity(), measurement, &pose_rad);
            }
        }
    }

    /// Index of the likeliest motion, also where none is recognised; 0 without evidence.
    #[must_use]
    pub fn best(&self) -> usize {
        let mut best = (f32::INFINITY, 0);
        for (index, (&distance, motion)) in self.distances.iter().zip(&self.motions).enumerate() {
            if motion.is_some() && distance < best.0 {
                best = (distance, index);
            }
        }
        best.1
    }

    /// Log-odds that the likeliest motion is performed.
    fn log_odds(&self) -> f32 {
        let Some(motion) = self.motions.get(self.best()).and_then(Option::as_ref) else { return 0.0 };
        let spare = motion.unexplained_share.map_or(0.0, |unexplained_share| MAX_UNEXPLAINED_SHARE - unexplained_share);
        motion.swing.confidence() * spare / LOG_ODDS_SCALE
    }

    /// Index of the likeliest motion; `None` where "none of these" is likelier.
    #[must_use]
    pub fn likeliest(&self) -> Option<usize> {
        (self.log_odds() > 0.0).then(|| self.best())
    }

    /// Probability of each motion: that any is performed, times its share among them. 0 beyond the
    /// last.
    #[must_use]
    pub fn probabilities(&self) -> [f32; MOTIONS] {
        let mut weights = [0.0; MOTIONS];
        let Some(&nearest) = self.distances.get(self.best()) else { return weights };
        for ((weight, &distance), motion) in weights.iter_mut().zip(&self.distances).zip(&self.motions) {
            *weight = if motion.is_some() { exp(nearest - distance) } else { 0.0 };
        }
        let sum = (1.0 + exp(-self.log_odds())) * max(weights.iter().sum::<f32>(), 1.0);
        weights.map(|weight| weight / sum)
    }

    /// Probability of "none of these".
    #[must_use]
    pub fn none_probability(&self) -> f32 {
        max(1.0 - self.probabilities().iter().sum::<f32>(), 0.0)
    }
}

impl<const MOTIONS: usize, const N: usize> SavedState for MotionBank<MOTIONS, N> {
    /// A state is for a bank of the same models.
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.reals(&mut self.distances, &NOT_NEGATIVE);
        for motion in self.motions.iter_mut().flatten() {
            motion.swing.visit(visitor);
            let mut is_known = motion.unexplained_share.is_some();
            visitor.flag(&mut is_known);
            let mut share = motion.unexplained_share.unwrap_or_default();
            visitor.real(&mut share, &(0.0..=1.0 + STANDARD_ERRORS));
            motion.unexplained_share = is_known.then_some(share);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cyclic::kalman::filter::KalmanFilter;
    use crate::cyclic::{CycleStart, KalmanOptions, synthetic};
    use crate::random::Stream;
    use core::f32::consts::TAU;

    /// Three seconds of the motion, of another one, and of random angles, by two models.
    #[test]
    fn the_motion_is_recognised_and_any_other_is_none_of_these() {
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
        let mut bank = MotionBank::<4, 13>::new(&models);
        let mut stream = Stream::new(4, 0, 0);
        assert_eq!((bank.likeliest(), bank.best()), (None, 0));
        let mut watch = |angle: &dyn Fn(usize, f32, &mut Stream) -> f32| {
            for frame in 1..=180_u8 {
                let seen = core::array::from_fn(|i| Some(angle(i, f32::from(frame), &mut stream)));
                let seen = AngleMeasurement::new(&seen, 0.05).unwrap();
                let positions: [_; 2] =
                    core::array::from_fn(|m| filters[m].step(&models[m], &options, &seen).cycle_position);
                bank.add(&models, &seen, &positions);
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
    fn without_measurements_the_order_of_the_motions_stays() {
        let table = synthetic::table(4.0e-3, 9);
        let models = [table.model().unwrap(); 2];
        let mut bank = MotionBank::<3, 13>::new(&models);
        let seen = |frame: u8| core::array::from_fn(|i| Some(synthetic::mean_angle(i, f32::from(frame) / 65.0)));
        for frame in 0..130 {
            let position = f32::from(frame) / 65.0;
            bank.add(&models, &AngleMeasurement::new(&seen(frame), 0.1).unwrap(), &[position + 0.5, position]);
        }
        assert_eq!(bank.likeliest(), Some(1));
        let before = bank.probabilities();
        assert!(before[1] > 0.9 && before[2] == 0.0, "{before:?}");
        bank.add(&models, &AngleMeasurement::nothing().after(130.0).unwrap(), &[0.0; 2]);
        assert_eq!(bank.likeliest(), Some(1));
        let probabilities = bank.probabilities();
        assert!(probabilities[1] < before[1] && probabilities[0] > before[0], "less is known: {probabilities:?}");
        let no_models: [CoupledModel<'_>; 0] = [];
        assert_eq!(MotionBank::<3, 13>::new(&no_models).probabilities(), [0.0; 3]);
    }
}
