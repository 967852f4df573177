//! How the filter's phase agrees with the grid's, over time.

use crate::cyclic::coupled::ablation::{Part, is_on};
use crate::cyclic::coupled::nis_monitor::NisMonitor;
use crate::cyclic::coupled::phase_grid::PhaseMode;
use crate::cyclic::phase::position_difference;
use crate::math::{abs, clamp};
use crate::saved_state::{NOT_NEGATIVE, SavedState, StateVisitor};

/// Weight of a mode of the grid from which it counts as the only one. Chosen: nine to one.
pub(super) const MIN_MODE_WEIGHT: f32 = 0.9;
/// Weight of a mode from which its agreement counts. Chosen: likelier than all others together.
const MIN_AGREED_WEIGHT: f32 = 0.5;
/// Phase difference beyond the mean offset up to which filter and grid agree, cycles. Chosen: half
/// of [`MIN_DISAGREEMENT_CYCLES`].
const MAX_AGREEMENT_CYCLES: f32 = 0.06;
/// Phase difference beyond the mean offset from which filter and grid disagree, cycles. Chosen:
/// below [`crate::cyclic::coupled::state::LOST_STD`], where the linearisation ends.
const MIN_DISAGREEMENT_CYCLES: f32 = 0.12;
/// Frames over which the mean phase offset is averaged. Chosen: two seconds at 60 Hz.
const OFFSET_AVERAGING_FRAMES: f32 = 120.0;
/// Largest mean phase offset, cycles. Chosen: a person is a little early or late against the mean
/// cycle, not more.
const MAX_PHASE_OFFSET: f32 = 0.1;

/// State of the filter's comparison with the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::cyclic::coupled) struct Watch {
    /// Frames since the grid last moved.
    pub(in crate::cyclic::coupled) unwatched_frames: f32,
    /// Mean of grid's phase minus filter's, cycles: the grid has the mean person, the filter this
    /// one.
    pub(super) mean_phase_offset: f32,
    /// Frames in a row of disagreement.
    pub(super) disagreement_frames: f32,
    /// Whether the phase is unknown, so that the estimate is the mean over the grid.
    pub(in crate::cyclic::coupled) searching: bool,
    /// Whether the grid confirmed the filter's phase when it was last updated.
    pub(in crate::cyclic::coupled) agrees: bool,
    /// How well measurements are predicted.
    pub(in crate::cyclic::coupled) nis: NisMonitor,
}

impl SavedState for Watch {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.real(&mut self.unwatched_frames, &NOT_NEGATIVE);
        visitor.real(&mut self.mean_phase_offset, &(-MAX_PHASE_OFFSET..=MAX_PHASE_OFFSET));
        visitor.real(&mut self.disagreement_frames, &NOT_NEGATIVE);
        visitor.flag(&mut self.searching);
        visitor.flag(&mut self.agrees);
        self.nis.visit(visitor);
    }
}

impl Watch {
    /// Locked, with no disagreement so far.
    pub(in crate::cyclic::coupled) const fn new() -> Self {
        Self {
            unwatched_frames: 0.0,
            mean_phase_offset: 0.0,
            disagreement_frames: 0.0,
            searching: false,
            agrees: false,
            nis: NisMonitor::new(),
        }
    }

    /// Compares the grid's `mode` with the filter's `position`, `frames` after the last comparison.
    pub(super) fn compare(&mut self, mode: &PhaseMode, position: f32, frames: f32) {
        let beyond = position_difference(position_difference(mode.position, position), self.mean_phase_offset);
        let share = if is_on(Part::MeanPhaseOffset) { frames / OFFSET_AVERAGING_FRAMES } else { 0.0 };
        self.mean_phase_offset = clamp(self.mean_phase_offset + share * beyond, -MAX_PHASE_OFFSET, MAX_PHASE_OFFSET);
        self.agrees = mode.weight > MIN_AGREED_WEIGHT && abs(beyond) < MAX_AGREEMENT_CYCLES;
        if self.agrees {
            self.nis.raise_floor(frames);
        }
        let disagrees = mode.weight > MIN_MODE_WEIGHT && abs(beyond) > MIN_DISAGREEMENT_CYCLES;
        self.disagreement_frames = if disagrees { self.disagreement_frames + frames } else { 0.0 };
    }
}
