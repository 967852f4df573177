//! Errors that name the parameter and the rule it broke.
//!
//! ```
//! use sinew_core::error::positive;
//!
//! let refused = positive("forearm_m", -0.3).expect_err("a length is above zero");
//! assert_eq!(refused.parameter, "forearm_m");
//! assert!(refused.to_string().contains("forearm_m"), "{refused}");
//! assert_eq!(positive("forearm_m", 0.3), Ok(0.3));
//! ```

use core::fmt;
use core::ops::RangeInclusive;

/// Range of a parameter that only has to be positive. Chosen: its square and the inverse of that
/// are numbers of `f32` with room to spare.
pub const POSITIVE: RangeInclusive<f32> = 1.0e-15..=1.0e15;

/// The rule that a parameter broke.
///
/// ```
/// use sinew_core::error::Rule;
/// use sinew_core::skeleton::{ArmGeometry, Side};
///
/// // The rule separates a failed sensor from a mistyped length.
/// let rule = |forearm_m| {
///     ArmGeometry::new(Side::Left, 0.3, forearm_m).map_err(|refused| refused.rule)
/// };
/// assert_eq!(rule(f32::NAN), Err(Rule::Finite));
/// assert_eq!(rule(-0.3), Err(Rule::Positive));
/// assert!(rule(0.3).is_ok());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Rule {
    /// The value is NaN or infinite.
    Finite,
    /// The value has to be greater than zero.
    Positive,
    /// The value has to be zero or greater.
    NotNegative,
    /// The value has to lie in the closed interval.
    Within {
        /// Lowest allowed value.
        low: f32,
        /// Highest allowed value.
        high: f32,
    },
    /// The lower end of an interval lies above its upper end.
    OrderedInterval,
    /// A symmetric matrix has to be positive definite.
    PositiveDefinite,
    /// A symmetric matrix must have no negative eigenvalue.
    PositiveSemiDefinite,
    /// A table of indices has to be its own inverse (left and right).
    SelfInverse,
    /// A collection needs at least one element.
    NotEmpty,
    /// A collection holds more elements than the capacity it is meant for.
    Capacity {
        /// The capacity.
        capacity: usize,
    },
    /// Two lengths that have to agree differ.
    SameLength {
        /// The length that was needed.
        expected: usize,
    },
    /// A timestamp lies before that of the previous frame.
    TimeGoesForward,
}

impl fmt::Display for Rule {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Finite => write!(formatter, "must be a finite number"),
            Self::Positive => write!(formatter, "must be greater than zero"),
            Self::NotNegative => write!(formatter, "must not be negative"),
            Self::Within { low, high } => write!(formatter, "must lie from {low} to {high}"),
            Self::OrderedInterval => write!(formatter, "must have its lower end below its upper end"),
            Self::PositiveDefinite => write!(formatter, "must be positive definite"),
            Self::PositiveSemiDefinite => write!(formatter, "must be positive semi-definite"),
            Self::SelfInverse => write!(formatter, "must be its own inverse"),
            Self::NotEmpty => write!(formatter, "must not be empty"),
            Self::Capacity { capacity } => write!(formatter, "must hold at most {capacity} elements"),
            Self::SameLength { expected } => write!(formatter, "must have length {expected}"),
            Self::TimeGoesForward => write!(formatter, "must not lie before the last frame's"),
        }
    }
}

/// A parameter that cannot be used, and why.
///
/// ```
/// use sinew_core::error::{ParameterError, Rule, positive};
///
/// // In a constructor of one's own: the first parameter that breaks its rule is named.
/// fn frame_duration_s(rate_hz: f32) -> Result<f32, ParameterError> {
///     Ok(1.0 / positive("rate_hz", rate_hz)?)
/// }
/// assert_eq!(frame_duration_s(0.0), Err(ParameterError::new("rate_hz", Rule::Positive)));
/// assert_eq!(frame_duration_s(50.0), Ok(0.02));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ParameterError {
    /// Name of the parameter, as it stands in the function or configuration.
    pub parameter: &'static str,
    /// The rule that it broke.
    pub rule: Rule,
}

impl ParameterError {
    /// Names `parameter` and the `rule` it broke.
    #[must_use]
    pub const fn new(parameter: &'static str, rule: Rule) -> Self {
        Self { parameter, rule }
    }
}

impl fmt::Display for ParameterError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "`{}` {}", self.parameter, self.rule)
    }
}

impl core::error::Error for ParameterError {}

/// Returns `value` if it is finite.
///
/// ```
/// use sinew_core::error::{Rule, finite};
///
/// assert_eq!(finite("tilt_rad", -0.2), Ok(-0.2));
/// assert!(finite("tilt_rad", f32::NAN).is_err_and(|error| error.rule == Rule::Finite));
/// ```
///
/// # Errors
/// [`Rule::Finite`] otherwise.
#[cfg_attr(not(target_arch = "x86_64"), inline(never))]
pub fn finite(parameter: &'static str, value: f32) -> Result<f32, ParameterError> {
    if value.is_finite() { Ok(value) } else { Err(ParameterError::new(parameter, Rule::Finite)) }
}

/// Returns `value` if it is finite, greater than zero and within [`POSITIVE`].
///
/// ```
/// use sinew_core::error::{Rule, positive};
///
/// assert_eq!(positive("sigma_rad", 0.1), Ok(0.1));
/// assert!(positive("sigma_rad", 0.0).is_err_and(|error| error.rule == Rule::Positive));
/// assert!(positive("sigma_rad", 1.0e30).is_err(), "its square is no number");
/// ```
///
/// # Errors
/// [`Rule::Finite`], [`Rule::Positive`] or [`Rule::Within`] otherwise.
#[cfg_attr(not(target_arch = "x86_64"), inline(never))]
pub fn positive(parameter: &'static str, value: f32) -> Result<f32, ParameterError> {
    if finite(parameter, value)? <= 0.0 {
        return Err(ParameterError::new(parameter, Rule::Positive));
    }
    within(parameter, value, *POSITIVE.start(), *POSITIVE.end())
}

/// Returns `value` if it is finite, zero or greater, and no greater than [`POSITIVE`] allows.
///
/// ```
/// use sinew_core::error::{Rule, not_negative};
///
/// assert_eq!(
///     not_negative("walk_std_px", 0.0),
///     Ok(0.0),
///     "something that stands still is allowed"
/// );
/// assert!(
///     not_negative("walk_std_px", -1.0).is_err_and(|error| error.rule == Rule::NotNegative)
/// );
/// ```
///
/// # Errors
/// [`Rule::Finite`], [`Rule::NotNegative`] or [`Rule::Within`] otherwise.
#[cfg_attr(not(target_arch = "x86_64"), inline(never))]
pub fn not_negative(parameter: &'static str, value: f32) -> Result<f32, ParameterError> {
    if finite(parameter, value)? < 0.0 {
        return Err(ParameterError::new(parameter, Rule::NotNegative));
    }
    within(parameter, value, 0.0, *POSITIVE.end())
}

/// Returns `value` if it lies in `low..=high`.
///
/// ```
/// use sinew_core::error::{Rule, within};
///
/// assert_eq!(within("probability", 1.0, 0.0, 1.0), Ok(1.0), "the ends belong to it");
/// let refused = within("probability", 1.5, 0.0, 1.0).map_err(|error| error.rule);
/// assert_eq!(refused, Err(Rule::Within { low: 0.0, high: 1.0 }));
/// ```
///
/// # Errors
/// [`Rule::Finite`] or [`Rule::Within`] otherwise.
#[cfg_attr(not(target_arch = "x86_64"), inline(never))]
pub fn within(parameter: &'static str, value: f32, low: f32, high: f32) -> Result<f32, ParameterError> {
    if finite(parameter, value)? >= low && value <= high {
        Ok(value)
    } else {
        Err(ParameterError::new(parameter, Rule::Within { low, high }))
    }
}
