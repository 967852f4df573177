//! The phase grid as a filter keeps it between two looks: a state has little room.

use crate::cyclic::coupled::phase_grid::{POSITIONS, PhaseGrid, SPEEDS};
use crate::cyclic::phase::POSITIONS_IN_CYCLE;
use crate::numeric::bf16::Bf16;
use crate::saved_state::{SavedState, StateVisitor};

/// A [`PhaseGrid`] with its weights rounded to eight binary digits, which is finer than any of them is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StoredGrid {
    weights: [[Bf16; POSITIONS]; SPEEDS],
    travelled: [f32; SPEEDS],
}

impl SavedState for StoredGrid {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        let mut grid = self.open();
        visitor.reals(grid.weights.as_flattened_mut(), &(0.0..=1.001));
        visitor.reals(&mut grid.travelled, &POSITIONS_IN_CYCLE);
        let sum: f32 = grid.weights.iter().flatten().sum();
        if !(0.99..=1.01).contains(&sum) {
            visitor.refuse();
        }
        self.keep(&grid);
    }
}

impl StoredGrid {
    /// Nothing known.
    pub(super) const fn uniform() -> Self {
        let weight = Bf16::new(1.0 / (POSITIONS * SPEEDS) as f32);
        Self { weights: [[weight; POSITIONS]; SPEEDS], travelled: [0.0; SPEEDS] }
    }

    /// The grid, to look at and to move.
    #[inline]
    pub(super) fn open(&self) -> PhaseGrid {
        PhaseGrid { weights: self.weights.map(|row| row.map(Bf16::get)), travelled: self.travelled }
    }

    /// Keeps `grid` in the place of this one.
    #[inline]
    pub(super) fn keep(&mut self, grid: &PhaseGrid) {
        for (row, weights) in self.weights.iter_mut().zip(&grid.weights) {
            for (short, weight) in row.iter_mut().zip(weights) {
                *short = Bf16::new(*weight);
            }
        }
        self.travelled = grid.travelled;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_kept_knows_what_it_knew() {
        let mut stored = StoredGrid::uniform();
        let grid = PhaseGrid::near(0.3);
        assert!(stored.open().weight_near(0.3) < 0.4);
        stored.keep(&grid);
        assert!((stored.open().weight_near(0.3) - grid.weight_near(0.3)).abs() < 0.004);
        let once = stored;
        stored.keep(&once.open());
        assert_eq!(stored, once, "what was rounded stays");
    }
}
