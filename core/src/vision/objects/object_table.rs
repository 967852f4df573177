//! Size and box of each object of a labelled grid, in a table that lies in working memory.

use super::cells::{CellBox, GridSize};

/// Numbers of an object in the table.
const NUMBERS: usize = 4;

/// Cells that hang together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Object {
    pub label: u8,
    /// Number of its cells.
    pub cells: u16,
    /// The first of them.
    pub first: u16,
    /// First and last column, first and last row.
    columns: [u8; 2],
    rows: [u8; 2],
}

impl Object {
    /// The part of the grid around it.
    pub fn within(&self) -> CellBox {
        let [columns, rows] = [self.columns, self.rows].map(|[first, last]| usize::from(first)..usize::from(last) + 1);
        CellBox { columns, rows }
    }
}

/// Measures the objects of the grid into `table`; labels for which it has no room are left out.
pub(super) fn measure(size: GridSize, labels: &[u8], table: &mut [u16]) {
    table.fill(0);
    let (entries, _) = table.as_chunks_mut::<NUMBERS>();
    for (cell, label) in labels.iter().enumerate().take(size.cells()).filter(|(_, label)| **label != 0) {
        let Some([cells, first, columns, rows]) = entries.get_mut(usize::from(*label)) else { continue };
        let (column, row) = size.place(cell);
        let widened = |range: u16, at: u8| {
            let [low, high] = range.to_le_bytes();
            u16::from_le_bytes([low.min(at), high.max(at)])
        };
        if *cells == 0 {
            (*first, *columns, *rows) = (cell as u16, 0xff, 0xff);
        }
        *cells += 1;
        (*columns, *rows) = (widened(*columns, column as u8), widened(*rows, row as u8));
    }
}

/// The objects with labels up to `count`, in their order.
pub(super) fn measured(count: u8, table: &[u16]) -> impl Iterator<Item = Object> {
    let entries = table.as_chunks::<NUMBERS>().0.iter().zip(0..=count);
    entries.filter(|([cells, ..], _)| *cells > 0).map(|([cells, first, columns, rows], label)| Object {
        label,
        cells: *cells,
        first: *first,
        columns: columns.to_le_bytes(),
        rows: rows.to_le_bytes(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn objects_have_their_cells_and_box() {
        let size = GridSize { columns: 5, rows: 3 };
        let labels = [
            0, 1, 1, 0, 0, //
            0, 0, 1, 0, 3, //
            0, 0, 0, 3, 3,
        ];
        let mut table = [7; 17];
        measure(size, &labels, &mut table);
        let found: Vec<Object> = measured(3, &table).collect();
        let boxes: Vec<CellBox> = found.iter().map(Object::within).collect();
        assert_eq!(
            found.iter().map(|object| (object.label, object.cells, object.first)).collect::<Vec<_>>(),
            [(1, 3, 1), (3, 3, 9)]
        );
        assert_eq!(boxes, [CellBox { columns: 1..3, rows: 0..2 }, CellBox { columns: 3..5, rows: 1..3 }]);
        measure(size, &labels, &mut table[..8]);
        assert_eq!(measured(3, &table[..8]).count(), 1, "no room for the second");
    }
}
