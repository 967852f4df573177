//! The Kalman filter of the cyclic paper, cyclic (2) to cyclic (12), in the block form of its
//! kinematics.
//!
//! The update by one measured angle after the other equals the joint update for independent noise.
//! Position and velocity in the cycle are never corrected, since the paper's measurement does not
//! update them (section 3). The phase-coupled filter corrects them.

use crate::angle::split_turns;
use crate::cyclic::cycle_state::CycleState;
use crate::cyclic::kalman::covariance::KinematicCovariance;
use crate::cyclic::kalman::joint_update::SeenAngles;
use crate::cyclic::kalman::options::{CovarianceScaling, GainReach, KalmanOptions};
use crate::cyclic::substeps::Substeps;
use crate::cyclic::{AngleMeasurement, CycleStart, CyclicEstimate, MotionModel};
use crate::error::{ParameterError, Rule};
use crate::math::clamp;
use crate::numeric::chi_square::is_outlier;
use crate::random::normal::LOG_SQRT_TAU;
use crate::skeleton::stick_figure::HUMAN_ANGLES;
use core::f32::consts::PI;

/// State of the filters `paper` and `paper-cut` for models of up to `N` angles.
///
/// Invariants: all numbers finite, angles in (-pi, pi], covariance symmetric and positive
/// semi-definite.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::{AngleMeasurement, CycleStart, KalmanFilter, KalmanOptions};
///
/// let (model, options) = (WALKING.model()?, KalmanOptions::default());
/// let pose_rad = |frame: u8| model.mean_pose_rad::<13>(model.point(f32::from(frame) * model.mean_cycle_velocity()));
/// let start = CycleStart::standard(&model, &pose_rad(0).map(Some), Some(0.0), None)?;
/// let mut filter = KalmanFilter::new(&model, &options, &start)?;
/// for frame in 1..=20 {
///     filter.step(&model, &options, &AngleMeasurement::new(&pose_rad(frame).map(Some), 0.1)?);
/// }
/// // Ten frames without a measurement: along the mean cycle, with more variance.
/// let seen_variance = filter.covariance().angle_variances()[0];
/// let bridged = filter.step(&model, &options, &AngleMeasurement::nothing().after(10.0)?);
/// assert!((bridged.angles_rad[0] - pose_rad(30)[0]).abs() < 0.1);
/// assert!(bridged.angle_variance_rad2[0] > 2.0 * seen_variance);
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KalmanFilter<const N: usize> {
    pub(super) angles_rad: [f32; N],
    pub(super) turns: [i32; N],
    pub(super) velocities: [f32; N],
    pub(super) covariance: KinematicCovariance<N>,
    pub(super) cycle: CycleState,
}

const _: () = assert!(size_of::<KalmanFilter<HUMAN_ANGLES>>() <= 2560, "the state has to fit 2.5 KiB");

/// Innovation of a frame's measurement.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// # use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::numeric::chi_square::chi_square_quantile;
/// use sinew_core::cyclic::{AngleMeasurement, CycleStart, GainReach, KalmanFilter, KalmanOptions};
///
/// # let model = WALKING.model()?;
/// # let start = CycleStart::standard(&model, &[None; 13], Some(0.3), None)?;
/// let mut filter = KalmanFilter::new(&model, &KalmanOptions::default(), &start)?;
/// // Two angles as expected, and once more half a turn off.
/// let mut angles_rad = [None; 13];
/// (angles_rad[0], angles_rad[1]) = (Some(filter.angles_rad()[0]), Some(filter.angles_rad()[1]));
/// let expected = filter.correct(&model, GainReach::Full, &AngleMeasurement::new(&angles_rad, 0.1)?);
/// assert!(expected.squared < 1e-6 && expected.present == 2);
/// let turned = angles_rad.map(|angle| angle.map(|rad: f32| rad + core::f32::consts::PI));
/// let wrong = filter.correct(&model, GainReach::Full, &AngleMeasurement::new(&turned, 0.1)?);
/// assert!(wrong.squared > chi_square_quantile(2, 4.0) && wrong.log_likelihood < expected.log_likelihood);
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Innovation {
    /// ln of the density of the measurement given those before; 0 where nothing was seen.
    pub log_likelihood: f32,
    /// Normalised innovation squared, chi-square distributed with [`Self::present`] degrees of
    /// freedom.
    pub squared: f32,
    /// Angles seen.
    pub present: usize,
}

impl<const N: usize> KalmanFilter<N> {
    /// A filter at its start.
    ///
    /// # Errors
    /// At most `N` angles in the model; sound `options`; finite angles and velocities.
    pub fn new(
        model: &MotionModel<'_>,
        options: &KalmanOptions,
        start: &CycleStart<N>,
    ) -> Result<Self, ParameterError> {
        options.check()?;
        if model.angle_count() > N {
            return Err(ParameterError::new("angles of the model", Rule::Capacity { capacity: N }));
        }
        start.check()?;
        let mut angle_variance = [0.0; N];
        let mut velocity_variance = [0.0; N];
        for i in 0..model.angle_count() {
            angle_variance[i] = options.angle_variance + start.extra_variance_rad2[i];
            velocity_variance[i] = options.velocity_variance;
        }
        let split = start.angles_rad.map(split_turns);
        Ok(Self {
            angles_rad: split.map(|(angle, _)| angle),
            turns: split.map(|(_, turns)| turns),
            velocities: start.velocities,
            covariance: KinematicCovariance::diagonal(&angle_variance, &velocity_variance),
            cycle: CycleState {
                position: start.cycle_position,
                velocity: start.cycle_velocity,
                position_variance: options.cycle_position_variance,
                covariance: 0.0,
                velocity_variance: options.cycle_velocity_variance,
            },
        })
    }

    /// One frame: predict over the measurement's step, then correct by the angles seen. On x86-64
    /// all of it is inlined, so that a caller compiled for wider vectors than the crate has
    /// them; elsewhere it would cost flash.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub fn step(
        &mut self,
        model: &MotionModel<'_>,
        options: &KalmanOptions,
        measurement: &AngleMeasurement<N>,
    ) -> CyclicEstimate<N> {
        self.predict(model, options, measurement.step_frames());
        let predicted = options.protect_from_outliers.then_some(*self);
        let innovation = self.correct(model, options.gain, measurement);
        let outlier = is_outlier(innovation.squared, innovation.present, options.gate_sigmas);
        if let (true, Some(predicted)) = (outlier, predicted) {
            *self = predicted;
        }
        self.estimate(&innovation, outlier)
    }

    /// The state transition of cyclic (11) and cyclic (12) over `step_frames`, in substeps of at
    /// most one frame.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub fn predict(&mut self, model: &MotionModel<'_>, options: &KalmanOptions, step_frames: f32) {
        let temporal_variance = options.temporal_acceleration_std * options.temporal_acceleration_std;
        for step in Substeps::of(step_frames) {
            let point = model.point(self.cycle.position);
            let ratio = model.speed_ratio(self.cycle.velocity);
            let squared_ratio = ratio * ratio;
            let covariance_scale = match options.scaling {
                CovarianceScaling::FourthPower => squared_ratio * squared_ratio,
                CovarianceScaling::Square => squared_ratio,
            };
            let acceleration = model.mean_acceleration::<N>(point);
            for i in 0..N {
                self.move_angle(i, step, squared_ratio * acceleration[i]);
            }
            let (before, after) = model.covariance_pair(point);
            // White noise per frame: a part of a frame has its part of the velocity's variance.
            self.covariance.advance(step, before, after, point.fraction, covariance_scale / step);
            self.covariance.saturate();
            self.cycle.advance(step, temporal_variance / step);
        }
    }

    /// One angle by cyclic (2), its velocity by cyclic (3).
    #[inline]
    fn move_angle(&mut self, index: usize, step: f32, acceleration: f32) {
        let moved = self.angles_rad[index] + step * self.velocities[index] + 0.5 * step * step * acceleration;
        self.set_angle(index, moved);
        self.velocities[index] = clamp(self.velocities[index] + step * acceleration, -PI, PI);
    }

    #[inline]
    fn set_angle(&mut self, index: usize, angle_rad: f32) {
        let (angle, turns) = split_turns(angle_rad);
        self.angles_rad[index] = angle;
        self.turns[index] = self.turns[index].saturating_add(turns);
    }

    /// The measurement update, angle by angle; innovations are wrapped relative to the prediction.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    pub fn correct(
        &mut self,
        model: &MotionModel<'_>,
        gain: GainReach,
        measurement: &AngleMeasurement<N>,
    ) -> Innovation {
        let seen = SeenAngles::of(measurement, &self.angles_rad, model.angle_count());
        if seen.count() == 0 {
            return Innovation { log_likelihood: 0.0, squared: 0.0, present: 0 };
        }
        let shift = self.covariance.correct(&seen, gain == GainReach::AnglesOnly);
        for i in 0..N {
            self.set_angle(i, self.angles_rad[i] + shift.angles_rad[i]);
            self.velocities[i] = clamp(self.velocities[i] + shift.velocities[i], -PI, PI);
        }
        let log_likelihood = -0.5 * (shift.squared + shift.determinant.ln()) - seen.count() as f32 * LOG_SQRT_TAU;
        Innovation { log_likelihood, squared: shift.squared, present: seen.count() }
    }

    #[cfg_attr(target_arch = "x86_64", inline(always))]
    fn estimate(&self, innovation: &Innovation, outlier: bool) -> CyclicEstimate<N> {
        CyclicEstimate {
            angles_rad: self.angles_rad,
            turns: self.turns,
            angle_variance_rad2: self.covariance.angle_variances(),
            cycle_position: self.cycle.position,
            cycle_position_variance: self.cycle.position_variance,
            cycle_velocity_per_frame: self.cycle.velocity,
            cycle_velocity_variance: self.cycle.velocity_variance,
            log_likelihood: innovation.log_likelihood,
            outlier,
            misfit: false,
        }
    }

    /// Angles in (-pi, pi].
    #[must_use]
    pub const fn angles_rad(&self) -> &[f32; N] {
        &self.angles_rad
    }

    /// Angular velocities, rad per frame.
    #[must_use]
    pub const fn velocities(&self) -> &[f32; N] {
        &self.velocities
    }

    /// Covariance of angles and velocities.
    #[must_use]
    pub const fn covariance(&self) -> &KinematicCovariance<N> {
        &self.covariance
    }

    /// Position and velocity in the cycle with their covariance.
    #[must_use]
    pub const fn cycle(&self) -> &CycleState {
        &self.cycle
    }
}
