//! Measurement of a frame: any subset of the angles, each with its standard deviation.
//!
//! ```
//! use sinew_core::cyclic::AngleMeasurement;
//!
//! // Three angles of which one was not seen, each known to five degrees, two frames after the last.
//! let seen = AngleMeasurement::new(&[Some(0.1), None, Some(-3.0)], 5.0_f32.to_radians())?.after(2.0)?;
//! assert_eq!((seen.present(3), seen.angle_rad(1)), (2, None));
//! assert!(AngleMeasurement::new(&[Some(0.1)], 0.0).is_err(), "nothing is known exactly");
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

use crate::error::{ParameterError, positive};
use crate::numeric::rolled::rolled;
use crate::ranges::{angle_std, is_angle};

/// Longest step, frames at the model's rate. Chosen: ten seconds at 60 Hz, after which the pose is
/// unknown; it bounds the work.
pub const MAX_STEP_FRAMES: f32 = 600.0;

/// One frame's measured angles; `N` is a capacity, angles beyond the model's are ignored.
///
/// Invariant: angles and standard deviations are within their ranges ([`crate::ranges`]), the step
/// in (0, 600] frames.
///
/// ```
/// use sinew_core::cyclic::AngleMeasurement;
///
/// // A short segment's angle has more noise than a long one's. NaN counts as missing.
/// let angles_rad = [Some(0.3), Some(-0.1), Some(f32::NAN)];
/// let seen = AngleMeasurement::with_std(&angles_rad, &[0.05, 0.2, 0.05])?.after(3.0)?;
/// assert_eq!((seen.angle_rad(2), seen.present(3)), (None, 2));
/// assert_eq!(seen.step_frames(), 3.0, "two frames were left out");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AngleMeasurement<const N: usize> {
    angles_rad: [Option<f32>; N],
    std_rad: [f32; N],
    step_frames: f32,
}

impl<const N: usize> AngleMeasurement<N> {
    /// No angle seen, one frame after the last.
    #[must_use]
    pub const fn nothing() -> Self {
        Self { angles_rad: [None; N], std_rad: [1.0; N], step_frames: 1.0 }
    }

    /// `angles_rad` (any turn; beyond [`MAX_ANGLE_RAD`](crate::ranges::MAX_ANGLE_RAD) and NaN count
    /// as missing) with the same standard deviation for all.
    ///
    /// # Errors
    /// `std_rad` has to lie within [`ANGLE_STD_RAD`](crate::ranges::ANGLE_STD_RAD).
    pub fn new(angles_rad: &[Option<f32>; N], std_rad: f32) -> Result<Self, ParameterError> {
        angle_std("std_rad", std_rad)?;
        Ok(Self::checked(angles_rad, &[std_rad; N]))
    }

    /// As [`Self::new`], with a standard deviation for each angle.
    ///
    /// # Errors
    /// Each `std_rad` has to lie within [`ANGLE_STD_RAD`](crate::ranges::ANGLE_STD_RAD).
    pub fn with_std(angles_rad: &[Option<f32>; N], std_rad: &[f32; N]) -> Result<Self, ParameterError> {
        for &std in std_rad.iter().take(rolled(N)) {
            angle_std("std_rad", std)?;
        }
        Ok(Self::checked(angles_rad, std_rad))
    }

    #[inline]
    fn checked(angles_rad: &[Option<f32>; N], std_rad: &[f32; N]) -> Self {
        let mut checked = *angles_rad;
        for angle in checked.iter_mut().take(rolled(N)) {
            *angle = angle.filter(|angle| is_angle(*angle));
        }
        Self { angles_rad: checked, std_rad: *std_rad, step_frames: 1.0 }
    }

    /// The same, `step_frames` after the last measurement (frames at the model's rate).
    ///
    /// # Errors
    /// The step has to be positive and at most [`MAX_STEP_FRAMES`].
    pub fn after(mut self, step_frames: f32) -> Result<Self, ParameterError> {
        positive("step_frames", step_frames)?;
        self.step_frames = crate::error::within("step_frames", step_frames, 0.0, MAX_STEP_FRAMES)?;
        Ok(self)
    }

    /// The angle at `index`, if it was seen.
    #[inline]
    #[must_use]
    pub fn angle_rad(&self, index: usize) -> Option<f32> {
        self.angles_rad.get(index).copied().flatten()
    }

    /// All angles.
    #[inline]
    #[must_use]
    pub const fn angles_rad(&self) -> &[Option<f32>; N] {
        &self.angles_rad
    }

    /// Standard deviation of each angle.
    #[inline]
    #[must_use]
    pub const fn std_rad(&self) -> &[f32; N] {
        &self.std_rad
    }

    /// Time since the last measurement (dt), frames at the model's rate.
    #[inline]
    #[must_use]
    pub const fn step_frames(&self) -> f32 {
        self.step_frames
    }

    /// Number of angles seen among the first `angle_count`.
    #[must_use]
    pub fn present(&self, angle_count: usize) -> usize {
        self.angles_rad.iter().take(angle_count).flatten().count()
    }

    /// Whether the first `angle_count` angles are all missing.
    #[must_use]
    pub fn is_empty(&self, angle_count: usize) -> bool {
        self.present(angle_count) == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Rule;

    #[test]
    fn nan_and_infinity_count_as_missing() {
        let measurement = AngleMeasurement::new(&[Some(f32::NAN), Some(f32::INFINITY), Some(9.0), None], 0.1).unwrap();
        assert_eq!(measurement.angles_rad(), &[None, None, Some(9.0), None]);
        assert_eq!(measurement.present(4), 1);
        assert!(measurement.is_empty(2));
    }

    #[test]
    fn noise_and_step_have_to_be_positive() {
        for std in [0.0, -1.0] {
            assert_eq!(AngleMeasurement::new(&[None], std).unwrap_err().rule, Rule::Positive);
        }
        assert_eq!(AngleMeasurement::new(&[None], f32::NAN).unwrap_err().rule, Rule::Finite);
        for step in [0.0, -1.0, f32::NAN, 601.0] {
            assert!(AngleMeasurement::<1>::nothing().after(step).is_err(), "{step}");
        }
        assert_eq!(AngleMeasurement::<1>::nothing().after(2.5).unwrap().step_frames(), 2.5);
    }
}
