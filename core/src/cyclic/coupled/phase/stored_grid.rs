//! The phase grid as the filter stores it between two updates: weights in bfloat16.

use crate::cyclic::CoupledModel;
use crate::cyclic::coupled::phase::phase_grid::{POSITIONS, PhaseGrid, PhaseMode, SPEEDS};
use crate::cyclic::phase::POSITIONS_IN_CYCLE;
use crate::numeric::bf16::Bf16;
use crate::saved_state::{SavedState, StateVisitor};

/// A [`PhaseGrid`] with its weights in [`Bf16`], so that the filter's state fits 4 KiB.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct StoredGrid {
    weights: [[Bf16; POSITIONS]; SPEEDS],
    travelled: [f32; SPEEDS],
}

impl SavedState for StoredGrid {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        for short in self.weights.as_flattened_mut() {
            let mut weight = short.get();
            visitor.real(&mut weight, &(0.0..=1.001));
            *short = Bf16::new(weight);
        }
        visitor.reals(&mut self.travelled, &POSITIONS_IN_CYCLE);
        // As they are stored, which is rounded.
        let sum: f32 = self.weights.as_flattened().iter().map(|short| short.get()).sum();
        if !(0.99..=1.01).contains(&sum) {
            visitor.refuse();
        }
    }
}

impl StoredGrid {
    /// A grid before its first frame: zeros, which take less flash than weights.
    pub(crate) const fn empty() -> Self {
        Self { weights: [[Bf16::new(0.0); POSITIONS]; SPEEDS], travelled: [0.0; SPEEDS] }
    }

    /// Becomes [`PhaseGrid::uniform`], in place.
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    pub(crate) fn forget(&mut self) {
        self.weights.as_flattened_mut().fill(Bf16::new(1.0 / (POSITIONS * SPEEDS) as f32));
        self.travelled = [0.0; SPEEDS];
    }

    /// The grid with weights in `f32`.
    #[inline]
    pub(crate) fn load(&self) -> PhaseGrid {
        let mut grid = PhaseGrid::uniform();
        self.load_into(&mut grid);
        grid
    }

    /// The same, where it stays: one that is returned stands on the stack twice.
    #[inline]
    pub(crate) fn load_into(&self, grid: &mut PhaseGrid) {
        grid.travelled = self.travelled;
        for (weight, short) in grid.weights.as_flattened_mut().iter_mut().zip(self.weights.as_flattened()) {
            *weight = short.get();
        }
    }

    /// The mode with the largest weight; the grid is loaded in a frame of its own.
    #[inline(never)]
    pub(crate) fn mode(&self, model: &CoupledModel<'_>) -> PhaseMode {
        self.load().mode(model)
    }

    /// Weight by position alone; the grid is loaded in a frame of its own.
    #[inline(never)]
    pub(crate) fn by_position(&self) -> [f32; POSITIONS] {
        self.load().by_position()
    }

    /// Stores `grid`.
    #[inline]
    pub(crate) fn store(&mut self, grid: &PhaseGrid) {
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
    fn a_stored_grid_keeps_its_weights() {
        let mut stored = StoredGrid::empty();
        let grid = PhaseGrid::near(0.3);
        assert!(stored.load().weight_near(0.3) < 0.4);
        stored.store(&grid);
        assert!((stored.load().weight_near(0.3) - grid.weight_near(0.3)).abs() < 0.004);
        let once = stored;
        stored.store(&once.load());
        assert_eq!(stored, once, "what was rounded stays");
    }
}
