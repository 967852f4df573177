//! Ranges of the physical quantities that trackers take in: one list for all borders.
//!
//! A parameter outside of its range is refused with an error. A measurement outside of it counts as
//! missing, so that one bad frame cannot spoil a state.
//!
//! ```
//! use sinew_core::math::Vec3;
//! use sinew_core::ranges::{is_pixel, is_place};
//!
//! assert!(is_place(&Vec3::new(0.2, -0.1, 1.2)));
//! assert!(!is_place(&Vec3::new(0.0, 0.0, 1.0e35)) && !is_place(&Vec3::new(f32::NAN, 0.0, 1.2)));
//! assert!(is_pixel(1919.0) && !is_pixel(f32::INFINITY));
//! ```

use crate::error::{ParameterError, Rule, finite, positive, within};
use crate::math::{Vec3, abs};
use core::ops::RangeInclusive;

/// Greatest coordinate of a place, metres.
/// Chosen: a hall is smaller, and no sensor in use resolves a person from farther away.
pub const MAX_M: f32 = 100.0;
/// Greatest coordinate in an image and greatest length there, pixels.
/// Chosen: no camera has more, and `f32` still resolves 1/128 pixel there.
pub const MAX_PX: f32 = 65_536.0;
/// Greatest focal length, pixels. Chosen: sixteen of the widest images.
pub const MAX_FOCAL_PX: f32 = 16.0 * MAX_PX;
/// Greatest angle, of any number of turns, radians.
/// Chosen: `f32` resolves 1/16 rad there, so that greater angles say nothing.
pub const MAX_ANGLE_RAD: f32 = 1.0e6;
/// Standard deviations of an angle, radians.
/// Chosen: the least is below the noise of every sensor of angles, and the greatest is hundreds of
/// turns.
pub const ANGLE_STD_RAD: RangeInclusive<f32> = 1.0e-4..=1.0e3;

/// Whether a place lies within [`MAX_M`] along each axis; never with NaN or infinity.
///
/// ```
/// assert!(!sinew_core::ranges::is_place(&sinew_core::math::Vec3::new(0.0, f32::NAN, 1.2)));
/// ```
#[must_use]
pub fn is_place(place_m: &Vec3) -> bool {
    abs(place_m.x) <= MAX_M && abs(place_m.y) <= MAX_M && abs(place_m.z) <= MAX_M
}

/// Whether a coordinate lies within [`MAX_PX`]; NaN and infinity do not.
///
/// ```
/// assert!(sinew_core::ranges::is_pixel(-3.5) && !sinew_core::ranges::is_pixel(1.0e6));
/// ```
#[must_use]
pub fn is_pixel(coordinate_px: f32) -> bool {
    abs(coordinate_px) <= MAX_PX
}

/// Whether an angle lies within [`MAX_ANGLE_RAD`]; NaN and infinity do not.
///
/// ```
/// assert!(sinew_core::ranges::is_angle(-7.0) && !sinew_core::ranges::is_angle(f32::NAN));
/// ```
#[must_use]
pub fn is_angle(angle_rad: f32) -> bool {
    abs(angle_rad) <= MAX_ANGLE_RAD
}

/// Returns `place_m` if it [is a place](is_place).
///
/// ```
/// let far_m = sinew_core::math::Vec3::new(0.0, 0.0, 1.0e35);
/// assert!(sinew_core::ranges::place("shoulder_m", &far_m).is_err());
/// ```
///
/// # Errors
/// [`Rule::Finite`] or [`Rule::Within`] otherwise.
pub fn place(parameter: &'static str, place_m: &Vec3) -> Result<Vec3, ParameterError> {
    let coordinate = |coordinate_m| within(parameter, coordinate_m, -MAX_M, MAX_M);
    Ok(Vec3::new(coordinate(place_m.x)?, coordinate(place_m.y)?, coordinate(place_m.z)?))
}

/// Returns `length` if it is [`positive`] and at most `most`.
///
/// ```
/// assert_eq!(sinew_core::ranges::length("forearm_m", 0.25, 100.0), Ok(0.25));
/// ```
///
/// # Errors
/// Those of [`positive`], or [`Rule::Within`].
pub fn length(parameter: &'static str, length: f32, most: f32) -> Result<f32, ParameterError> {
    within(parameter, positive(parameter, length)?, 0.0, most)
}

/// Returns `std_rad` if it lies within [`ANGLE_STD_RAD`].
///
/// ```
/// assert!(sinew_core::ranges::angle_std("std_rad", 1.0e30).is_err());
/// ```
///
/// # Errors
/// [`Rule::Finite`], [`Rule::Positive`] or [`Rule::Within`] otherwise.
pub fn angle_std(parameter: &'static str, std_rad: f32) -> Result<f32, ParameterError> {
    if finite(parameter, std_rad)? <= 0.0 {
        return Err(ParameterError::new(parameter, Rule::Positive));
    }
    within(parameter, std_rad, *ANGLE_STD_RAD.start(), *ANGLE_STD_RAD.end())
}
