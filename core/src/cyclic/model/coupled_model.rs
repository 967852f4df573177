//! The part of a motion model that the phase-coupled filter reads: the mean cycle, and how people
//! deviate from it.
//!
//! A ninth of the whole model's numbers. Firmware with that filter alone has no other part in
//! flash.

use crate::checksum::Crc32;
use crate::cyclic::model::deviation::Deviation;
use crate::error::{ParameterError, Rule, finite, positive};
use crate::numeric::semi_definite::MAX_ROWS;
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
    pub(super) const fn of_all(error: ParameterError) -> Self {
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

/// The numbers of a [`CoupledModel`] with n angles and l positions, not yet checked.
///
/// ```
/// use sinew_core::cyclic::{CoupledModel, CoupledParts, Deviation};
///
/// // One angle that swings by half a radian, at four positions of the cycle, seen at 20 frames a second.
/// let parts = CoupledParts {
///     angle_count: 1,
///     mean_pose_rad: &[0.0, 0.5, 0.0, -0.5],
///     turns_per_cycle: &[0],
///     mean_duration_frames: 20.0,
///     rate_hz: 20.0,
///     deviation: Deviation {
///         offset_std_rad: &[0.08],
///         cosine_std_rad: &[0.05],
///         sine_std_rad: &[0.05],
///         rest_std_rad: &[0.03],
///         rest_rate_per_cycle: &[6.0],
///     },
/// };
/// assert_eq!(CoupledModel::new(parts)?.mean_cycle_velocity(), 0.05);
/// // Poses of two angles at four positions.
/// assert!(CoupledModel::new(CoupledParts { angle_count: 2, ..parts }).is_err());
/// # Ok::<(), sinew_core::cyclic::ModelError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoupledParts<'a> {
    /// Number n of angles.
    pub angle_count: usize,
    /// Mean angles, radians, unwrapped along the cycle: l rows of n.
    pub mean_pose_rad: &'a [f32],
    /// Whole turns that each angle makes in a cycle, n: 0 for an angle that swings, +-1 for one
    /// that winds.
    pub turns_per_cycle: &'a [i8],
    /// Mean duration of the training cycles, frames at [`Self::rate_hz`].
    pub mean_duration_frames: f32,
    /// Frames per second of the training cycles.
    pub rate_hz: f32,
    /// Spread about the mean cycle. The phase-coupled filter refuses a model without it.
    pub deviation: Deviation<'a>,
}

/// A checked motion model for the phase-coupled filter. A [`MotionModel`](super::MotionModel)
/// dereferences to it, so each function that takes this one takes both.
///
/// Invariants: all numbers are finite, the lengths agree.
///
/// ```
/// # #[cfg(feature = "walking-model")] {
/// use sinew_core::cyclic::AngleMeasurement;
/// use sinew_core::cyclic::model::walking::WALKING_COUPLED;
/// use sinew_core::tracker::cyclic::{CoupledTracker, FirstPhase};
///
/// // What firmware links: 5.5 KB in place of 52.
/// let model = WALKING_COUPLED.model()?;
/// let seen = AngleMeasurement::new(&model.mean_pose_rad::<13>(model.point(0.3)).map(Some), 0.1)?;
/// let tracker = CoupledTracker::new(&model, &seen, FirstPhase::default())?;
/// assert!((tracker.filter().cycle().position - 0.3).abs() < 0.01);
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoupledModel<'a> {
    parts: CoupledParts<'a>,
    position_count: usize,
}

impl<'a> CoupledModel<'a> {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A model has 1 to [`MAX_ANGLES`] angles and at least 4 positions. Its lengths agree and its
    /// numbers are finite. Duration, rate, and spreads and rates of the deviation are positive.
    pub fn new(parts: CoupledParts<'a>) -> Result<Self, ModelError> {
        let n = parts.angle_count;
        let fail = |parameter, rule| Err(ModelError::of_all(ParameterError::new(parameter, rule)));
        if n == 0 {
            return fail("angle_count", Rule::NotEmpty);
        }
        if n > MAX_ANGLES {
            return fail("angle_count", Rule::Capacity { capacity: MAX_ANGLES });
        }
        let l = parts.mean_pose_rad.len() / n;
        if l < 4 {
            return fail("positions", Rule::Within { low: 4.0, high: 1.0e6 });
        }
        positive("mean_duration_frames", parts.mean_duration_frames).map_err(ModelError::of_all)?;
        positive("rate_hz", parts.rate_hz).map_err(ModelError::of_all)?;
        if parts.turns_per_cycle.len() != n {
            return fail("turns_per_cycle", Rule::SameLength { expected: n });
        }
        check_rows("mean_pose_rad", parts.mean_pose_rad, l, n, finite)?;
        if !parts.deviation.is_absent() {
            let deviation = &parts.deviation;
            check_rows("deviation.offset_std_rad", deviation.offset_std_rad, 1, n, positive)?;
            check_rows("deviation.cosine_std_rad", deviation.cosine_std_rad, 1, n, positive)?;
            check_rows("deviation.sine_std_rad", deviation.sine_std_rad, 1, n, positive)?;
            check_rows("deviation.rest_std_rad", deviation.rest_std_rad, 1, n, positive)?;
            check_rows("deviation.rest_rate_per_cycle", deviation.rest_rate_per_cycle, 1, n, positive)?;
        }
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
    pub const fn parts(&self) -> &CoupledParts<'a> {
        &self.parts
    }
    /// A checksum of all numbers: two models with the same one give the same estimates with the
    /// phase-coupled filter.
    #[must_use]
    pub fn checksum(&self) -> u32 {
        let parts = &self.parts;
        let deviation = &parts.deviation;
        let numbers = [
            &[parts.mean_duration_frames, parts.rate_hz],
            parts.mean_pose_rad,
            deviation.offset_std_rad,
            deviation.cosine_std_rad,
            deviation.sine_std_rad,
            deviation.rest_std_rad,
            deviation.rest_rate_per_cycle,
        ];
        let numbers = numbers.into_iter().flatten().fold(Crc32::new(), |sum, number| sum.and_word(number.to_bits()));
        parts.turns_per_cycle.iter().fold(numbers, |sum, turns| sum.and(turns.to_le_bytes()[0])).value()
    }
}

impl<'a> AsRef<CoupledModel<'a>> for CoupledModel<'a> {
    fn as_ref(&self) -> &Self {
        self
    }
}

/// Checks that `values` are `rows` rows of `columns` numbers of which each passes `check`.
#[inline(never)]
pub(super) fn check_rows(
    parameter: &'static str,
    values: &[f32],
    rows: usize,
    columns: usize,
    check: fn(&'static str, f32) -> Result<f32, ParameterError>,
) -> Result<(), ModelError> {
    let expected = rows * columns;
    // A model has at least one angle; nothing else would show that there is no division by zero.
    if values.len() != expected || columns == 0 {
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
