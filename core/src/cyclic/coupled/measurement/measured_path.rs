//! Whole turns of each angle along its measurements.
//!
//! An estimate that lags behind a fast angle may take the shorter arc in the wrong direction. The
//! arc between two measurements is short unless their noise is wide or the interval is long.

use crate::cyclic::AngleMeasurement;
use crate::cyclic::coupled::ablation::{Part, is_on};
use crate::cyclic::coupled::constants::{GATE_SIGMAS, MAX_INTERVAL_FRAMES};
use crate::math::{round_small, wrap_angle};
use crate::saved_state::{SavedState, StateVisitor};
use core::f32::consts::{PI, SQRT_2, TAU};

/// Steps of a turn in which a measured angle is stored. Chosen: one byte, whose wrapping difference
/// is the shorter arc.
const STEPS: f32 = 256.0;

/// Largest standard deviation of a measurement by which turns are counted, rad: half a turn then
/// lies at the gate of the difference of two measurements.
const MAX_TURN_STD_RAD: f32 = PI / (GATE_SIGMAS * SQRT_2);

/// Last measurement of each angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MeasuredPath<const N: usize> {
    /// Angle in steps of a turn, of which a turn has [`STEPS`].
    last: [i8; N],
    /// One bit for each angle measured in the last frame.
    known: u32,
}

impl<const N: usize> SavedState for MeasuredPath<N> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        for last in &mut self.last {
            let mut word = u32::from(last.cast_unsigned());
            visitor.word(&mut word);
            *last = word.to_le_bytes()[0].cast_signed();
        }
        visitor.word(&mut self.known);
    }
}

impl<const N: usize> MeasuredPath<N> {
    /// Without measurements.
    pub(crate) const fn new() -> Self {
        Self { last: [0; N], known: 0 }
    }

    /// Whole turns to add to the shorter arc from `from_rad` to `to_rad`, so that the estimate
    /// stays within half a turn of the measurements.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    #[cfg_attr(not(target_arch = "x86_64"), inline)]
    pub(crate) fn turns(
        &mut self,
        index: usize,
        [from_rad, to_rad]: [f32; 2],
        measurement: &AngleMeasurement<N>,
    ) -> i32 {
        let bit = 1_u32.checked_shl(index as u32).unwrap_or(0);
        let was_known = self.known & bit != 0;
        self.known &= !bit;
        let (Some(measured_rad), Some(last)) = (measurement.angle_rad(index), self.last.get_mut(index)) else {
            return 0;
        };
        let is_noisy = measurement.std_rad().get(index).is_none_or(|std_rad| *std_rad > MAX_TURN_STD_RAD);
        if is_noisy || measurement.step_frames() > MAX_INTERVAL_FRAMES || !is_on(Part::MeasuredPath) {
            return 0;
        }
        self.known |= bit;
        let now = round_small(wrap_angle(measured_rad) * (STEPS / TAU)) as i32 as i8;
        let before = core::mem::replace(last, now);
        if !was_known {
            return 0;
        }
        let angle_rad = |steps: i8| f32::from(steps) * (TAU / STEPS);
        let arc_rad = wrap_angle(angle_rad(before) - from_rad)
            + angle_rad(now.wrapping_sub(before))
            + wrap_angle(to_rad - angle_rad(now));
        round_small((arc_rad - wrap_angle(to_rad - from_rad)) / TAU) as i32
    }
}

#[cfg(test)]
mod tests {
    use super::MeasuredPath;
    use crate::angle::split_turns;
    use crate::cyclic::AngleMeasurement;
    use core::f32::consts::{PI, TAU};

    fn seen(angle_rad: f32, std_rad: f32) -> AngleMeasurement<1> {
        AngleMeasurement::new(&[Some(angle_rad)], std_rad).unwrap()
    }

    /// An angle winds forwards in three steps. The lagging estimate turns back and meets it on the
    /// other side.
    #[test]
    fn a_lagging_estimate_keeps_the_turns_of_the_measurements() {
        let mut path = MeasuredPath::new();
        let (mut before_rad, mut turns, mut shorter_turns) = (0.0, 0, 0);
        for (gone_rad, estimate_rad) in [(0.0, 0.0), (2.0, -0.2), (4.0, -1.5), (6.0, -0.4), (8.0, 1.6), (10.0, -2.6)] {
            let shorter = -split_turns(estimate_rad - before_rad).1;
            shorter_turns += shorter;
            turns += shorter + path.turns(0, [before_rad, estimate_rad], &seen(gone_rad, 0.1));
            let off_rad = estimate_rad + TAU * turns as f32 - gone_rad;
            assert!(off_rad.abs() < PI, "{off_rad} off at {gone_rad}");
            before_rad = estimate_rad;
        }
        assert_eq!([turns, shorter_turns], [2, 1]);
    }

    /// The measurements wind in three steps and the estimate does not. The second measurement
    /// varies.
    #[test]
    fn wide_noise_gaps_and_long_steps_leave_the_shorter_arc() {
        let round = |second: &AngleMeasurement<1>| {
            let mut path = MeasuredPath::new();
            path.turns(0, [0.0, 0.0], &seen(0.0, 0.1))
                + path.turns(0, [0.0, -0.2], second)
                + path.turns(0, [-0.2, -1.5], &seen(4.0, 0.1))
                + path.turns(0, [-1.5, 0.0], &seen(TAU, 0.1))
        };
        assert_eq!(round(&seen(2.0, 0.1)), 1);
        assert_eq!(round(&seen(2.0, 0.6)), 0);
        assert_eq!(round(&AngleMeasurement::nothing()), 0);
        assert_eq!(round(&seen(2.0, 0.1).after(5.0).unwrap()), 0);
    }
}
