//! A component drawn on a small grid of cells, 128 cells a row, on which its shape is measured.

use super::components::{Component, crofton_perimeter};
use super::distance::{CellRow, DistanceRow, MAX_COLUMNS, interior};
use super::runs::RunPool;
use crate::camera::Pixel;

/// Rows of a grid.
pub const MAX_ROWS: usize = MAX_COLUMNS;
/// Longest side of a component on the grid, cells.
///
/// Chosen: bounds the work for a blob; the rest of the grid is padding for the disc that fills
/// gaps.
pub const MAX_CELLS: usize = 80;
/// Free cells that fit around it on every side.
pub const MAX_PADDING: usize = (MAX_COLUMNS - MAX_CELLS) / 2;

/// Cells that are set or not, each standing for a square of whole pixels.
#[derive(Debug, Clone)]
pub struct CellGrid {
    rows: [CellRow; MAX_ROWS],
    row_count: usize,
    columns: usize,
    padding: usize,
    /// Side of a cell, pixels.
    step: u32,
    /// Corner of the first cell that is not padding.
    corner: (u16, u16),
}

impl CellGrid {
    /// A grid without cells.
    pub const EMPTY: Self = Self { rows: [0; MAX_ROWS], row_count: 0, columns: 0, padding: 0, step: 1, corner: (0, 0) };

    /// Draws a component at the smallest whole step at which it fits. A cell is set when at least
    /// half of its pixels are; if none would be, when any is.
    pub fn draw(&mut self, component: &Component, pool: &RunPool<'_>) {
        let bounds = component.bounding_box();
        let step = bounds.width_px().max(bounds.height_px()).div_ceil(MAX_CELLS as u32).max(1);
        self.rows = [0; MAX_ROWS];
        self.step = step;
        self.padding = 0;
        self.corner = (bounds.min_u, bounds.min_v);
        self.columns = bounds.width_px().div_ceil(step) as usize;
        self.row_count = bounds.height_px().div_ceil(step) as usize;
        if step == 1 {
            for run in component.runs(pool) {
                let (u, v) = (run.start.saturating_sub(bounds.min_u), run.row.saturating_sub(bounds.min_v));
                if let Some(row) = self.rows.get_mut(usize::from(v)) {
                    *row |= below(run.end.saturating_sub(bounds.min_u).into()) & !below(u.into());
                }
            }
            return;
        }
        let mut pixels = [[0_u16; MAX_CELLS]; MAX_CELLS];
        for run in component.runs(pool) {
            let v = u32::from(run.row.saturating_sub(bounds.min_v)) / step;
            let Some(line) = pixels.get_mut(v as usize) else { continue };
            let (mut u, end) = (u32::from(run.start - bounds.min_u), u32::from(run.end - bounds.min_u));
            while u < end {
                let next = end.min((u / step + 1) * step);
                if let Some(cell) = line.get_mut((u / step) as usize) {
                    *cell = cell.saturating_add((next - u) as u16);
                }
                u = next;
            }
        }
        let half = (step * step).div_ceil(2);
        self.set_where(&pixels, half);
        if self.count() == 0 {
            self.set_where(&pixels, 1);
        }
    }

    fn set_where(&mut self, pixels: &[[u16; MAX_CELLS]; MAX_CELLS], least: u32) {
        for (row, line) in self.rows.iter_mut().zip(pixels) {
            let cells = line.iter().enumerate();
            *row = cells.fold(0, |row, (u, &n)| row | CellRow::from(u32::from(n) >= least) << u);
        }
    }

    /// The same cells with `padding` unset cells around them (at most [`MAX_PADDING`]).
    #[must_use]
    pub fn padded(&self, padding: usize) -> Self {
        let padding = padding.min(MAX_PADDING);
        let mut grid = Self { rows: [0; MAX_ROWS], padding, ..*self };
        grid.columns = (self.columns + 2 * padding).min(MAX_COLUMNS);
        grid.row_count = (self.row_count + 2 * padding).min(MAX_ROWS);
        for (to, from) in grid.rows[padding..].iter_mut().zip(&self.rows[..self.row_count]) {
            *to = from << padding;
        }
        grid
    }

    /// Keeps just the cells where the condition on the distance holds.
    pub fn keep(&mut self, distances: &[DistanceRow], holds: impl Fn(i16) -> bool) {
        let columns = below(self.columns as u32);
        let count = self.row_count.min(MAX_ROWS);
        for (row, line) in self.rows[..count].iter_mut().zip(distances) {
            let parts = interior(line).as_chunks::<32>().0.iter().map(|part| {
                let mut bits = [0_u32; 32];
                for (i, (bit, &d)) in bits.iter_mut().zip(part).enumerate() {
                    *bit = u32::from(holds(d)) << i;
                }
                bits.iter().fold(0, |word, bit| word | bit)
            });
            *row = parts.rev().fold(0, |row, part| row << 32 | CellRow::from(part)) & columns;
        }
    }

    /// Sets the cells that are set in `other`, the same grid without padding.
    pub fn add(&mut self, other: &Self) {
        for (to, from) in self.rows[self.padding..].iter_mut().zip(other.rows()) {
            *to |= from << self.padding;
        }
    }

    /// The rows in use.
    #[must_use]
    pub fn rows(&self) -> &[CellRow] {
        &self.rows[..self.row_count.min(MAX_ROWS)]
    }

    /// The columns in use.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Side of a cell, pixels.
    #[must_use]
    pub fn step_px(&self) -> f32 {
        self.step as f32
    }

    /// Number of set cells.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.rows().iter().map(|row| row.count_ones()).sum()
    }

    /// Middle of a cell.
    #[must_use]
    pub fn pixel_of(&self, u: usize, v: usize) -> Pixel {
        let half = 0.5 * (self.step_px() - 1.0);
        let place =
            |corner: u16, cell: usize| f32::from(corner) + half + (cell as f32 - self.padding as f32) * self.step_px();
        Pixel::new(place(self.corner.0, u), place(self.corner.1, v))
    }

    /// Column and row of a point, in cells, whole numbers at the cells' middles.
    #[must_use]
    pub fn cell_of(&self, pixel: Pixel) -> (f32, f32) {
        let first = self.pixel_of(0, 0);
        ((pixel.u_px - first.u_px) / self.step_px(), (pixel.v_px - first.v_px) / self.step_px())
    }

    /// Area (square pixels), perimeter (pixels) and centroid of the set cells.
    #[must_use]
    pub fn outline(&self) -> (f32, f32, Pixel) {
        let (mut runs, mut pairs, mut sum_u, mut sum_v) = (0, [0; 3], 0_u32, 0_u32);
        let mut above = 0;
        for (v, &row) in self.rows().iter().enumerate() {
            let starts = row & !(row << 1);
            runs += starts.count_ones();
            for (pair, shifted) in pairs.iter_mut().zip([above >> 1, above, above << 1]) {
                *pair += (row & shifted).count_ones();
            }
            sum_v += v as u32 * row.count_ones();
            sum_u += column_sum(row);
            above = row;
        }
        let count = self.count();
        let n = count.max(1) as f32;
        let (origin, step) = (self.pixel_of(0, 0), self.step_px());
        let centroid = Pixel::new(origin.u_px + step * sum_u as f32 / n, origin.v_px + step * sum_v as f32 / n);
        (count as f32 * step * step, crofton_perimeter(count, runs, pairs) * step, centroid)
    }
}

/// Sum of the columns of the set cells.
fn column_sum(row: CellRow) -> u32 {
    let (mut rest, mut sum) = (row, 0);
    while rest != 0 {
        let start = rest.trailing_zeros();
        let end = start + (rest >> start).trailing_ones();
        sum += (end - start) * (start + end - 1) / 2;
        rest &= !below(end);
    }
    sum
}

fn below(column: u32) -> CellRow {
    1_u128.checked_shl(column).map_or(u128::MAX, |bit| bit - 1)
}
