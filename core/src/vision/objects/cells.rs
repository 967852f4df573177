//! Places in a grid of cells, and boxes of it.

use core::ops::Range;

/// Size of a grid, cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct GridSize {
    /// Columns.
    pub columns: usize,
    /// Rows.
    pub rows: usize,
}

impl GridSize {
    /// Number of cells.
    #[must_use]
    pub const fn cells(self) -> usize {
        self.columns * self.rows
    }

    /// Column and row of a cell.
    #[must_use]
    pub const fn place(self, cell: usize) -> (usize, usize) {
        (cell % self.columns, cell / self.columns)
    }
}

/// A part of a grid.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct CellBox {
    /// Columns.
    pub columns: Range<usize>,
    /// Rows.
    pub rows: Range<usize>,
}

impl CellBox {
    /// All of a grid.
    #[must_use]
    pub const fn whole(size: GridSize) -> Self {
        Self { columns: 0..size.columns, rows: 0..size.rows }
    }

    /// Its cells, row by row.
    pub fn cells(&self, size: GridSize) -> impl DoubleEndedIterator<Item = usize> + use<> {
        let columns = self.columns.clone();
        self.rows.clone().flat_map(move |row| columns.clone().map(move |column| row * size.columns + column))
    }
}
