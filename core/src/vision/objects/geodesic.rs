//! Distances along the inside of an object, on a grid of cells.
//!
//! Steps to the four neighbours cost [`STRAIGHT`], to the diagonal ones [`DIAGONAL`]; sweeps in
//! opposite directions spread them until nothing changes: Borgefors, "Distance transformations in
//! digital images", Computer Vision, Graphics, and Image Processing 34, 1986, the 5-7 chamfer.

use super::cells::{CellBox, GridSize};

/// Cost of a step to one of the four neighbours.
pub(super) const STRAIGHT: u16 = 5;
/// Cost of a diagonal step.
pub(super) const DIAGONAL: u16 = 7;
/// Distance of cells that are not reached.
pub(super) const UNREACHED: u16 = u16::MAX;
/// Most pairs of sweeps. Chosen: a bent arm takes three; of a spiral the inner part stays
/// unreached.
const MAX_SWEEPS: usize = 8;

/// Distances from `start` to all cells of `within` for which `inside` holds and that hang together
/// with it; cells outside of `within` keep what they have.
///
/// `distances` has a number for each cell of the grid.
pub(super) fn distances(
    size: GridSize,
    within: &CellBox,
    inside: impl Fn(usize) -> bool,
    start: usize,
    distances: &mut [u16],
) {
    for cell in within.cells(size) {
        distances[cell] = if cell == start { 0 } else { UNREACHED };
    }
    spread(size, within, inside, distances);
}

/// Lowers the distances of the cells for which `inside` holds by what their neighbours allow.
pub(super) fn spread(size: GridSize, within: &CellBox, inside: impl Fn(usize) -> bool, distances: &mut [u16]) {
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
fn lower(size: GridSize, within: &CellBox, cell: usize, is_backward: bool, distances: &mut [u16]) -> bool {
    let (column, row) = size.place(cell);
    let old = distances[cell];
    let mut best = old;
    let mut pass = |is_there: bool, neighbour: usize, cost: u16| {
        if is_there {
            best = best.min(distances[neighbour].saturating_add(cost));
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
        assert_eq!(found[7], 7 * STRAIGHT);
        assert_eq!(found[16], UNREACHED, "a row apart");
        let found = of("######## .......# ######## #....... ########", 0);
        assert_eq!(found[15], 6 * STRAIGHT + DIAGONAL);
        // Two turns of two diagonals each, and what is straight between.
        assert_eq!(found[39], 6 * STRAIGHT + 2 * DIAGONAL + 5 * STRAIGHT + 2 * DIAGONAL + 6 * STRAIGHT);
    }

    #[test]
    fn a_diagonal_is_as_long_as_it_is() {
        let found = of("######## ######## ######## ######## ########", 0);
        assert_eq!(found[4 * 8 + 4], 4 * DIAGONAL);
        assert_eq!(found[8 + 7], DIAGONAL + 6 * STRAIGHT);
    }

    #[test]
    fn cells_beside_the_box_keep_what_they_have() {
        let mut found = [9; 40];
        distances(SIZE, &CellBox { columns: 2..5, rows: 1..3 }, |_| true, 10, &mut found);
        assert_eq!((found[10], found[12], found[18]), (0, 2 * STRAIGHT, STRAIGHT));
        assert_eq!((found[9], found[13], found[2], found[26]), (9, 9, 9, 9));
    }
}
