//! Position and velocity in the cycle with their covariance: cyclic (4), cyclic (5) and cyclic
//! (10).

use crate::cyclic::phase::wrap_position;
use crate::math::{min, sqrt};

/// Largest variance of the cycle position, cycles^2. Chosen: a standard deviation of one cycle, at
/// which the phase is unknown.
const MAX_POSITION_VARIANCE: f32 = 1.0;
/// Largest variance of the cycle velocity, (cycles per frame)^2. Chosen: the square of
/// [`crate::cyclic::start::MAX_CYCLE_VELOCITY`].
const MAX_VELOCITY_VARIANCE: f32 = 0.25;

/// c, v and their covariance.
///
/// ```
/// use sinew_core::cyclic::cycle_state::CycleState;
///
/// let mut cycle = CycleState {
///     position: 0.9,
///     velocity: 0.02,
///     position_variance: 0.0,
///     covariance: 0.0,
///     velocity_variance: 1.0e-6,
/// };
/// // Ten frames without a measurement: a velocity that is 0.001 off makes the position 0.01 off.
/// cycle.advance(10.0, 0.0);
/// assert!((cycle.position - 0.1).abs() < 1e-6);
/// assert!((cycle.position_variance - 0.01 * 0.01).abs() < 1e-8);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CycleState {
    /// Position c, [0, 1).
    pub position: f32,
    /// Velocity v, cycles per frame.
    pub velocity: f32,
    /// Variance of c.
    pub position_variance: f32,
    /// Covariance of c and v.
    pub covariance: f32,
    /// Variance of v.
    pub velocity_variance: f32,
}

impl CycleState {
    /// Propagates over `step` frames at constant velocity, with process noise by
    /// `acceleration_variance`, cycles^2 per frame^4: cyclic (4), cyclic (5) and cyclic (10).
    #[inline]
    pub fn advance(&mut self, step: f32, acceleration_variance: f32) {
        let square = step * step;
        self.position = wrap_position(self.position + step * self.velocity);
        self.position_variance += 2.0 * step * self.covariance
            + square * self.velocity_variance
            + 0.25 * square * square * acceleration_variance;
        self.covariance += step * self.velocity_variance + 0.5 * square * step * acceleration_variance;
        self.velocity_variance += square * acceleration_variance;
        self.saturate();
    }

    /// Scales row and column of a variance above its limit, which keeps the covariance positive
    /// semi-definite.
    fn saturate(&mut self) {
        if self.position_variance > MAX_POSITION_VARIANCE {
            self.covariance *= sqrt(MAX_POSITION_VARIANCE / self.position_variance);
            self.position_variance = MAX_POSITION_VARIANCE;
        }
        if self.velocity_variance > MAX_VELOCITY_VARIANCE {
            self.covariance *= sqrt(MAX_VELOCITY_VARIANCE / self.velocity_variance);
            self.velocity_variance = MAX_VELOCITY_VARIANCE;
        }
        let bound = sqrt(self.position_variance * self.velocity_variance);
        self.covariance = min(self.covariance, bound);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_variance_of_the_position_grows_by_the_kinematics() {
        let mut state = CycleState {
            position: 0.9,
            velocity: 0.05,
            position_variance: 1.0e-5,
            covariance: 0.0,
            velocity_variance: 1.0e-6,
        };
        for _ in 0..10 {
            state.advance(1.0, 0.0);
        }
        assert!((state.position - 0.4).abs() < 1.0e-5);
        assert!((state.position_variance - 1.1e-4).abs() < 1.0e-8);
        assert!((state.covariance - 1.0e-5).abs() < 1.0e-9);
    }

    #[test]
    fn the_covariance_stays_valid_over_many_frames() {
        let mut state = CycleState {
            position: 0.0,
            velocity: 0.01,
            position_variance: 1.0e-5,
            covariance: 0.0,
            velocity_variance: 1.0e-6,
        };
        for _ in 0..200_000 {
            state.advance(1.0, 1.0e-8);
            let bound = state.position_variance * state.velocity_variance * 1.000_01;
            assert!(state.covariance * state.covariance <= bound && state.position_variance <= 1.0);
        }
    }
}
