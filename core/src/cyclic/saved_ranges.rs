//! Ranges of the numbers in saved states of the cyclic filters. They are as wide as any step may
//! need, and so narrow that the next step of a forged state stays finite.

use crate::math::sqrt;
use core::ops::RangeInclusive;

/// Any number of a state. Chosen: thousands of times what a step gives, and products of four such
/// numbers are finite.
pub(in crate::cyclic) const NUMBER: RangeInclusive<f32> = -1.0e6..=1.0e6;
/// Any variance of a state; see [`NUMBER`].
pub(in crate::cyclic) const VARIANCE: RangeInclusive<f32> = 0.0..=1.0e6;
/// Part by which rounding may take a covariance beyond the product of its standard deviations.
/// Chosen: a tenth of it suffices for 20000 hostile frames
const ROUNDING: f32 = 0.01;

/// Greatest covariance of two numbers with these variances.
pub(in crate::cyclic) fn covariance_bound(variances: [f32; 2]) -> f32 {
    (1.0 + ROUNDING) * sqrt(variances[0]) * sqrt(variances[1])
}
