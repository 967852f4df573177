//! What the next frame needs of the last ones.

use super::belief::HandsBelief;
use super::evidence::Liveliness;
use super::grid::{CellGrid, MAX_FRAMES};
use super::hands::HandFinder;
use super::head::HeadBox;
use super::person_colour::PersonColour;
use crate::ranges::MAX_PX;
use crate::saved_state::{SavedState, StateVisitor};

/// Beyond luminance and chrominance of any colour.
const MAX_CHROMINANCE: f32 = 512.0;
/// Its square.
const MAX_COVARIANCE: f32 = MAX_CHROMINANCE * MAX_CHROMINANCE;

impl<const COLUMNS: usize, const ROWS: usize> SavedState for HandFinder<COLUMNS, ROWS> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        let mut has_head = self.head.is_some();
        visitor.flag(&mut has_head);
        let mut head = self.head.unwrap_or(HeadBox { centre_px: [0.0; 2], width_px: 1.0 });
        head.visit(visitor);
        self.head = has_head.then_some(head);
        self.grid.visit(visitor);
        self.liveliness.visit(visitor);
        self.belief.visit(visitor);
    }
}

impl SavedState for HeadBox {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.reals(&mut self.centre_px, &(-MAX_PX..=MAX_PX));
        visitor.real(&mut self.width_px, &(1.0..=MAX_PX));
    }
}

impl<const COLUMNS: usize, const ROWS: usize> SavedState for CellGrid<COLUMNS, ROWS> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        let mut frames = usize::from(self.frames);
        visitor.index(&mut frames, usize::from(MAX_FRAMES));
        self.frames = frames as u8;
        for cell in self.cells.as_flattened_mut() {
            let mut word = cell.to_word();
            visitor.word(&mut word);
            if !cell.set_word(word) {
                visitor.refuse();
            }
        }
    }
}

impl SavedState for Liveliness {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.real(&mut self.most, &(0.0..=1.0));
    }
}

impl SavedState for HandsBelief {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.flag(&mut self.has_begun);
        let most = self.positions.len();
        visitor.index(&mut self.count, most);
        visitor.reals(self.positions.as_flattened_mut(), &(-MAX_PX..=MAX_PX));
        visitor.reals(self.pairs.as_flattened_mut(), &(0.0..=1.0));
    }
}

impl SavedState for PersonColour {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.reals(&mut self.mean, &(-MAX_CHROMINANCE..=MAX_CHROMINANCE));
        visitor.reals(&mut self.covariance, &(-MAX_COVARIANCE..=MAX_COVARIANCE));
        match Self::new(self.mean, self.covariance) {
            Some(colour) => *self = colour,
            None => visitor.refuse(),
        }
    }
}
