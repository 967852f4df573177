//! A picture as a grid of cells: where there is skin, how bright it is, and what is usual there.
//!
//! Lines of pixels come one after another, so that no picture is kept, and the lines of a camera
//! give what a whole picture gives.

use super::cells::{GridSize, MAX_CELLS, MAX_COLUMNS, MAX_ROWS};

/// Least change of a cell's mean brightness in two frames that is motion, levels. Chosen: a
/// webcam's noise is a tenth of it.
const MIN_CHANGE: u8 = 10;
/// A cell's skin is new for so many frames. Chosen: two thirds of a second.
const NEW_FRAMES: u8 = 18;
/// Skin that is gone is forgotten after so many frames more. Chosen: a hand passes in less.
const FORGOTTEN_FRAMES: u8 = 12;
/// Greatest difference from the usual brightness, levels. Chosen: shadows on a face are below.
const MAX_FROM_USUAL: u8 = 18;

/// Frames from which motion is known.
pub(super) const MAX_FRAMES: u8 = 3;
/// Greatest count of frames with skin.
pub(super) const MAX_SKIN_FRAMES: u8 = NEW_FRAMES + FORGOTTEN_FRAMES;

/// Bits of a row of cells, the first in the lowest.
type BitRow = u128;

/// The cells of the last frames.
///
/// ```
/// use sinew_core::vision::objects::grid::CellGrid;
///
/// // A picture of 160 x 120 pixels has cells of 2 x 2.
/// let mut grid = CellGrid::new(160, 120).expect("it has a size");
/// assert_eq!(grid.cell_px(), 2);
/// // The first eight pixels of each line are skin.
/// grid.begin();
/// for _ in 0..120 {
///     grid.add_line(&[0xff, 0, 0, 0, 0], &[100; 160], 1);
/// }
/// assert!(grid.is_skin(3) && !grid.is_skin(4));
/// ```
#[derive(Debug, Clone)]
pub struct CellGrid {
    size: GridSize,
    cell_px: usize,
    skin: [BitRow; MAX_ROWS],
    moving: [BitRow; MAX_ROWS],
    /// Mean brightness in the last frame and the one before.
    pub(super) brightness: [[u8; MAX_CELLS]; 2],
    /// Counts up in frames with skin, down in others.
    pub(super) skin_frames: [u8; MAX_CELLS],
    pub(super) usual_brightness: [u8; MAX_CELLS],
    /// Skin pixels and brightness of the row of cells that the lines are in.
    counts: [u16; MAX_COLUMNS],
    sums: [u32; MAX_COLUMNS],
    line: usize,
    /// Frames that were begun, up to [`MAX_FRAMES`].
    pub(super) frames: u8,
}

impl CellGrid {
    /// An empty grid for pictures of this size; `None` for one that is too
    /// narrow or low for a cell. Cells are as small as
    /// the grid's capacity lets them be; what is left of whole cells at the right and at the bottom
    /// is not seen.
    #[must_use]
    pub fn new(width_px: usize, height_px: usize) -> Option<Self> {
        let cell_px = width_px.div_ceil(MAX_COLUMNS).max(height_px.div_ceil(MAX_ROWS)).max(1);
        let size = GridSize { columns: width_px / cell_px, rows: height_px / cell_px };
        (size.cells() > 0).then_some(Self {
            size,
            cell_px,
            skin: [0; MAX_ROWS],
            moving: [0; MAX_ROWS],
            brightness: [[0; MAX_CELLS]; 2],
            skin_frames: [0; MAX_CELLS],
            usual_brightness: [0; MAX_CELLS],
            counts: [0; MAX_COLUMNS],
            sums: [0; MAX_COLUMNS],
            line: 0,
            frames: 0,
        })
    }

    /// Columns and rows.
    #[must_use]
    pub(super) const fn size(&self) -> GridSize {
        self.size
    }

    /// Side of a cell, pixels.
    #[must_use]
    pub const fn cell_px(&self) -> usize {
        self.cell_px
    }

    /// Begins a frame.
    pub fn begin(&mut self) {
        self.frames = (self.frames + 1).min(MAX_FRAMES);
        self.line = 0;
    }

    /// Takes a line: one bit of skin a pixel, the first in the lowest, and the brightness of every
    /// `step_px`-th pixel, 0 to 255. What is missing in a slice counts as no skin, and as black.
    pub fn add_line(&mut self, skin: &[u32], brightness: &[u8], step_px: usize) {
        let (row, in_cell) = (self.line / self.cell_px, self.line % self.cell_px);
        self.line += 1;
        if row >= self.size.rows {
            return;
        }
        if in_cell == 0 {
            self.counts.fill(0);
            self.sums.fill(0);
        }
        let samples = (self.cell_px / step_px.max(1)).max(1);
        let mut levels = brightness.chunks(samples);
        for (column, (count, sum)) in self.counts.iter_mut().zip(&mut self.sums).enumerate().take(self.size.columns) {
            *count += ones(skin, column * self.cell_px, self.cell_px);
            *sum += levels.next().unwrap_or(&[]).iter().map(|level| u32::from(*level)).sum::<u32>();
        }
        if in_cell + 1 == self.cell_px {
            self.finish_row(row, (samples * self.cell_px) as u32);
        }
    }

    fn finish_row(&mut self, row: usize, samples: u32) {
        let half = self.cell_px * self.cell_px;
        let (mut skin, mut moving) = (0, 0);
        for (column, (count, sum)) in self.counts.iter().zip(&self.sums).enumerate().take(self.size.columns) {
            let cell = row * self.size.columns + column;
            let (is_skin, level) = (2 * usize::from(*count) >= half, (sum / samples) as u8);
            let [last, before] = self.brightness.each_mut().map(|levels| &mut levels[cell]);
            let is_moving = self.frames == MAX_FRAMES && before.abs_diff(level) > MIN_CHANGE;
            (*before, *last) = (*last, level);
            skin |= BitRow::from(is_skin) << column;
            moving |= BitRow::from(is_moving) << column;
            let (frames, usual) = (&mut self.skin_frames[cell], &mut self.usual_brightness[cell]);
            if self.frames <= 1 {
                *frames = if is_skin { MAX_SKIN_FRAMES } else { 0 };
                *usual = level;
                continue;
            }
            *frames = if is_skin { (*frames + 1).min(MAX_SKIN_FRAMES) } else { frames.saturating_sub(1) };
            // What is near is followed at once, what is far only slowly.
            let step = usual.abs_diff(level);
            let step = if step > MAX_FROM_USUAL { 1 } else { step.div_ceil(4) };
            *usual = if level > *usual { *usual + step } else { *usual - step };
        }
        (self.skin[row], self.moving[row]) = (skin, moving);
    }

    fn bit(&self, rows: &[BitRow; MAX_ROWS], cell: usize) -> bool {
        let (column, row) = self.size.place(cell);
        rows.get(row).is_some_and(|bits| bits >> column & 1 == 1)
    }

    /// Whether half of a cell or more is skin.
    #[must_use]
    pub fn is_skin(&self, cell: usize) -> bool {
        self.bit(&self.skin, cell)
    }

    /// Whether the brightness of a cell changed within the last frames.
    #[must_use]
    pub fn is_moving(&self, cell: usize) -> bool {
        self.bit(&self.moving, cell)
    }

    /// Whether a cell has skin that was not there before.
    #[must_use]
    pub fn is_new(&self, cell: usize) -> bool {
        self.is_skin(cell) && self.skin_frames[cell] < NEW_FRAMES
    }

    /// Whether a cell is far from its usual brightness.
    #[must_use]
    pub fn is_unusual(&self, cell: usize) -> bool {
        self.usual_brightness[cell].abs_diff(self.brightness[0][cell]) > MAX_FROM_USUAL
    }
}

/// Number of ones among `count` bits from bit `first`.
fn ones(words: &[u32], first: usize, count: usize) -> u16 {
    let mut found = 0;
    let mut bit = first;
    while bit < first + count {
        let in_word = (32 - bit % 32).min(first + count - bit);
        let word = words.get(bit / 32).map_or(0, |word| word >> (bit % 32));
        found += (word & (u32::MAX >> (32 - in_word))).count_ones() as u16;
        bit += in_word;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A frame of 80 x 60 pixels, each a cell.
    fn show(grid: &mut CellGrid, skin: impl Fn(usize, usize) -> bool, level: impl Fn(usize, usize) -> u8) {
        grid.begin();
        for row in 0..60 {
            let mut bits = [0; 3];
            (0..80).filter(|column| skin(*column, row)).for_each(|column| bits[column / 32] |= 1 << (column % 32));
            let levels: [u8; 80] = core::array::from_fn(|column| level(column, row));
            grid.add_line(&bits, &levels, 1);
        }
    }

    #[test]
    fn skin_is_new_for_a_while_and_then_usual() {
        let mut grid = CellGrid::new(80, 60).unwrap();
        show(&mut grid, |column, _| column < 10, |_, _| 100);
        assert!(grid.is_skin(5) && !grid.is_new(5), "it was there at the start");
        for frame in 0..40 {
            show(&mut grid, |column, _| column < 20, |_, _| 100);
            assert_eq!(grid.is_new(15), frame + 1 < NEW_FRAMES, "frame {frame}");
        }
        for _ in 0..15 {
            show(&mut grid, |column, _| column < 10, |_, _| 100);
        }
        show(&mut grid, |column, _| column < 20, |_, _| 100);
        assert!(grid.is_new(15), "it was gone");
    }

    #[test]
    fn motion_is_a_change_over_two_frames() {
        let mut grid = CellGrid::new(80, 60).unwrap();
        for level in [100, 108, 116, 116, 116] {
            show(&mut grid, |_, _| false, |column, _| if column == 3 { level } else { 50 });
            let is_first = level < 116;
            assert!(!grid.is_moving(4) && (!is_first || !grid.is_moving(3)));
        }
        assert!(!grid.is_moving(3));
        show(&mut grid, |_, _| false, |column, _| if column == 3 { 90 } else { 50 });
        assert!(grid.is_moving(3));
    }

    #[test]
    fn what_is_unusual_becomes_usual_slowly() {
        let mut grid = CellGrid::new(80, 60).unwrap();
        show(&mut grid, |_, _| false, |_, _| 100);
        let mut frames = 0;
        loop {
            show(&mut grid, |_, _| false, |_, _| 160);
            if !grid.is_unusual(7) {
                break;
            }
            frames += 1;
        }
        assert!((30..60).contains(&frames), "{frames}");
    }

    #[test]
    fn any_picture_has_a_grid_that_fits() {
        for (width, height) in [(1, 1), (640, 480), (480, 640), (4000, 60), (140, 8192), (81, 61)] {
            let mut grid = CellGrid::new(width, height).unwrap();
            assert!(grid.size().columns <= MAX_COLUMNS && grid.size().rows <= MAX_ROWS);
            for _ in 0..2 * height {
                grid.add_line(&[u32::MAX], &[7], 2);
            }
        }
        assert!(CellGrid::new(0, 10).is_none() && CellGrid::new(4000, 30).is_none(), "no whole cell");
    }

    #[test]
    fn ones_are_counted_across_words() {
        assert_eq!(ones(&[0xffff_0000, 0xff], 30, 8), 8);
        assert_eq!(ones(&[0xffff_0000, 0xff], 12, 8), 4);
        assert_eq!(ones(&[0xffff_0000, 0xff], 60, 8), 0);
    }
}
