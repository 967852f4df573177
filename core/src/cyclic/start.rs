//! First state of a filter: pose, velocities, cycle position and velocity (cyclic paper, sections
//! 3.2 and 3.3).

use crate::angle::{angle_difference, split_turns};
use crate::cyclic::phase::wrap_position;
use crate::cyclic::{CoupledModel, CyclicEstimate, MotionModel};
use crate::error::{ParameterError, finite};

/// First variance of a missing angle in a model without deviation, rad^2. Chosen: a standard
/// deviation of half a radian.
const UNSEEN_VARIANCE: f32 = 0.25;
/// Smallest spread of an angle when poses are compared, rad. Chosen: so that no single angle
/// decides.
pub(super) const MIN_SPREAD_RAD: f32 = 0.05;
/// Largest cycle velocity, cycles per frame. Chosen: two frames a cycle, the limit of the sampling
/// theorem.
pub const MAX_CYCLE_VELOCITY: f32 = 0.5;

/// First state of a filter.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::CycleStart;
/// use sinew_core::cyclic::model::walking::WALKING;
///
/// // The first frame shows all angles but one, which starts at the mean cycle with more variance.
/// let model = WALKING.model()?;
/// let mut first_rad = model.mean_pose_rad::<13>(model.point(0.3)).map(Some);
/// first_rad[5] = None;
/// let start = CycleStart::standard(&model, &first_rad, None, None)?;
/// assert!((start.cycle_position - 0.3).abs() < 0.02);
/// assert_eq!(start.extra_variance_rad2[4], 0.0);
/// assert!(start.extra_variance_rad2[5] > 0.0);
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CycleStart<const N: usize> {
    /// Angles, radians, any turn.
    pub angles_rad: [f32; N],
    /// Extra variance of each angle, rad^2: 0 where the first frame shows it.
    pub extra_variance_rad2: [f32; N],
    /// Angular velocities, rad per frame.
    pub velocities: [f32; N],
    /// Position in the cycle, [0, 1).
    pub cycle_position: f32,
    /// Velocity through the cycle, cycles per frame.
    pub cycle_velocity: f32,
}

impl<const N: usize> CycleStart<N> {
    /// The standard start: the angles of the first frame, the model's mean velocities times k.
    ///
    /// Without a `position` the one whose mean pose matches best is taken, without a `velocity` the
    /// mean of the training cycles. An angle that is missing starts at the model's mean pose
    /// with its spread.
    ///
    /// # Errors
    /// `position` finite; `velocity` within +-0.5 cycles a frame.
    pub fn standard(
        model: &MotionModel<'_>,
        first_rad: &[Option<f32>; N],
        position: Option<f32>,
        velocity: Option<f32>,
    ) -> Result<Self, ParameterError> {
        let cycle_position = match position {
            Some(position) => wrap_position(finite("initial cycle position", position)?),
            None => best_position(model, first_rad),
        };
        let cycle_velocity = velocity.unwrap_or(model.mean_cycle_velocity());
        crate::error::within("initial cycle velocity", cycle_velocity, -MAX_CYCLE_VELOCITY, MAX_CYCLE_VELOCITY)?;
        let point = model.point(cycle_position);
        let ratio = model.speed_ratio(cycle_velocity);
        let mut start = Self {
            angles_rad: model.mean_pose_rad(point),
            extra_variance_rad2: model.deviation_std_rad::<N>().map(|std| std * std),
            velocities: model.mean_velocity::<N>(point).map(|velocity| ratio * velocity),
            cycle_position,
            cycle_velocity,
        };
        if model.parts().deviation.is_absent() {
            start.extra_variance_rad2 = [UNSEEN_VARIANCE; N];
        }
        for i in 0..N {
            if let Some(angle) = first_rad[i].filter(|angle| angle.is_finite()) {
                start.angles_rad[i] = angle;
                start.extra_variance_rad2[i] = 0.0;
            }
        }
        Ok(start)
    }

    /// The start as an estimate: its angles and their extra variance, no spread in the cycle.
    #[must_use]
    pub fn estimate(&self) -> CyclicEstimate<N> {
        let split = self.angles_rad.map(split_turns);
        CyclicEstimate {
            angles_rad: split.map(|(angle, _)| angle),
            turns: split.map(|(_, turns)| turns),
            angle_variance_rad2: self.extra_variance_rad2,
            cycle_position: self.cycle_position,
            cycle_position_variance: 0.0,
            cycle_velocity_per_frame: self.cycle_velocity,
            cycle_velocity_variance: 0.0,
            log_likelihood: 0.0,
            outlier: false,
            misfit: false,
        }
    }

    /// Checks the numbers.
    ///
    /// # Errors
    /// Finite angles, velocities and position; extra variances not negative; cycle velocity within
    /// +-0.5.
    pub fn check(&self) -> Result<(), ParameterError> {
        for i in 0..N {
            finite("initial angle", self.angles_rad[i])?;
            finite("initial angular velocity", self.velocities[i])?;
            crate::error::not_negative("initial angle variance", self.extra_variance_rad2[i])?;
        }
        crate::error::within("initial cycle position", self.cycle_position, 0.0, 1.0)?;
        crate::error::within("initial cycle velocity", self.cycle_velocity, -MAX_CYCLE_VELOCITY, MAX_CYCLE_VELOCITY)?;
        Ok(())
    }
}

/// The stored position whose mean pose is nearest to the measured angles, each difference relative
/// to the angle's spread; 0 without measured angles.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::model::walking::WALKING;
/// use sinew_core::cyclic::start::best_position;
///
/// // Where in the cycle a single picture is.
/// let model = WALKING.model()?;
/// let pose_rad = model.mean_pose_rad::<13>(model.point(0.62)).map(Some);
/// assert_eq!(best_position(&model, &pose_rad), 0.62);
/// # }
/// # Ok::<(), sinew_core::cyclic::ModelError>(())
/// ```
#[must_use]
pub fn best_position<const N: usize>(model: &CoupledModel<'_>, angles_rad: &[Option<f32>; N]) -> f32 {
    let count = model.position_count();
    let mut best = (f32::INFINITY, 0.0);
    for index in 0..count {
        let position = index as f32 / count as f32;
        let point = model.point(position);
        let pose = model.mean_pose_rad::<N>(point);
        let spread = model.deviation_std_rad::<N>();
        let mut distance = 0.0;
        for i in 0..N.min(model.angle_count()) {
            if let Some(angle) = angles_rad[i].filter(|angle| angle.is_finite()) {
                let scaled = angle_difference(angle, pose[i]) / crate::math::max(spread[i], MIN_SPREAD_RAD);
                distance += scaled * scaled;
            }
        }
        if distance < best.0 {
            best = (distance, position);
        }
    }
    best.1
}
