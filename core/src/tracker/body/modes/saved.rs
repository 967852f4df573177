//! A tracker by modes as its state is saved.

use super::super::saved::{NUMBER, places};
use super::options::MAX_MODES;
use super::state::{BodyMode, ModeTracker};
use crate::saved_state::{SavedState, StateVisitor};

impl<const BONES: usize, const ANGLES: usize> SavedState for BodyMode<BONES, ANGLES> {
    /// A drawn limb is left out: no mode has one between frames.
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        self.pose.visit(visitor);
        self.velocity.visit(visitor);
        visitor.reals(&mut self.spread_m, &NUMBER);
        visitor.reals(core::slice::from_mut(&mut self.log_weight), &NUMBER);
        visitor.reals(core::slice::from_mut(&mut self.log_density), &NUMBER);
        visitor.flag(&mut self.is_rival);
    }
}

impl<const BONES: usize, const ANGLES: usize> SavedState for ModeTracker<BONES, ANGLES> {
    /// A state is for a tracker that follows as many modes.
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.long(&mut self.seed);
        visitor.long(&mut self.frame);
        let mut count = self.modes.len();
        visitor.index(&mut count, MAX_MODES);
        if count == 0 || count > self.options.max_modes {
            visitor.refuse();
            return;
        }
        let first = self.modes[0];
        // There is room for the most modes.
        let _ = self.modes.resize(count, first);
        for mode in &mut self.modes {
            mode.visit(visitor);
        }
        places(&mut self.first_m, visitor);
        self.deadband.reported.visit(visitor);
        places(&mut self.deadband.off_m, visitor);
        visitor.reals(&mut self.noise.shares, &NUMBER);
        for is_unseen in &mut self.noise.is_unseen {
            visitor.flag(is_unseen);
        }
    }
}
