//! Distances along the inside of an object, on a grid of cells.
//!
//! Steps to the four neighbours cost [`STRAIGHT`], to the diagonal ones [`DIAGONAL`]; sweeps in
//! opposite directions spread them until nothing changes: Borgefors, "Distance transformations in
//! digital images", Computer Vision, Graphics, and Image Processing 34, 1986, the 5-7 chamfer.

use super::cells::{CellBox, GridSize};

/// Cost of a step to one of the four neighbours.
pub(super) const STRAIGHT: u8 = 5;
/// Cost of a diagonal step.
pub(super) const DIAGONAL: u8 = 7;

/// A distance that is kept for each cell: of 16 bits along an object, of 8 across it.
pub(super) trait Length: Copy + Ord {
    /// No distance.
    const ZERO: Self;
    /// Distance of cells that are not reached, the greatest.
    const UNREACHED: Self;

    /// A step further, at most as far as what is not reached.
    fn after(self, step: u8) -> Self;
}

impl Length for u16 {
    const ZERO: Self = 0;
    const UNREACHED: Self = Self::MAX;

    fn after(self, step: u8) -> Self {
        self.saturating_add(Self::from(step))
    }
}

impl Length for u8 {
    const ZERO: Self = 0;
    const UNREACHED: Self = Self::MAX;

    fn after(self, step: u8) -> Self {
        self.saturating_add(step)
    }
}

/// Most pairs of sweeps. Chosen: a bent arm takes three; of a spiral the inner part stays
/// unreached.
const MAX_SWEEPS: usize = 8;

/// Distances from `start` to all cells of `within` for which `inside` holds and that hang together
/// with it. Cells outside of `within` keep what they have.
///
/// `distances` has a number for each cell of the grid.
pub(super) fn distances<L: Length>(
    size: GridSize,
    within: &CellBox,
    inside: impl Fn(usize) -> bool,
    start: usize,
    distances: &mut [L],
) {
    for cell in within.cells(size) {
        distances[cell] = if cell == start { L::ZERO } else { L::UNREACHED };
    }
    spread(size, within, inside, distances);
}

/// Lowers the distances of the cells for which `inside` holds by what their neighbours allow.
#[inline(never)]
pub(super) fn spread<L: Length>(size: GridSize, within: &CellBox, inside: impl Fn(usize) -> bool, distances: &mut [L]) {
    for _ in 0..MAX_SWEEPS {
        let mut has_changed = false;
        for cell in within.cells(size).filter(|cell| inside(*cell)) {
            has_changed |= lower(size, within, cell, false, distances);
        }
        for cell in within.cells(size).rev().filter(|cell| inside(*cell)) {
            has_changed |= lower(size, within, cell, true, distances);
        }
        if !has_changed {
            return;
        }
    }
}

/// Lowers one distance by the four neighbours that a sweep has passed; whether it became shorter.
fn lower<L: Length>(size: GridSize, within: &CellBox, cell: usize, is_backward: bool, distances: &mut [L]) -> bool {
    let (column, row) = size.place(cell);
    let old = distances[cell];
    let mut best = old;
    let mut pass = |is_there: bool, neighbour: usize, cost: u8| {
        if is_there {
            best = best.min(distances[neighbour].after(cost));
        }
    };
    let (left, right) = (column > within.columns.start, column + 1 < within.columns.end);
    if is_backward {
        let below = row + 1 < within.rows.end;
        let next = cell + size.columns;
        pass(right, cell + 1, STRAIGHT);
        pass(below, next, STRAIGHT);
        pass(below && left, next.wrapping_sub(1), DIAGONAL);
        pass(below && right, next + 1, DIAGONAL);
    } else {
        let above = row > within.rows.start;
        let next = cell.wrapping_sub(size.columns);
        pass(left, cell.wrapping_sub(1), STRAIGHT);
        pass(above, next, STRAIGHT);
        pass(above && left, next.wrapping_sub(1), DIAGONAL);
        pass(above && right, next.wrapping_add(1), DIAGONAL);
    }
    distances[cell] = best;
    best < old
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNREACHED: u16 = <u16 as Length>::UNREACHED;
    const SIZE: GridSize = GridSize { columns: 8, rows: 5 };

    fn of(picture: &str, start: usize) -> [u16; 40] {
        let cells: Vec<bool> = picture.bytes().filter(|byte| *byte != b' ').map(|byte| byte == b'#').collect();
        let mut found = [0; 40];
        distances(SIZE, &CellBox::whole(SIZE), |cell| cells[cell], start, &mut found);
        found
    }

    #[test]
    fn the_way_goes_round_what_is_outside() {
        let found = of("######## ........ ######## #....... ########", 0);
        assert_eq!(found[7], u16::from(7 * STRAIGHT));
        assert_eq!(found[16], UNREACHED, "a row apart");
        let found = of("######## .......# ######## #....... ########", 0);
        assert_eq!(found[15], u16::from(6 * STRAIGHT + DIAGONAL));
        // Two turns of two diagonals each, and what is straight between.
        assert_eq!(found[39], u16::from(6 * STRAIGHT + 2 * DIAGONAL + 5 * STRAIGHT + 2 * DIAGONAL + 6 * STRAIGHT));
    }

    #[test]
    fn a_diagonal_is_as_long_as_it_is() {
        let found = of("######## ######## ######## ######## ########", 0);
        assert_eq!(found[4 * 8 + 4], u16::from(4 * DIAGONAL));
        assert_eq!(found[8 + 7], u16::from(DIAGONAL + 6 * STRAIGHT));
    }

    #[test]
    fn cells_beside_the_box_keep_what_they_have() {
        let mut found = [9; 40];
        distances(SIZE, &CellBox { columns: 2..5, rows: 1..3 }, |_| true, 10, &mut found);
        assert_eq!((found[10], found[12], found[18]), (0, 2 * STRAIGHT, STRAIGHT));
        assert_eq!((found[9], found[13], found[2], found[26]), (9, 9, 9, 9));
    }
}
