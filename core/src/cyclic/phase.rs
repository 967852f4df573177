//! The cycle position c as a point on a circle of circumference one.
//!
//! ```
//! use sinew_core::cyclic::phase::{position_difference, wrap_position};
//!
//! assert!((wrap_position(1.25) - 0.25).abs() < 1e-6);
//! // From 0.9 to 0.1 of a cycle the shorter arc is forward.
//! assert!((position_difference(0.1, 0.9) - 0.2).abs() < 1e-6);
//! ```

use crate::math::floor;

/// Range of [`wrap_position`].
pub(crate) const POSITIONS_IN_CYCLE: core::ops::RangeInclusive<f32> = 0.0..=1.0_f32.next_down();

/// `position` moved by whole cycles into [0, 1); 0 for NaN and infinity.
///
/// ```
/// use sinew_core::cyclic::phase::wrap_position;
///
/// // A tenth of a cycle further on, over the end of one and into the next.
/// assert!((wrap_position(0.95 + 0.1) - 0.05).abs() < 1e-6);
/// assert_eq!(wrap_position(-0.25), 0.75);
/// ```
#[cfg_attr(target_arch = "x86_64", inline)]
#[cfg_attr(not(target_arch = "x86_64"), inline(never))]
#[must_use]
pub fn wrap_position(position: f32) -> f32 {
    let wrapped = position - floor(position);
    if (0.0..1.0).contains(&wrapped) { wrapped } else { 0.0 }
}

/// Signed shorter arc from `from` to `to`, in (-0.5, 0.5] cycles.
///
/// ```
/// use sinew_core::cyclic::phase::position_difference;
///
/// // An estimate of 0.98 at a true position of 0.03 lags by a twentieth of a cycle.
/// assert!((position_difference(0.98, 0.03) + 0.05).abs() < 1e-6);
/// ```
#[inline]
#[must_use]
pub fn position_difference(to: f32, from: f32) -> f32 {
    let difference = wrap_position(to - from);
    if difference > 0.5 { difference - 1.0 } else { difference }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_wrapped_position_lies_in_the_cycle_and_differs_by_whole_cycles(position in -1.0e4_f32..1.0e4) {
            let wrapped = wrap_position(position);
            prop_assert!((0.0..1.0).contains(&wrapped));
            let cycles = position - wrapped;
            prop_assert!((cycles - cycles.round()).abs() < 2.0e-3);
        }

        #[test]
        fn the_difference_leads_from_one_position_to_the_other(from in 0.0_f32..1.0, to in 0.0_f32..1.0) {
            let difference = position_difference(to, from);
            prop_assert!(difference > -0.5 && difference <= 0.5);
            prop_assert!(position_difference(wrap_position(from + difference), to).abs() < 1.0e-6);
        }
    }

    #[test]
    fn positions_wrap_across_the_seam() {
        assert!((position_difference(0.02, 0.98) - 0.04).abs() < 1.0e-6);
        assert!((position_difference(0.98, 0.02) + 0.04).abs() < 1.0e-6);
        assert_eq!(wrap_position(1.0), 0.0);
        assert_eq!(wrap_position(-1.0e-9), 0.0, "rounds up to one, which is zero again");
        assert_eq!(wrap_position(f32::NAN), 0.0);
    }
}
