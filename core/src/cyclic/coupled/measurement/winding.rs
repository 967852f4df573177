//! Angles that wind unlike the mean cycle, and which of them inform the phase.
//!
//! A forearm that points at the camera winds in one cycle and swings in the next. Such an angle
//! gains or loses a whole turn on the mean cycle. No deviation of a person models that, so the
//! filter would estimate a wrong speed. An angle whose distance from the mean cycle passes half a
//! turn does not inform the phase for [`EXCLUDED_CYCLES`] cycles.

use crate::cyclic::coupled::ablation::{Part, is_on};
use crate::cyclic::coupled::constants::EXCLUDED_CYCLES;
use crate::math::round_small;
use crate::saved_state::{SavedState, StateVisitor};
use core::f32::consts::TAU;

/// Turns of an angle relative to the mean cycle, and its exclusion, in one byte of the state.
#[derive(Debug, Clone, Copy, PartialEq)]
struct TurnOffset(u8);

impl TurnOffset {
    /// Modulus of the turns: only changes matter.
    const TURNS: u8 = 4;

    const fn new(turns: u8, excluded_cycles: u8) -> Self {
        Self(excluded_cycles * Self::TURNS + turns % Self::TURNS)
    }

    /// Whole turns ahead of the mean cycle, modulo [`Self::TURNS`].
    const fn turns(self) -> u8 {
        self.0 % Self::TURNS
    }

    /// Cycles to be completed before the angle informs the phase again.
    const fn excluded_cycles(self) -> u8 {
        self.0 / Self::TURNS
    }
}

/// Turns of each angle relative to the mean cycle, and the angles excluded from the phase's
/// evidence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Winding<const N: usize> {
    turn_offsets: [TurnOffset; N],
    /// Number of the last cycle, modulo 256.
    cycle: i8,
    /// Whether the turn offsets are initialised.
    initialised: bool,
}

impl<const N: usize> SavedState for Winding<N> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        let mut byte = |byte: u8| {
            let mut word = u32::from(byte);
            visitor.word(&mut word);
            word.to_le_bytes()[0]
        };
        for turn_offset in &mut self.turn_offsets {
            let saved = TurnOffset(byte(turn_offset.0));
            *turn_offset = TurnOffset::new(saved.turns(), saved.excluded_cycles().min(EXCLUDED_CYCLES));
        }
        self.cycle = byte(self.cycle.cast_unsigned()).cast_signed();
        visitor.flag(&mut self.initialised);
    }
}

impl<const N: usize> Winding<N> {
    /// Before the first frame: every angle informs the phase.
    pub(crate) const fn new() -> Self {
        Self { turn_offsets: [TurnOffset(0); N], cycle: 0, initialised: false }
    }

    /// Whether the angle at `index` winds like the mean cycle and so informs the phase.
    #[inline]
    pub(crate) fn informs_phase(&self, index: usize) -> bool {
        !is_on(Part::WindingExclusion)
            || self.turn_offsets.get(index).is_none_or(|turn_offset| turn_offset.excluded_cycles() == 0)
    }

    /// Updates the exclusions by the number of completed cycles.
    pub(crate) fn count_cycles(&mut self, cycles: i32) {
        if (cycles as i8).wrapping_sub(self.cycle) > 0 {
            self.turn_offsets = self.turn_offsets.map(|turn_offset| {
                TurnOffset::new(turn_offset.turns(), turn_offset.excluded_cycles().saturating_sub(1))
            });
        }
        self.cycle = cycles as i8;
    }

    /// Updates the angle at `index`, which is `turns` whole turns and `ahead_rad` ahead of the mean
    /// cycle.
    #[inline]
    pub(crate) fn update(&mut self, index: usize, turns: i32, ahead_rad: f32) {
        let turns =
            turns.wrapping_add(round_small(ahead_rad / TAU) as i32).rem_euclid(i32::from(TurnOffset::TURNS)) as u8;
        if let Some(turn_offset) = self.turn_offsets.get_mut(index) {
            let has_turned = self.initialised && turn_offset.turns() != turns;
            *turn_offset =
                TurnOffset::new(turns, if has_turned { EXCLUDED_CYCLES } else { turn_offset.excluded_cycles() });
        }
    }

    /// Marks the turn offsets as initialised: from here on a change excludes an angle.
    pub(crate) const fn initialise(&mut self) {
        self.initialised = true;
    }
}

#[cfg(test)]
mod tests {
    use super::{EXCLUDED_CYCLES, Winding};
    use core::f32::consts::TAU;

    #[test]
    fn an_angle_that_gains_a_turn_is_excluded_for_three_cycles() {
        let mut winding = Winding::<2>::new();
        for tenth in 0..100 {
            let cycles = tenth / 10;
            // Angle 0 swings. Angle 1 winds in the first two cycles, unlike the mean cycle.
            let gone_rad = (0.1 * tenth as f32 + 0.01).min(2.0) * TAU;
            winding.count_cycles(cycles);
            winding.update(0, 0, 2.0 * gone_rad.sin());
            winding.update(1, 0, gone_rad);
            winding.initialise();
            assert!(winding.informs_phase(0));
            // It passes half a turn in the first cycle, and again in the second.
            assert_eq!(winding.informs_phase(1), tenth < 5 || cycles > i32::from(EXCLUDED_CYCLES), "{tenth}");
        }
        assert!(winding.informs_phase(7), "beyond the last angle");
    }

    #[test]
    fn the_turns_of_the_first_frame_exclude_no_angle() {
        let mut winding = Winding::<1>::new();
        winding.update(0, -5, 0.3);
        winding.initialise();
        winding.update(0, -5, 0.5);
        assert!(winding.informs_phase(0));
    }
}
