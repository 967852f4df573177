//! Cycles counted and phases passed, from the cycle positions that a filter estimates.
//!
//! ```
//! use sinew_core::cyclic::events::CycleCounter;
//!
//! // A fifth of a cycle a frame, from 0.1 on: position 0 is passed between the fourth frame and the fifth.
//! let mut counter = CycleCounter::new(0.1);
//! for frame in 1..=5 {
//!     let position = (0.1 + 0.2 * frame as f32) % 1.0;
//!     let step = counter.advance(position, 0.2, 1.0);
//!     assert_eq!(step.passed(0.0).is_some(), frame == 5);
//! }
//! assert_eq!(counter.completed(), 1);
//! ```

use crate::cyclic::phase::{POSITIONS_IN_CYCLE, position_difference, wrap_position};
use crate::math::{floor, min, round};
use crate::saved_state::{SavedState, StateVisitor};

/// Counts cycles from one estimate to the next.
///
/// Invariant: whole cycles and the part of a cycle are kept apart, so that the count stays exact
/// however long it runs.
///
/// ```
/// use sinew_core::cyclic::events::CycleCounter;
///
/// // Three cycles passed without a measurement: the velocity gives their number.
/// let mut counter = CycleCounter::new(0.25);
/// counter.advance(0.27, 0.02, 150.0);
/// assert_eq!(counter.completed(), 3);
/// assert!((counter.cycles() - 3.02).abs() < 1e-4);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CycleCounter {
    start: f32,
    position: f32,
    laps: i32,
}

/// Progress through the cycle between two frames.
///
/// ```
/// use sinew_core::cyclic::events::CycleCounter;
///
/// // The heel strikes at position 0, between two frames: four fifths of a frame after the earlier one.
/// let mut counter = CycleCounter::new(0.92);
/// let step = counter.advance(0.02, 0.1, 1.0);
/// assert!(step.passed(0.0).is_some_and(|frames| (frames - 0.8).abs() < 1e-4));
/// assert_eq!(step.passed(0.5), None, "the other heel is not due yet");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CycleStep {
    /// Position before, [0, 1).
    pub from: f32,
    /// Position after, [0, 1).
    pub to: f32,
    /// Passages of position 0 on the way; negative backwards.
    pub laps: i32,
    /// Cycles passed since; negative backwards.
    pub advance: f32,
    /// Time between both, frames.
    pub step_frames: f32,
}

impl SavedState for CycleCounter {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.real(&mut self.start, &POSITIONS_IN_CYCLE);
        visitor.real(&mut self.position, &POSITIONS_IN_CYCLE);
        visitor.integer(&mut self.laps);
    }
}

impl CycleCounter {
    /// Counts from position 0 on.
    #[must_use]
    pub const fn zero() -> Self {
        Self { start: 0.0, position: 0.0, laps: 0 }
    }

    /// Counts from `position` on.
    #[must_use]
    pub fn new(position: f32) -> Self {
        let position = wrap_position(position);
        Self { start: position, position, laps: 0 }
    }

    /// Advances to `position`, reached after `step_frames` at about `velocity_per_frame`.
    ///
    /// The number of laps is the one whose advance is nearest to velocity times time.
    pub fn advance(&mut self, position: f32, velocity_per_frame: f32, step_frames: f32) -> CycleStep {
        let position = wrap_position(position);
        let expected = velocity_per_frame * step_frames;
        let expected = if expected.is_finite() { expected } else { 0.0 };
        let from = self.position;
        let advance = expected + position_difference(position, wrap_position(from + expected));
        let laps = round(from + advance - position) as i32;
        self.laps = self.laps.saturating_add(laps);
        self.position = position;
        CycleStep { from, to: position, laps, advance, step_frames }
    }

    /// Whole cycles completed since the start; negative if the motion ran backwards.
    #[must_use]
    pub fn completed(&self) -> i32 {
        self.laps.saturating_add(floor(self.position - self.start) as i32)
    }

    /// Cycles since the start with their part.
    #[must_use]
    pub fn cycles(&self) -> f32 {
        self.laps as f32 + (self.position - self.start)
    }

    /// The same in two parts: passages of position 0, and the position minus the first part. The
    /// second part stays exact over any number of cycles.
    #[must_use]
    pub fn laps_and_part(&self) -> (i32, f32) {
        (self.laps, self.position - self.start)
    }
}

impl CycleStep {
    /// A step of zero length at `position`.
    #[must_use]
    pub fn none(position: f32) -> Self {
        let position = wrap_position(position);
        Self { from: position, to: position, laps: 0, advance: 0.0, step_frames: 0.0 }
    }

    /// When `phase` was passed forwards, frames after the earlier estimate, in (0, step]; `None` if
    /// it was not.
    ///
    /// Linear between both estimates; the first passage where a long step holds several. The two
    /// positions and the laps decide whether it was passed. By the rounded advance, a phase at the
    /// border of two steps could count twice or never.
    #[must_use]
    pub fn passed(&self, phase: f32) -> Option<f32> {
        let phase = wrap_position(phase);
        let passages = self.laps + i32::from(self.to >= phase) - i32::from(self.from >= phase);
        let ahead = wrap_position(phase - self.from);
        let ahead = if ahead > 0.0 { ahead } else { 1.0 };
        (passages > 0).then(|| min(ahead / self.advance, 1.0) * self.step_frames)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn cycles_are_counted_at_any_velocity_and_start(
            start in 0.0_f32..1.0, velocity in -0.3_f32..0.3, step in 0.3_f32..8.0,
        ) {
            let mut counter = CycleCounter::new(start);
            let mut passages = 0_i32;
            for i in 1..=200_u16 {
                let way = velocity * step * f32::from(i);
                let advance = counter.advance(start + way, velocity, step);
                passages += i32::from(advance.passed(0.25).is_some());
                prop_assert!((advance.advance - velocity * step).abs() < 1.0e-3);
            }
            let cycles = velocity * step * 200.0;
            prop_assert!((counter.cycles() - cycles).abs() < 1.0e-2);
            prop_assert!((counter.completed() as f32 - cycles.floor()).abs() <= 1.0);
            if velocity > 0.0 && velocity * step < 0.9 {
                prop_assert!((passages as f32 - cycles).abs() <= 1.01);
            }
        }
    }

    #[test]
    fn a_phase_at_the_border_of_two_steps_is_passed_once() {
        for start in [0.0_f32, 0.05, 0.1, 0.2, 0.25] {
            for way in [0.05_f32, 0.1, 0.2, 0.25, 0.5] {
                let mut counter = CycleCounter::new(start);
                let frames = (100.0 / way) as i32;
                let passages =
                    (1..=frames).filter(|&i| counter.advance(start + way * i as f32, way, 1.0).passed(0.25).is_some());
                assert!((passages.count() as i32 - 100).abs() <= 1, "from {start} by {way}");
            }
        }
    }

    #[test]
    fn a_phase_is_passed_between_frames() {
        let mut counter = CycleCounter::new(0.96);
        let step = counter.advance(0.04, 0.08, 1.0);
        assert!((step.passed(0.0).unwrap() - 0.5).abs() < 1.0e-4);
        assert_eq!(step.passed(0.5), None);
        let back = counter.advance(0.96, -0.08, 1.0);
        assert_eq!(back.passed(0.0), None, "backwards does not count");
        assert_eq!(counter.completed(), 0);
        assert_eq!(counter.laps_and_part(), (0, 0.0));
    }
}
