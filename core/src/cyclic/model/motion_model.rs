//! The motion model: moments of the training cycles at every position of the cycle (cyclic paper,
//! section 2.3).
//!
//! Immutable and borrowed: the numbers lie in flash (a `static` [`crate::cyclic::ModelTable`]) or
//! in a host's vectors, the filters only read them. All derivatives are per frame of the reference
//! cycle, in which the cycle takes l frames. A person who goes through the cycle k = v l times as
//! fast has k times the velocity and k^2 times the acceleration.

use crate::cyclic::model::coupled_model::{CoupledModel, CoupledParts, ModelError, check_rows};
use crate::cyclic::model::deviation::Deviation;
use crate::error::{ParameterError, Rule, finite};
use crate::numeric::semi_definite::{is_positive_semi_definite, packed_len};
use core::ops::Deref;

/// The numbers of a motion model with n angles and l positions, not yet checked.
///
/// ```
/// use sinew_core::cyclic::{Deviation, ModelParts, MotionModel};
///
/// // One angle that swings by half a radian, at four positions of the cycle, seen at 20 frames a second.
/// let parts = ModelParts {
///     angle_count: 1,
///     mean_pose_rad: &[0.0, 0.5, 0.0, -0.5],
///     mean_velocity: &[0.5, 0.0, -0.5, 0.0],
///     mean_acceleration: &[0.0, -1.0, 0.0, 1.0],
///     acceleration_covariance: &[0.01; 4],
///     turns_per_cycle: &[0],
///     mean_duration_frames: 20.0,
///     rate_hz: 20.0,
///     deviation: Deviation::default(),
/// };
/// assert_eq!(MotionModel::new(parts)?.mean_cycle_velocity(), 0.05);
/// // Five poses at four positions.
/// assert!(MotionModel::new(ModelParts { mean_pose_rad: &[0.0; 5], ..parts }).is_err());
/// # Ok::<(), sinew_core::cyclic::ModelError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModelParts<'a> {
    /// Number n of angles.
    pub angle_count: usize,
    /// Mean angular acceleration, rad per reference frame squared: l rows of n, cyclic (7).
    pub mean_acceleration: &'a [f32],
    /// Covariance of the acceleration, rad^2 per reference frame^4: l packed lower triangles of n
    /// (n + 1) / 2, cyclic (7).
    pub acceleration_covariance: &'a [f32],
    /// Mean angles, radians, unwrapped along the cycle: l rows of n.
    pub mean_pose_rad: &'a [f32],
    /// Mean angular velocity, rad per reference frame: l rows of n.
    pub mean_velocity: &'a [f32],
    /// Whole turns that each angle makes in a cycle, n: 0 for an angle that swings, +-1 for one
    /// that winds.
    pub turns_per_cycle: &'a [i8],
    /// Mean duration of the training cycles, frames at [`Self::rate_hz`].
    pub mean_duration_frames: f32,
    /// Frames per second of the training cycles.
    pub rate_hz: f32,
    /// Spread about the mean cycle, for the phase-coupled filter.
    pub deviation: Deviation<'a>,
}

impl<'a> ModelParts<'a> {
    /// What the phase-coupled filter reads of them.
    #[must_use]
    pub const fn coupled(&self) -> CoupledParts<'a> {
        CoupledParts {
            angle_count: self.angle_count,
            mean_pose_rad: self.mean_pose_rad,
            turns_per_cycle: self.turns_per_cycle,
            mean_duration_frames: self.mean_duration_frames,
            rate_hz: self.rate_hz,
            deviation: self.deviation,
        }
    }

    /// All tables of real numbers, those of the cycle first; the order is that of
    /// [`crate::cyclic::model::bytes`].
    #[must_use]
    pub const fn tables(&self) -> [&'a [f32]; 9] {
        let Deviation { offset_std_rad, cosine_std_rad, sine_std_rad, rest_std_rad, rest_rate_per_cycle } =
            self.deviation;
        [
            self.mean_acceleration,
            self.acceleration_covariance,
            self.mean_pose_rad,
            self.mean_velocity,
            offset_std_rad,
            cosine_std_rad,
            sine_std_rad,
            rest_std_rad,
            rest_rate_per_cycle,
        ]
    }
}

/// A checked motion model.
///
/// Invariants: all numbers are finite, the lengths agree, each covariance is positive
/// semi-definite.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::model::walking::WALKING;
///
/// let model = WALKING.model()?;
/// assert_eq!((model.angle_count(), model.position_count()), (13, 100));
/// // A person at half the reference speed has half the velocities at the same poses.
/// let point = model.point(0.3);
/// let ratio = model.speed_ratio(0.5 * model.reference_velocity());
/// let (pose_rad, velocity) = (model.mean_pose_rad::<13>(point), model.mean_velocity::<13>(point).map(|v| ratio * v));
/// assert_eq!(ratio, 0.5);
/// assert!(pose_rad.iter().chain(&velocity).all(|value| value.is_finite()));
/// # }
/// # Ok::<(), sinew_core::cyclic::ModelError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionModel<'a> {
    coupled: CoupledModel<'a>,
    mean_acceleration: &'a [f32],
    acceleration_covariance: &'a [f32],
    mean_velocity: &'a [f32],
}

impl<'a> MotionModel<'a> {
    /// Checks the numbers.
    ///
    /// # Errors
    /// Those of [`CoupledModel::new`]. Accelerations, covariances and velocities have as many rows
    /// as poses, and finite numbers. No covariance has a negative eigenvalue.
    pub fn new(parts: ModelParts<'a>) -> Result<Self, ModelError> {
        let coupled = CoupledModel::new(parts.coupled())?;
        Self::of_coupled(coupled, parts.mean_acceleration, parts.acceleration_covariance, parts.mean_velocity)
    }

    /// As [`Self::new`], of a checked part and the numbers that it does not have.
    pub(crate) fn of_coupled(
        coupled: CoupledModel<'a>,
        mean_acceleration: &'a [f32],
        acceleration_covariance: &'a [f32],
        mean_velocity: &'a [f32],
    ) -> Result<Self, ModelError> {
        let (l, n) = (coupled.position_count(), coupled.angle_count());
        check_rows("mean_acceleration", mean_acceleration, l, n, finite)?;
        check_rows("mean_velocity", mean_velocity, l, n, finite)?;
        check_covariances(acceleration_covariance, l, n)?;
        Ok(Self { coupled, mean_acceleration, acceleration_covariance, mean_velocity })
    }

    /// The part that the phase-coupled filter reads.
    #[inline]
    #[must_use]
    pub const fn coupled(&self) -> &CoupledModel<'a> {
        &self.coupled
    }

    /// The numbers themselves.
    #[inline]
    #[must_use]
    pub const fn parts(&self) -> ModelParts<'a> {
        let CoupledParts { angle_count, mean_pose_rad, turns_per_cycle, mean_duration_frames, rate_hz, deviation } =
            *self.coupled.parts();
        ModelParts {
            angle_count,
            mean_acceleration: self.mean_acceleration,
            acceleration_covariance: self.acceleration_covariance,
            mean_pose_rad,
            mean_velocity: self.mean_velocity,
            turns_per_cycle,
            mean_duration_frames,
            rate_hz,
            deviation,
        }
    }
}

/// The part that the phase-coupled filter reads.
impl<'a> Deref for MotionModel<'a> {
    type Target = CoupledModel<'a>;

    #[inline]
    fn deref(&self) -> &CoupledModel<'a> {
        &self.coupled
    }
}

impl<'a> AsRef<CoupledModel<'a>> for MotionModel<'a> {
    fn as_ref(&self) -> &CoupledModel<'a> {
        &self.coupled
    }
}

fn check_covariances(covariances: &[f32], positions: usize, angles: usize) -> Result<(), ModelError> {
    const NAME: &str = "acceleration_covariance";
    let packed = packed_len(angles);
    if covariances.len() != positions * packed {
        let rule = Rule::SameLength { expected: positions * packed };
        return Err(ModelError::of_all(ParameterError::new(NAME, rule)));
    }
    for (position, covariance) in covariances.chunks_exact(packed.max(1)).enumerate() {
        let rule =
            if covariance.iter().all(|value| value.is_finite()) { Rule::PositiveSemiDefinite } else { Rule::Finite };
        if rule == Rule::Finite || !is_positive_semi_definite(covariance, angles) {
            return Err(ModelError { error: ParameterError::new(NAME, rule), position: Some(position), angle: None });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const L: usize = 4;
    static ACCELERATION: [f32; 2 * L] = [0.0, 0.1, 0.2, 0.3, 0.0, -0.1, -0.2, -0.3];
    static COVARIANCE: [f32; 3 * L] = [1.0, 0.5, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 1.0, 2.0, 0.0, 2.0];

    const DEVIATION: Deviation<'static> = Deviation {
        offset_std_rad: &[0.1; 2],
        cosine_std_rad: &[0.1; 2],
        sine_std_rad: &[0.1; 2],
        rest_std_rad: &[0.05; 2],
        rest_rate_per_cycle: &[9.0, 8.0],
    };

    fn parts() -> ModelParts<'static> {
        ModelParts {
            angle_count: 2,
            mean_acceleration: &ACCELERATION,
            acceleration_covariance: &COVARIANCE,
            mean_pose_rad: &ACCELERATION,
            mean_velocity: &ACCELERATION,
            turns_per_cycle: &[0, 1],
            mean_duration_frames: 5.0,
            rate_hz: 60.0,
            deviation: DEVIATION,
        }
    }

    #[test]
    fn a_sound_model_is_accepted() {
        let model = MotionModel::new(parts()).unwrap();
        assert_eq!((model.angle_count(), model.position_count()), (2, L));
        assert!((model.speed_ratio(0.5) - 2.0).abs() < 1.0e-6);
        assert!((model.mean_cycle_velocity() - 0.2).abs() < 1.0e-6);
        assert!(MotionModel::new(ModelParts { deviation: Deviation::default(), ..parts() }).is_ok());
    }

    #[test]
    fn an_indefinite_covariance_is_named_with_its_position() {
        let mut covariance = COVARIANCE;
        covariance[3 * 2 + 1] = 0.9;
        let error = MotionModel::new(ModelParts { acceleration_covariance: &covariance, ..parts() }).unwrap_err();
        assert_eq!(error.position, Some(2));
        assert_eq!(error.error.rule, Rule::PositiveSemiDefinite);
        assert_eq!(
            std::format!("{error}"),
            "`acceleration_covariance` at cycle position 2 must be positive semi-definite"
        );
    }

    #[test]
    fn nan_and_infinity_are_reported_with_their_place() {
        let mut pose = ACCELERATION;
        pose[5] = f32::NAN;
        let error = MotionModel::new(ModelParts { mean_pose_rad: &pose, ..parts() }).unwrap_err();
        assert_eq!((error.error.parameter, error.position, error.angle), ("mean_pose_rad", Some(2), Some(1)));
        let mut covariance = COVARIANCE;
        covariance[0] = f32::INFINITY;
        let error = MotionModel::new(ModelParts { acceleration_covariance: &covariance, ..parts() }).unwrap_err();
        assert_eq!(error.error.rule, Rule::Finite);
        let negative = Deviation { sine_std_rad: &[0.1, -0.1], ..DEVIATION };
        let error = MotionModel::new(ModelParts { deviation: negative, ..parts() }).unwrap_err();
        assert_eq!((error.error.rule, error.angle), (Rule::Positive, Some(1)));
    }

    #[test]
    fn lengths_that_do_not_agree_are_refused() {
        let wrong = [
            ModelParts { angle_count: 0, ..parts() },
            ModelParts { angle_count: 33, ..parts() },
            ModelParts { mean_acceleration: &ACCELERATION[..6], ..parts() },
            ModelParts { mean_velocity: &ACCELERATION[..6], ..parts() },
            ModelParts { acceleration_covariance: &COVARIANCE[..11], ..parts() },
            ModelParts { turns_per_cycle: &[0], ..parts() },
            ModelParts { mean_duration_frames: 0.0, ..parts() },
            ModelParts { rate_hz: f32::NAN, ..parts() },
        ];
        for parts in wrong {
            assert!(MotionModel::new(parts).is_err(), "{parts:?}");
        }
    }
}
