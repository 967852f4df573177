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

/// The rule that a parameter broke.
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
    /// A timestamp lies before that of the frame before.
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
/// # Errors
/// [`Rule::Finite`] otherwise.
pub fn finite(parameter: &'static str, value: f32) -> Result<f32, ParameterError> {
    if value.is_finite() { Ok(value) } else { Err(ParameterError::new(parameter, Rule::Finite)) }
}

/// Returns `value` if it is finite and greater than zero.
///
/// # Errors
/// [`Rule::Finite`] or [`Rule::Positive`] otherwise.
pub fn positive(parameter: &'static str, value: f32) -> Result<f32, ParameterError> {
    if finite(parameter, value)? > 0.0 { Ok(value) } else { Err(ParameterError::new(parameter, Rule::Positive)) }
}

/// Returns `value` if it is finite and zero or greater.
///
/// # Errors
/// [`Rule::Finite`] or [`Rule::NotNegative`] otherwise.
pub fn not_negative(parameter: &'static str, value: f32) -> Result<f32, ParameterError> {
    if finite(parameter, value)? >= 0.0 { Ok(value) } else { Err(ParameterError::new(parameter, Rule::NotNegative)) }
}

/// Returns `value` if it lies in `low..=high`.
///
/// # Errors
/// [`Rule::Finite`] or [`Rule::Within`] otherwise.
pub fn within(parameter: &'static str, value: f32, low: f32, high: f32) -> Result<f32, ParameterError> {
    if finite(parameter, value)? >= low && value <= high {
        Ok(value)
    } else {
        Err(ParameterError::new(parameter, Rule::Within { low, high }))
    }
}
