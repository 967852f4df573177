//! Cells of a picture: a grid that is small enough for any device, and boxes of it.

use core::ops::Range;

/// Most columns of a grid.
pub const MAX_COLUMNS: usize = 80;
/// Most rows of a grid.
pub const MAX_ROWS: usize = 60;
/// Most cells of a grid.
pub const MAX_CELLS: usize = MAX_COLUMNS * MAX_ROWS;

/// Size of a grid, cells.
///
/// ```
/// use sinew_core::vision::objects::cells::GridSize;
///
/// assert_eq!(GridSize { columns: 80, rows: 60 }.place(161), (1, 2));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GridSize {
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
///
/// ```
/// use sinew_core::vision::objects::cells::{CellBox, GridSize};
///
/// let size = GridSize { columns: 8, rows: 5 };
/// let cells: Vec<usize> = CellBox { columns: 6..8, rows: 1..3 }.cells(size).collect();
/// assert_eq!(cells, [14, 15, 22, 23]);
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CellBox {
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
