//! Estimate of every cyclic filter after a frame.

use crate::cyclic::phase::POSITIONS_IN_CYCLE;
use crate::cyclic::saved_ranges::{NUMBER, VARIANCE};
use crate::saved_state::{FINITE, SavedState, StateVisitor};
use core::f32::consts::PI;

/// Pose and phase with their variances. `N` is a capacity; entries beyond the model's angles are
/// zero.
///
/// ```
/// # use sinew_core::cyclic::CycleStart;
/// use core::f32::consts::TAU;
///
/// # let start = CycleStart::<1> {
/// #     angles_rad: [7.0],
/// #     extra_variance_rad2: [0.0],
/// #     velocities: [0.0],
/// #     cycle_position: 0.25,
/// #     cycle_velocity: 1.0 / 64.0,
/// # };
/// # let estimate = start.estimate();
/// // An angle that has wound once: 7 rad.
/// assert_eq!(estimate.turns, [1]);
/// assert!((estimate.angles_rad[0] + TAU * estimate.turns[0] as f32 - 7.0).abs() < 1e-5);
/// // 64 frames a cycle at 60 frames a second.
/// let (cadence_per_min, _) = estimate.cadence_per_min(60.0);
/// assert_eq!(cadence_per_min, 56.25);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CyclicEstimate<const N: usize> {
    /// Angles in (-pi, pi].
    pub angles_rad: [f32; N],
    /// Whole turns of each angle since the start: the unwrapped angle is `angles_rad` + 2 pi
    /// `turns`.
    pub turns: [i32; N],
    /// Variance of each angle, rad^2.
    pub angle_variance_rad2: [f32; N],
    /// Position c in the cycle, [0, 1).
    pub cycle_position: f32,
    /// Variance of c, cycles^2.
    pub cycle_position_variance: f32,
    /// Velocity v through the cycle, cycles per frame of the model's rate.
    pub cycle_velocity_per_frame: f32,
    /// Variance of v.
    pub cycle_velocity_variance: f32,
    /// Natural logarithm of the density of this frame's measurement given those before; 0 without a
    /// measurement.
    pub log_likelihood: f32,
    /// Whether this frame's measurement lies beyond the innovation gate.
    pub outlier: bool,
    /// Whether the person has for a cycle or two differed from the model's mean cycle by more than
    /// people do in the training: another motion, or wrong measurements. Filter `coupled` only.
    pub misfit: bool,
}

impl<const N: usize> CyclicEstimate<N> {
    /// Before any frame: all zeros.
    pub(crate) const NOTHING: Self = Self {
        angles_rad: [0.0; N],
        turns: [0; N],
        angle_variance_rad2: [0.0; N],
        cycle_position: 0.0,
        cycle_position_variance: 0.0,
        cycle_velocity_per_frame: 0.0,
        cycle_velocity_variance: 0.0,
        log_likelihood: 0.0,
        outlier: false,
        misfit: false,
    };

    /// Cycles per minute at `rate_hz` frames per second, and their standard deviation.
    #[must_use]
    pub fn cadence_per_min(&self, rate_hz: f32) -> (f32, f32) {
        let per_minute = 60.0 * rate_hz;
        (
            self.cycle_velocity_per_frame * per_minute,
            crate::math::sqrt(crate::math::max(self.cycle_velocity_variance, 0.0)) * per_minute,
        )
    }
}

impl<const N: usize> SavedState for CyclicEstimate<N> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.reals(&mut self.angles_rad, &(-PI..=PI));
        for turns in &mut self.turns {
            visitor.integer(turns);
        }
        visitor.reals(&mut self.angle_variance_rad2, &VARIANCE);
        visitor.real(&mut self.cycle_position, &POSITIONS_IN_CYCLE);
        visitor.real(&mut self.cycle_position_variance, &VARIANCE);
        visitor.real(&mut self.cycle_velocity_per_frame, &NUMBER);
        visitor.real(&mut self.cycle_velocity_variance, &VARIANCE);
        visitor.real(&mut self.log_likelihood, &FINITE);
        visitor.flag(&mut self.outlier);
        visitor.flag(&mut self.misfit);
    }
}
