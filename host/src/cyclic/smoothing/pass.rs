//! The pass backwards over the states of a filter.

use super::recursion::{Moments, smooth_step};
use crate::cyclic::turns::least_angle;
use nalgebra::{DMatrix, DVector};
use sinew_core::cyclic::{AngleMeasurement, MotionModel};

/// How two neighbouring states hang together.
#[derive(Debug, Clone, PartialEq)]
pub struct Link {
    /// Mean of the later state before its measurement.
    pub predicted_mean: DVector<f64>,
    /// Covariance of the earlier state with the later one before its measurement.
    pub cross: DMatrix<f64>,
    /// Covariance of the later state before its measurement.
    pub predicted_covariance: DMatrix<f64>,
}

/// The smoothed estimate of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Smoothed<const N: usize> {
    /// Angles, any turn.
    pub angles_rad: [f64; N],
    /// Their variances, rad^2.
    pub angle_variance_rad2: [f64; N],
    /// Position in the cycle, [0, 1).
    pub cycle_position: f64,
    /// Its variance, cycles^2.
    pub cycle_position_variance: f64,
    /// Cycles per frame of the model's rate.
    pub cycle_velocity: f64,
    /// Its variance.
    pub cycle_velocity_variance: f64,
}

/// State of a filter after a frame, from which a smoother can go back.
pub trait Smoothable<const N: usize>: Copy {
    /// What the numbers of the state wrap around at: a turn, a cycle, or nothing.
    fn period(&self, model: &MotionModel<'_>, index: usize) -> Option<f64>;

    /// This state, led by what leads in `next`, the state a frame later; `None` where that began
    /// after this frame.
    fn led_as_in(&self, _next: &Self) -> Option<Self> {
        Some(*self)
    }

    /// Mean and covariance given the measurements up to this frame.
    fn moments(&self, model: &MotionModel<'_>) -> Moments;

    /// The step to the state `next`, which came out of `measurement` and whose leader leads here,
    /// too; `None` where that one does not follow from this.
    fn link(&self, model: &MotionModel<'_>, measurement: &AngleMeasurement<N>, next: &Self) -> Option<Link>;

    /// The estimate of the frame from moments of this kind of state, `None` where the forward one
    /// stays. Numbers that no later measurement changes are those of this state.
    fn smoothed(&self, model: &MotionModel<'_>, moments: &Moments) -> Option<Smoothed<N>>;
}

/// Smooths: `measurements` at k led from the state k to the state k + 1.
#[must_use]
pub fn backward<const N: usize, S: Smoothable<N>>(
    model: &MotionModel<'_>,
    states: &[S],
    measurements: &[AngleMeasurement<N>],
) -> Vec<Option<Smoothed<N>>> {
    let mut all = Vec::with_capacity(states.len());
    let mut later: Option<(S, Moments)> = None;
    for (index, &forward) in states.iter().enumerate().rev() {
        let led = later.as_ref().and_then(|(next, _)| forward.led_as_in(next));
        let state = led.unwrap_or(forward);
        let filtered = state.moments(model);
        let linked = later.as_ref().filter(|_| led.is_some()).and_then(|(next, moments)| {
            let link = state.link(model, measurements.get(index)?, next)?;
            let mut surprise = &moments.mean - &link.predicted_mean;
            for (i, value) in surprise.iter_mut().enumerate() {
                if let Some(period) = state.period(model, i) {
                    *value -= period * (*value / period).round();
                }
            }
            smooth_step(&filtered, &link.cross, &link.predicted_covariance, &moments.covariance, &surprise)
        });
        let moments = linked.unwrap_or(filtered);
        let mut smoothed = state.smoothed(model, &moments);
        for angle in smoothed.iter_mut().flat_map(|smoothed| &mut smoothed.angles_rad) {
            *angle = least_angle(*angle);
        }
        all.push(smoothed);
        later = Some((state, moments));
    }
    all.reverse();
    all
}
