//! Kalman filter of one number in the image: a segment's length or a coordinate of the root.

use crate::error::{ParameterError, not_negative, positive};
use crate::saved_state::{FINITE, NOT_NEGATIVE, SavedState, StateVisitor};

/// A Kalman filter of one number that walks at random, with a velocity if its acceleration is not
/// zero.
///
/// Segment lengths in pixels have no velocity (`acceleration_std` 0, a small `walk_std`); the
/// root's coordinates have one.
///
/// ```
/// use sinew_core::cyclic::figure::image_filter::ScalarFilter;
///
/// // A coordinate that moves two pixels a frame, seen in every second frame with an error of a pixel.
/// let mut filter = ScalarFilter::new(100.0, 1.0, 0.0, 0.02)?;
/// for frame in 1..=40_u8 {
///     let seen = (frame % 2 == 0).then_some(100.0 + 2.0 * f32::from(frame));
///     filter.step(1.0, seen, 1.0);
/// }
/// assert!((filter.value() - 180.0).abs() < 0.5 && filter.variance() < 0.5);
/// // A missing measurement is bridged, with more variance.
/// filter.step(5.0, None, 1.0);
/// assert!((filter.value() - 190.0).abs() < 1.0 && filter.variance() > 0.5);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScalarFilter {
    value: f32,
    velocity: f32,
    value_variance: f32,
    covariance: f32,
    velocity_variance: f32,
    walk_variance: f32,
    acceleration_variance: f32,
}

/// Largest variance, pixels^2. Chosen: a million pixels of standard deviation, far beyond any
/// image.
const MAX_VARIANCE: f32 = 1.0e12;

impl SavedState for ScalarFilter {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        for number in [&mut self.value, &mut self.velocity, &mut self.covariance] {
            visitor.real(number, &FINITE);
        }
        for variance in [
            &mut self.value_variance,
            &mut self.velocity_variance,
            &mut self.walk_variance,
            &mut self.acceleration_variance,
        ] {
            visitor.real(variance, &NOT_NEGATIVE);
        }
    }
}

impl ScalarFilter {
    /// At 0 without variance, to be filled by a saved state.
    pub(super) const ZERO: Self = Self {
        value: 0.0,
        velocity: 0.0,
        value_variance: 0.0,
        covariance: 0.0,
        velocity_variance: 0.0,
        walk_variance: 0.0,
        acceleration_variance: 0.0,
    };

    /// Begins at `value` known to `std`, at rest if `acceleration_std` is 0, else at a velocity of
    /// 0 known to `std` a frame.
    ///
    /// # Errors
    /// `std` positive, `walk_std` and `acceleration_std` (per frame, per frame^2) not negative,
    /// `value` finite.
    pub fn new(value: f32, std: f32, walk_std: f32, acceleration_std: f32) -> Result<Self, ParameterError> {
        crate::error::finite("first value", value)?;
        positive("std", std)?;
        not_negative("walk_std", walk_std)?;
        not_negative("acceleration_std", acceleration_std)?;
        let variance = std * std;
        Ok(Self {
            value,
            velocity: 0.0,
            value_variance: variance,
            covariance: 0.0,
            velocity_variance: if acceleration_std > 0.0 { variance } else { 0.0 },
            walk_variance: walk_std * walk_std,
            acceleration_variance: acceleration_std * acceleration_std,
        })
    }

    /// One step of `step_frames`: predict, then correct by the value `seen` with standard deviation
    /// `std`, if any.
    ///
    /// A value or a deviation that is not a finite number counts as missing.
    pub fn step(&mut self, step_frames: f32, seen: Option<f32>, std: f32) {
        let square = step_frames * step_frames;
        self.value += step_frames * self.velocity;
        self.value_variance += 2.0 * step_frames * self.covariance
            + square * self.velocity_variance
            + step_frames * (self.walk_variance + square * self.acceleration_variance / 3.0);
        self.covariance += step_frames * self.velocity_variance + 0.5 * square * self.acceleration_variance;
        self.velocity_variance += step_frames * self.acceleration_variance;
        if self.value_variance > MAX_VARIANCE {
            self.value_variance = MAX_VARIANCE;
            self.covariance = 0.0;
        }
        let Some(seen) = seen.filter(|value| value.is_finite() && std > 0.0 && std.is_finite()) else { return };
        let noise = std * std;
        let inverse = 1.0 / (self.value_variance + noise);
        let innovation = seen - self.value;
        let velocity_gain = self.covariance * inverse;
        self.value += self.value_variance * inverse * innovation;
        self.velocity += velocity_gain * innovation;
        self.velocity_variance = crate::math::max(self.velocity_variance - velocity_gain * self.covariance, 0.0);
        self.covariance *= noise * inverse;
        self.value_variance *= noise * inverse;
    }

    /// The value.
    #[must_use]
    pub const fn value(&self) -> f32 {
        self.value
    }

    /// Its variance.
    #[must_use]
    pub const fn variance(&self) -> f32 {
        self.value_variance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;

    #[test]
    fn the_variance_of_a_length_falls_and_a_walking_root_is_followed_through_a_gap() {
        let mut stream = Stream::new(9, 0, 0);
        let mut length = ScalarFilter::new(45.0, 5.0, 0.01, 0.0).unwrap();
        let mut root = ScalarFilter::new(100.0, 3.0, 0.0, 0.05).unwrap();
        for frame in 1..=200_u8 {
            length.step(1.0, Some(50.0 + 3.0 * stream.normal()), 3.0);
            let place = 100.0 + 2.0 * f32::from(frame);
            let seen = (!(150..160).contains(&frame)).then(|| place + 2.0 * stream.normal());
            root.step(1.0, seen, 2.0);
            if frame > 50 {
                assert!((root.value() - place).abs() < 5.0 * root.variance().sqrt(), "frame {frame}");
                assert!((root.value() - place).abs() < 4.0, "frame {frame}: {}", root.value() - place);
            }
        }
        assert!((length.value() - 50.0).abs() < 1.5 && length.variance() < 0.2);
        assert!(ScalarFilter::new(0.0, 0.0, 0.0, 0.0).is_err());
    }
}
