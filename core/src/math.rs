//! The one place that computes transcendental functions, so that every target gives the same bits.
//!
//! `libm` works in `f32` for all that is used here but sine and cosine. Those two are own code,
//! accurate to [`SIN_COS_MAX_ERROR`] for arguments up to [`SIN_COS_MAX_ARGUMENT_RAD`] in size.
//! Comparisons are explicit ([`min`], [`max`], [`clamp`]), since `f32::min` of -0 and +0 differs
//! between targets.
//!
//! ```
//! use sinew_core::math::{Vec3, axis_rotation, sin_cos, unit, wrap_angle};
//! use std::f32::consts::{FRAC_PI_2, PI};
//!
//! let (sine, cosine) = sin_cos(0.5);
//! assert!((sine * sine + cosine * cosine - 1.0).abs() < 1e-6);
//! assert!((wrap_angle(1.5 * PI) + 0.5 * PI).abs() < 1e-6);
//!
//! let turned = axis_rotation(&Vec3::z(), FRAC_PI_2) * Vec3::x();
//! assert!((turned - Vec3::y()).norm() < 1e-6);
//! assert_eq!(unit(Vec3::zeros()), None, "nothing has no direction");
//! ```

mod elementary;
mod vectors;

pub use self::elementary::{
    EXP_SMALL_MAX_ERROR, ROUND_SMALL_LIMIT, SIN_COS_MAX_ARGUMENT_RAD, SIN_COS_MAX_ERROR, SQRT_BRANCH_FREE_MAX_ERROR,
    abs, acos, asin, atan2, clamp, erfc, exp, exp_small, floor, least_angle, ln, max, min, round, round_small, sin_cos,
    sin_cos_each, sqrt, sqrt_branch_free, wrap_angle, wrap_angle_small, wrap_orientation,
};
pub use self::vectors::{Mat3, Vec3, axis_rotation, length, unit};
pub(crate) use self::vectors::{product, times, transform, turn_columns};
