//! Angles on the circle: weighted means that do not break where the circle closes.
//!
//! ```
//! use sinew_core::angle::{CircularSum, angle_difference};
//!
//! // The mean of 350 and 20 degrees is 5, not 185.
//! let mut sum = CircularSum::default();
//! sum.add(350.0_f32.to_radians(), 1.0);
//! sum.add(20.0_f32.to_radians(), 1.0);
//! let mean_rad = sum.mean_rad().expect("they do not cancel");
//! assert!((mean_rad.to_degrees() - 5.0).abs() < 0.01);
//!
//! // From 3.1 to -3.1 the short way leads over pi.
//! let way_rad = angle_difference(-3.1, 3.1);
//! assert!(way_rad > 0.0 && way_rad < 0.1);
//! ```

use crate::math::{atan2, ln, round, sin_cos, sqrt, wrap_angle};
use core::f32::consts::{PI, TAU};

/// `angle_rad` in (-pi, pi] and the whole turns taken off it: unwrapped = wrapped + 2 pi turns.
///
/// ```
/// use core::f32::consts::TAU;
/// use sinew_core::angle::split_turns;
///
/// // An angle that wound twice and a bit: filters keep the bit precise, however often it winds.
/// let (rest_rad, turns) = split_turns(2.0 * TAU + 0.25);
/// assert_eq!(turns, 2);
/// assert!((rest_rad - 0.25).abs() < 1e-5);
/// ```
#[inline]
#[must_use]
pub fn split_turns(angle_rad: f32) -> (f32, i32) {
    if angle_rad > -PI && angle_rad <= PI {
        return (angle_rad, 0);
    }
    let wrapped = wrap_angle(angle_rad);
    (wrapped, round((angle_rad - wrapped) / TAU) as i32)
}

/// The shorter way from `from_rad` to `to_rad`, in (-pi, pi].
///
/// ```
/// use sinew_core::angle::angle_difference;
///
/// // From a heading of 350 degrees to one of 20 it is 30 degrees to the left, not 330 to the
/// // right.
/// let way_rad = angle_difference(20.0_f32.to_radians(), 350.0_f32.to_radians());
/// assert!((way_rad.to_degrees() - 30.0).abs() < 1e-3);
/// ```
#[inline]
#[must_use]
pub fn angle_difference(to_rad: f32, from_rad: f32) -> f32 {
    wrap_angle(to_rad - from_rad)
}

/// Sums of cosines and sines of weighted angles.
///
/// ```
/// use sinew_core::angle::CircularSum;
///
/// // Three headings about north, the middle one twice as sure.
/// let mut headings = CircularSum::default();
/// for (heading, weight) in [(350.0_f32, 1.0), (0.0, 2.0), (10.0, 1.0)] {
///     headings.add(heading.to_radians(), weight);
/// }
/// assert!(headings.mean_rad().is_some_and(|mean_rad| mean_rad.abs() < 1e-4));
/// // Their spread is sqrt((10^2 + 10^2) / 4) degrees.
/// assert!(
///     headings.std_rad().is_some_and(|std_rad| (std_rad.to_degrees() - 7.1).abs() < 0.05)
/// );
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CircularSum {
    cosine: f32,
    sine: f32,
    weight: f32,
}

impl CircularSum {
    /// Adds `angle_rad` with a `weight`, which should not be negative.
    #[inline]
    pub fn add(&mut self, angle_rad: f32, weight: f32) {
        let (s, c) = sin_cos(angle_rad);
        self.cosine += weight * c;
        self.sine += weight * s;
        self.weight += weight;
    }

    /// Mean direction in (-pi, pi]; `None` where the angles cancel or nothing was added.
    #[must_use]
    pub fn mean_rad(&self) -> Option<f32> {
        (self.resultant_length()? > 1.0e-6).then(|| atan2(self.sine, self.cosine))
    }

    /// Mean resultant length in [0, 1]: 1 where all angles agree; `None` without weight.
    #[must_use]
    pub fn resultant_length(&self) -> Option<f32> {
        if self.weight > 0.0 {
            Some(sqrt(self.cosine * self.cosine + self.sine * self.sine) / self.weight)
        } else {
            None
        }
    }

    /// Circular standard deviation sqrt(-2 ln R), radians; `None` without weight.
    #[must_use]
    pub fn std_rad(&self) -> Option<f32> {
        let length = self.resultant_length()?;
        Some(if length >= 1.0 { 0.0 } else { sqrt(-2.0 * ln(length)) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_of_angles_around_the_seam_lies_at_the_seam() {
        let mut sum = CircularSum::default();
        sum.add(PI - 0.1, 1.0);
        sum.add(-PI + 0.1, 1.0);
        assert!((sum.mean_rad().unwrap().abs() - PI).abs() < 1.0e-5);
        assert!((sum.std_rad().unwrap() - 0.1).abs() < 1.0e-3);
    }

    #[test]
    fn turns_and_the_rest_make_up_the_angle() {
        for i in -400..=400_i32 {
            let angle = i as f32 * 0.1;
            let (rest, turns) = split_turns(angle);
            assert!(rest > -PI && rest <= PI);
            assert!((rest + turns as f32 * TAU - angle).abs() < 1.0e-4, "{angle}: {rest} and {turns}");
        }
        assert_eq!(split_turns(PI), (PI, 0));
        assert_eq!(split_turns(-PI), (PI, -1));
        assert!((angle_difference(-3.1, 3.1) - (TAU - 6.2)).abs() < 1.0e-5);
    }

    #[test]
    fn weights_pull_the_mean() {
        let mut sum = CircularSum::default();
        sum.add(0.0, 3.0);
        sum.add(0.4, 1.0);
        assert!((sum.mean_rad().unwrap() - 0.1).abs() < 2.0e-3);
    }

    #[test]
    fn opposite_angles_have_no_mean() {
        let mut sum = CircularSum::default();
        assert_eq!(sum.mean_rad(), None);
        assert_eq!(sum.std_rad(), None);
        sum.add(0.0, 1.0);
        sum.add(PI, 1.0);
        assert_eq!(sum.mean_rad(), None);
    }
}
