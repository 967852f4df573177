//! Angles that go round otherwise than the mean cycle does: a forearm that points at the camera winds in one cycle and swings in the
//! next, and in one person winds where in the model's people it does not.
//!
//! Such an angle gains or loses a whole turn on the mean cycle in each cycle. No deviation of a person says that, and what the
//! phase-coupled filter makes of it is a wrong speed. So an angle whose distance from the mean cycle passes half a turn tells
//! nothing about the phase for some cycles.

use crate::math::round_small;
use crate::saved_state::{SavedState, StateVisitor};
use core::f32::consts::TAU;

/// Completed cycles for which an angle is not believed after it gained or lost a turn.
const MISTRUSTED_CYCLES: u8 = 3;

/// An angle beside the mean cycle, in a byte: a state has little room.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Lead(u8);

impl Lead {
    /// Turns are kept modulo this: only changes matter.
    const TURNS: u8 = 4;

    const fn new(turns: u8, mistrusted: u8) -> Self {
        Self(mistrusted * Self::TURNS + turns % Self::TURNS)
    }

    /// Whole turns ahead of the mean cycle.
    const fn turns(self) -> u8 {
        self.0 % Self::TURNS
    }

    /// Cycles to be completed before the angle is believed again.
    const fn mistrusted(self) -> u8 {
        self.0 / Self::TURNS
    }
}

/// Where each angle is beside the mean cycle, and which of them gained or lost a turn of late.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Winding<const N: usize> {
    leads: [Lead; N],
    /// Number of the cycle last seen, modulo 256.
    cycle: i8,
    /// Whether leads are known, so that they can be seen to change.
    begun: bool,
}

impl<const N: usize> SavedState for Winding<N> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        let mut byte = |byte: u8| {
            let mut word = u32::from(byte);
            visitor.word(&mut word);
            word.to_le_bytes()[0]
        };
        for lead in &mut self.leads {
            let saved = Lead(byte(lead.0));
            *lead = Lead::new(saved.turns(), saved.mistrusted().min(MISTRUSTED_CYCLES));
        }
        self.cycle = byte(self.cycle.cast_unsigned()).cast_signed();
        visitor.flag(&mut self.begun);
    }
}

impl<const N: usize> Winding<N> {
    /// Nothing known.
    pub(super) const fn new() -> Self {
        Self { leads: [Lead(0); N], cycle: 0, begun: false }
    }

    /// Whether the angle at `index` winds as the mean cycle does, as far as is known.
    #[inline]
    pub(super) fn is_believed(&self, index: usize) -> bool {
        self.leads.get(index).is_none_or(|lead| lead.mistrusted() == 0)
    }

    /// Takes in the number of cycles completed.
    pub(super) fn complete(&mut self, cycles: i32) {
        if (cycles as i8).wrapping_sub(self.cycle) > 0 {
            self.leads = self.leads.map(|lead| Lead::new(lead.turns(), lead.mistrusted().saturating_sub(1)));
        }
        self.cycle = cycles as i8;
    }

    /// Takes in where the angle at `index` is, `turns` whole turns and `ahead_rad` ahead of the mean cycle.
    #[inline]
    pub(super) fn see(&mut self, index: usize, turns: i32, ahead_rad: f32) {
        let turns = turns.wrapping_add(round_small(ahead_rad / TAU) as i32).rem_euclid(i32::from(Lead::TURNS)) as u8;
        if let Some(lead) = self.leads.get_mut(index) {
            let has_turned = self.begun && lead.turns() != turns;
            *lead = Lead::new(turns, if has_turned { MISTRUSTED_CYCLES } else { lead.mistrusted() });
        }
    }

    /// All angles have been seen.
    pub(super) const fn begin(&mut self) {
        self.begun = true;
    }
}

#[cfg(test)]
mod tests {
    use super::{MISTRUSTED_CYCLES, Winding};
    use core::f32::consts::TAU;

    #[test]
    fn an_angle_that_gains_a_turn_is_not_believed_until_it_has_kept_to_the_cycle() {
        let mut winding = Winding::<2>::new();
        for tenth in 0..100 {
            let cycles = tenth / 10;
            // Angle 0 swings; angle 1 goes round in the first two cycles, which the mean cycle does not.
            let gone_rad = (0.1 * tenth as f32 + 0.01).min(2.0) * TAU;
            winding.complete(cycles);
            winding.see(0, 0, 2.0 * gone_rad.sin());
            winding.see(1, 0, gone_rad);
            winding.begin();
            assert!(winding.is_believed(0));
            // It passes half a turn in the first cycle, and again in the second.
            assert_eq!(winding.is_believed(1), tenth < 5 || cycles > i32::from(MISTRUSTED_CYCLES), "{tenth}");
        }
        assert!(winding.is_believed(7), "what is not there does no harm");
    }

    #[test]
    fn where_an_angle_begins_is_no_turn() {
        let mut winding = Winding::<1>::new();
        winding.see(0, -5, 0.3);
        winding.begin();
        winding.see(0, -5, 0.5);
        assert!(winding.is_believed(0));
    }
}
