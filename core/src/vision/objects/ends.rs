//! Both ends of an elongated object, along its inside: an arm has its hand at one of them.

use super::cells::{CellBox, GridSize};
use super::geodesic::{Length, STRAIGHT, distances};
use crate::math::max;

/// Length of a hand, widths of the face. Cells within it of an end belong to the end.
pub(super) const HAND_LENGTH: f32 = 0.8;

/// Both ends of an object.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ends {
    /// Middles of the cells at each end, cells.
    pub(super) places: [[f32; 2]; 2],
    /// Length of the object along its inside, cells.
    pub(super) length: f32,
}

/// Finds the ends of the object of which `start` is a cell. A face is `width` cells wide; `scratch`
/// has a number for each cell of the grid.
///
/// The cell that is farthest from any cell is one end, the cell that is farthest from it the other.
pub(super) fn ends(
    size: GridSize,
    within: &CellBox,
    inside: impl Fn(usize) -> bool,
    (start, width): (usize, f32),
    scratch: &mut [u16],
) -> Ends {
    let near = (HAND_LENGTH * width * f32::from(STRAIGHT)) as u16;
    let middle = |distances: &[u16]| {
        let (mut count, mut sum) = (0.0_f32, [0.0; 2]);
        for cell in within.cells(size).filter(|cell| inside(*cell) && distances[*cell] <= near) {
            let (column, row) = size.place(cell);
            count += 1.0;
            sum = [sum[0] + column as f32 + 0.5, sum[1] + row as f32 + 0.5];
        }
        sum.map(|sum| sum / max(count, 1.0))
    };
    distances(size, within, &inside, start, scratch);
    let first = farthest(size, within, &inside, scratch);
    distances(size, within, &inside, first, scratch);
    let second = farthest(size, within, &inside, scratch);
    let length = f32::from(scratch[second]) / f32::from(STRAIGHT);
    let at_first = middle(scratch);
    distances(size, within, &inside, second, scratch);
    let at_second = middle(scratch);
    Ends { places: [at_first, at_second], length }
}

fn farthest(size: GridSize, within: &CellBox, inside: impl Fn(usize) -> bool, distances: &[u16]) -> usize {
    let mut best = (0, None);
    for cell in within.cells(size).filter(|cell| inside(*cell) && distances[*cell] != u16::UNREACHED) {
        if best.1.is_none_or(|most| distances[cell] > most) {
            best = (cell, Some(distances[cell]));
        }
    }
    best.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_a_bent_arm_are_found_from_anywhere() {
        let size = GridSize { columns: 30, rows: 20 };
        // Down from the upper left, then to the right.
        let inside = |cell: usize| {
            let (column, row) = size.place(cell);
            (2..5).contains(&column) && row < 18 || (15..18).contains(&row) && (2..28).contains(&column)
        };
        let mut scratch = [0; 600];
        for start in [3, 16 * 30 + 10, 16 * 30 + 27] {
            let within = CellBox { columns: 2..28, rows: 0..18 };
            let found = ends(size, &within, inside, (start, 5.0), &mut scratch);
            assert!((35.0..45.0).contains(&found.length), "{found:?}");
            let upper = usize::from(found.places[0][1] > found.places[1][1]);
            let (a, b) = (found.places[upper], found.places[1 - upper]);
            assert!((a[0] - 3.5).abs() < 0.6 && a[1] < 3.0, "{a:?}");
            assert!((b[1] - 16.5).abs() < 0.6 && b[0] > 25.0, "{b:?}");
        }
    }
}
