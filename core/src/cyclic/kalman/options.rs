//! Options of the Kalman filters of the cyclic paper.

use crate::error::{ParameterError, not_negative, positive};
use crate::numeric::chi_square::DEFAULT_GATE_SIGMAS;

/// How far the Kalman gain reaches: the paper's "meaning that only these quantities of the state
/// vector are updated" has two readings.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// # use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::{AngleMeasurement, CycleStart, GainReach, KalmanFilter, KalmanOptions};
///
/// # let (model, options) = (WALKING.model()?, KalmanOptions::default());
/// # let start = CycleStart::standard(&model, &[Some(0.0); 13], Some(0.3), None)?;
/// let mut filter = KalmanFilter::<13>::new(&model, &options, &start)?;
/// filter.predict(&model, &options, 1.0);
/// // An angle that is off moves the velocities only where the gain reaches them.
/// let seen = AngleMeasurement::new(&filter.angles_rad().map(|rad| Some(rad + 0.1)), 0.1)?;
/// let velocities = *filter.velocities();
/// filter.correct(&model, GainReach::AnglesOnly, &seen);
/// assert_eq!(*filter.velocities(), velocities);
/// filter.correct(&model, GainReach::Full, &seen);
/// assert_ne!(*filter.velocities(), velocities);
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum GainReach {
    /// The full gain: angles and, by their covariance, velocities (`paper`).
    #[default]
    Full,
    /// The gain cut to the angles: velocities follow the model alone (`paper-cut`).
    AnglesOnly,
}

/// How the covariance of the acceleration scales with k = v / `v_ref`.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// # use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::{CovarianceScaling, CycleStart, KalmanFilter, KalmanOptions};
///
/// # use sinew_core::error::ParameterError;
/// # let model = WALKING.model()?;
/// // At half the reference speed the noise of the acceleration is 1/16, or 1/4.
/// let start = CycleStart::standard(&model, &[Some(0.0); 13], Some(0.3), Some(0.5 * model.reference_velocity()))?;
/// let grown = |scaling| {
///     let options = KalmanOptions { scaling, ..KalmanOptions::default() };
///     let mut filter = KalmanFilter::<13>::new(&model, &options, &start)?;
///     filter.predict(&model, &options, 1.0);
///     Ok::<f32, ParameterError>(filter.covariance().velocity_variances()[0] - options.velocity_variance)
/// };
/// let ratio = grown(CovarianceScaling::Square)? / grown(CovarianceScaling::FourthPower)?;
/// assert!((ratio - 4.0).abs() < 0.05);
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CovarianceScaling {
    /// By k^4, the square of the acceleration's factor k^2 (cyclic paper, section 2.3).
    #[default]
    FourthPower,
    /// By k^2 like the mean, which is the paper's wording.
    Square,
}

/// Options of a Kalman filter; [`Default`] gives the paper's with the decisions named in
/// `docs/cyclic_tracker.md`.
///
/// ```
/// use sinew_core::cyclic::{GainReach, KalmanOptions};
///
/// // The paper's filter with velocities that follow the model alone, and a wider gate that lets nothing beyond it in.
/// let options = KalmanOptions { gate_sigmas: 4.0, protect_from_outliers: true, ..KalmanOptions::cut() };
/// assert_eq!(options.gain, GainReach::AnglesOnly);
/// assert!(options.check().is_ok());
/// let refused = KalmanOptions { angle_variance: 0.0, ..options }.check();
/// assert!(refused.is_err_and(|error| error.parameter == "angle_variance"));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KalmanOptions {
    /// How far the gain reaches.
    pub gain: GainReach,
    /// How the acceleration's covariance scales with speed.
    pub scaling: CovarianceScaling,
    /// Standard deviation of the temporal acceleration, cycles per frame^2: cyclic (10).
    pub temporal_acceleration_std: f32,
    /// First variance of each angle, rad^2.
    pub angle_variance: f32,
    /// First variance of each angular velocity, (rad per frame)^2.
    pub velocity_variance: f32,
    /// First variance of the cycle position, cycles^2.
    pub cycle_position_variance: f32,
    /// First variance of the cycle velocity, (cycles per frame)^2.
    pub cycle_velocity_variance: f32,
    /// Width of the innovation gate in standard deviations of a normal.
    pub gate_sigmas: f32,
    /// Whether a measurement beyond the gate leaves the state as predicted; otherwise it is only
    /// flagged.
    pub protect_from_outliers: bool,
}

/// First variance of an angle, rad^2. Chosen: the paper's first row is exact, so a small one.
pub(crate) const ANGLE_VARIANCE_RAD2: f32 = 1.0e-4;

impl Default for KalmanOptions {
    fn default() -> Self {
        Self {
            gain: GainReach::Full,
            scaling: CovarianceScaling::FourthPower,
            temporal_acceleration_std: 1.0e-4,
            angle_variance: ANGLE_VARIANCE_RAD2,
            velocity_variance: 1.0e-4,
            cycle_position_variance: 1.0e-5,
            cycle_velocity_variance: 1.0e-6,
            gate_sigmas: DEFAULT_GATE_SIGMAS,
            protect_from_outliers: false,
        }
    }
}

impl KalmanOptions {
    /// The options of `paper-cut`.
    #[must_use]
    pub fn cut() -> Self {
        Self { gain: GainReach::AnglesOnly, ..Self::default() }
    }

    /// Checks the numbers.
    ///
    /// # Errors
    /// Variances of angles and velocities and the gate have to be positive, the others not
    /// negative.
    pub fn check(&self) -> Result<(), ParameterError> {
        positive("angle_variance", self.angle_variance)?;
        positive("velocity_variance", self.velocity_variance)?;
        positive("gate_sigmas", self.gate_sigmas)?;
        not_negative("temporal_acceleration_std", self.temporal_acceleration_std)?;
        not_negative("cycle_position_variance", self.cycle_position_variance)?;
        not_negative("cycle_velocity_variance", self.cycle_velocity_variance)?;
        Ok(())
    }
}
