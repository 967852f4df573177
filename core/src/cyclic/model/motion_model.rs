//! The motion model: moments of the training cycles at every position of the cycle (cyclic paper,
//! section 2.3).
//!
//! Immutable and borrowed: the numbers lie in flash (a `static` [`crate::cyclic::ModelTable`]) or
//! in a host's vectors, the filters only read them. All derivatives are per frame of the reference
//! cycle, in which the cycle takes l frames. A person who goes through the cycle k = v l times as
//! fast has k times the velocity and k^2 times the acceleration.

use crate::cyclic::model::deviation::Deviation;
use crate::error::{ParameterError, Rule, finite, positive};
use crate::numeric::semi_definite::{MAX_ROWS, is_positive_semi_definite, packed_len};
use core::fmt;

/// Most angles of a model.
pub const MAX_ANGLES: usize = MAX_ROWS;

/// A part of a motion model that cannot be used, why, and where.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::model::walking::WALKING;
///
/// // The error names the place of the invalid number.
/// let mut table = WALKING.clone();
/// table.mean_pose_rad[17][3] = f32::NAN;
/// let refused = table.model().unwrap_err();
/// assert_eq!(refused.error.parameter, "mean_pose_rad");
/// assert_eq!((refused.position, refused.angle), (Some(17), Some(3)));
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ModelError {
    /// The part and the rule that it broke.
    pub error: ParameterError,
    /// Index of the cycle position, where the fault belongs to one.
    pub position: Option<usize>,
    /// Index of the angle, where the fault belongs to one.
    pub angle: Option<usize>,
}

impl ModelError {
    const fn of_all(error: ParameterError) -> Self {
        Self { error, position: None, angle: None }
    }
}

impl fmt::Display for ModelError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "`{}`", self.error.parameter)?;
        if let Some(position) = self.position {
            write!(formatter, " at cycle position {position}")?;
        }
        if let Some(angle) = self.angle {
            write!(formatter, ", angle {angle}")?;
        }
        write!(formatter, " {}", self.error.rule)
    }
}

impl core::error::Error for ModelError {}

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
    /// All tables of real numbers, those of the cycle first; the order is that of
    /// [`crate::cyclic::model::bytes`].
    #[must_use]
    pub const fn tables(&self) -> [&'a [f32]; 8] {
        let Deviation { offset_std_rad, swing_std_rad, rest_std_rad, rest_rate_per_cycle } = self.deviation;
        [
            self.mean_acceleration,
            self.acceleration_covariance,
            self.mean_pose_rad,
            self.mean_velocity,
            offset_std_rad,
            swing_std_rad,
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
    parts: ModelParts<'a>,
    position_count: usize,
}

impl<'a> MotionModel<'a> {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A model has 1 to [`MAX_ANGLES`] angles and at least 4 positions. Its lengths agree and its
    /// numbers are finite. Duration, rate, and spreads and rates of the deviation are positive. No
    /// covariance has a negative eigenvalue.
    pub fn new(parts: ModelParts<'a>) -> Result<Self, ModelError> {
        let n = parts.angle_count;
        let fail = |parameter, rule| Err(ModelError::of_all(ParameterError::new(parameter, rule)));
        if n == 0 {
            return fail("angle_count", Rule::NotEmpty);
        }
        if n > MAX_ANGLES {
            return fail("angle_count", Rule::Capacity { capacity: MAX_ANGLES });
        }
        let l = parts.mean_acceleration.len() / n;
        if l < 4 {
            return fail("positions", Rule::Within { low: 4.0, high: 1.0e6 });
        }
        positive("mean_duration_frames", parts.mean_duration_frames).map_err(ModelError::of_all)?;
        positive("rate_hz", parts.rate_hz).map_err(ModelError::of_all)?;
        if parts.turns_per_cycle.len() != n {
            return fail("turns_per_cycle", Rule::SameLength { expected: n });
        }
        check_rows("mean_acceleration", parts.mean_acceleration, l, n, finite)?;
        check_rows("mean_pose_rad", parts.mean_pose_rad, l, n, finite)?;
        check_rows("mean_velocity", parts.mean_velocity, l, n, finite)?;
        if !parts.deviation.is_absent() {
            let deviation = &parts.deviation;
            check_rows("deviation.offset_std_rad", deviation.offset_std_rad, 1, n, positive)?;
            check_rows("deviation.swing_std_rad", deviation.swing_std_rad, 1, n, positive)?;
            check_rows("deviation.rest_std_rad", deviation.rest_std_rad, 1, n, positive)?;
            check_rows("deviation.rest_rate_per_cycle", deviation.rest_rate_per_cycle, 1, n, positive)?;
        }
        check_covariances(parts.acceleration_covariance, l, n)?;
        Ok(Self { parts, position_count: l })
    }

    /// Number n of angles.
    #[inline]
    #[must_use]
    pub const fn angle_count(&self) -> usize {
        self.parts.angle_count
    }

    /// Number l of positions of the reference cycle.
    #[inline]
    #[must_use]
    pub const fn position_count(&self) -> usize {
        self.position_count
    }

    /// Reference velocity 1 / l, cycles per frame.
    #[inline]
    #[must_use]
    pub fn reference_velocity(&self) -> f32 {
        1.0 / self.position_count as f32
    }

    /// How much faster than the reference cycle a cycle velocity is: k = v / `v_ref`.
    #[inline]
    #[must_use]
    pub fn speed_ratio(&self, velocity_per_frame: f32) -> f32 {
        velocity_per_frame * self.position_count as f32
    }

    /// Mean velocity of the training cycles, cycles per frame: 1 / mean duration.
    #[inline]
    #[must_use]
    pub fn mean_cycle_velocity(&self) -> f32 {
        1.0 / self.parts.mean_duration_frames
    }

    /// Whether an angle goes round in a cycle.
    #[inline]
    pub(in crate::cyclic) fn winds(&self) -> bool {
        self.parts.turns_per_cycle.iter().any(|&turns| turns != 0)
    }

    /// Frames per second of the training cycles: the frame that velocities of the filters refer to.
    #[inline]
    #[must_use]
    pub const fn rate_hz(&self) -> f32 {
        self.parts.rate_hz
    }

    /// The numbers themselves.
    #[inline]
    #[must_use]
    pub const fn parts(&self) -> &ModelParts<'a> {
        &self.parts
    }
}

/// Checks that `values` are `rows` rows of `columns` numbers of which each passes `check`.
fn check_rows(
    parameter: &'static str,
    values: &[f32],
    rows: usize,
    columns: usize,
    check: fn(&'static str, f32) -> Result<f32, ParameterError>,
) -> Result<(), ModelError> {
    let expected = rows * columns;
    if values.len() != expected {
        return Err(ModelError::of_all(ParameterError::new(parameter, Rule::SameLength { expected })));
    }
    for (index, &value) in values.iter().enumerate() {
        check(parameter, value).map_err(|error| ModelError {
            error,
            position: (rows > 1).then_some(index / columns),
            angle: Some(index % columns),
        })?;
    }
    Ok(())
}

fn check_covariances(covariances: &[f32], positions: usize, angles: usize) -> Result<(), ModelError> {
    const NAME: &str = "acceleration_covariance";
    let packed = packed_len(angles);
    if covariances.len() != positions * packed {
        let rule = Rule::SameLength { expected: positions * packed };
        return Err(ModelError::of_all(ParameterError::new(NAME, rule)));
    }
    for (position, covariance) in covariances.chunks_exact(packed).enumerate() {
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
        swing_std_rad: &[0.1; 2],
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
        let negative = Deviation { swing_std_rad: &[0.1, -0.1], ..DEVIATION };
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
