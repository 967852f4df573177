//! Objects on a grid: cells that hang together, by their corners, too.
//!
//! Two passes with a table of equal labels: Rosenfeld and Pfaltz, "Sequential operations in digital
//! picture processing", Journal of the ACM 13, 1966.

use super::cells::GridSize;

/// Labels run from 1 to this; what needs more is noise and gets none.
pub(super) const MAX_LABELS: usize = 255;

/// Labels the cells for which `inside` holds; all others get 0. Returns the greatest label that was
/// given; some labels below it may have no cell.
#[inline(never)]
pub(super) fn label(size: GridSize, inside: impl Fn(usize) -> bool, labels: &mut [u8]) -> u8 {
    let mut parents: [u8; MAX_LABELS + 1] = core::array::from_fn(|label| label as u8);
    let mut used = 0_u8;
    for cell in 0..size.cells().min(labels.len()) {
        labels[cell] = 0;
        if !inside(cell) {
            continue;
        }
        for neighbour in neighbours_before(size, cell).into_iter().flatten() {
            let (mine, theirs) = (root(&parents, labels[cell]), root(&parents, labels[neighbour]));
            labels[cell] = if mine == 0 || theirs == 0 { mine.max(theirs) } else { mine.min(theirs) };
            if mine != 0 && theirs != 0 {
                parents[usize::from(mine.max(theirs))] = mine.min(theirs);
            }
        }
        if labels[cell] == 0 && usize::from(used) < MAX_LABELS {
            used += 1;
            labels[cell] = used;
        }
    }
    for label in labels.iter_mut().take(size.cells()) {
        *label = root(&parents, *label);
    }
    used
}

/// The least of the labels that are equal to `label`. Each parent is less than its child.
fn root(parents: &[u8; MAX_LABELS + 1], mut label: u8) -> u8 {
    while parents[usize::from(label)] != label {
        label = parents[usize::from(label)];
    }
    label
}

/// The neighbours that come before a cell.
fn neighbours_before(size: GridSize, cell: usize) -> [Option<usize>; 4] {
    let (column, row) = size.place(cell);
    let (left, right, above) = (column > 0, column + 1 < size.columns, row > 0);
    let next = cell.wrapping_sub(size.columns);
    [
        left.then(|| cell - 1),
        (above && left).then(|| next - 1),
        above.then_some(next),
        (above && right).then(|| next + 1),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Against a flood from each cell.
        #[test]
        fn cells_have_one_label_exactly_if_they_hang_together(
            cells in proptest::collection::vec(any::<bool>(), 60), columns in 3_usize..12,
        ) {
            let size = GridSize { columns, rows: 60 / columns };
            let mut labels = [0; 60];
            label(size, |cell| cells[cell], &mut labels);
            for start in (0..size.cells()).filter(|cell| cells[*cell]) {
                let mut reached = [false; 60];
                let mut open = vec![start];
                while let Some(cell) = open.pop() {
                    if core::mem::replace(&mut reached[cell], true) {
                        continue;
                    }
                    let (column, row) = size.place(cell);
                    open.extend((0..size.cells()).filter(|other| {
                        let (c, r) = size.place(*other);
                        cells[*other] && c.abs_diff(column) <= 1 && r.abs_diff(row) <= 1
                    }));
                }
                for other in (0..size.cells()).filter(|cell| cells[*cell]) {
                    prop_assert_eq!(labels[other] == labels[start], reached[other]);
                }
            }
        }
    }

    #[test]
    fn too_many_objects_leave_the_last_ones_without_a_label() {
        let size = GridSize { columns: 40, rows: 40 };
        let mut labels = [0; 1600];
        let is_alone = |cell: usize| cell.is_multiple_of(2) && (cell / 40).is_multiple_of(2);
        assert_eq!(usize::from(label(size, is_alone, &mut labels)), MAX_LABELS);
        assert_eq!(labels.iter().filter(|label| **label > 0).count(), MAX_LABELS);
    }
}
