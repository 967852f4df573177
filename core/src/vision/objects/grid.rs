//! A picture as a grid of cells: where there is skin, how bright it is, and what is usual there.
//!
//! Lines of pixels come one after another, so that no picture is kept, and the lines of a camera
//! give what a whole picture gives.

use super::cells::GridSize;

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

/// The cells of the last frames, at most `COLUMNS` x `ROWS`: 80 x 60 for a computer, 40 x 30 for a
/// camera of 320 x 240 pixels.
///
/// ```
/// use sinew_core::vision::objects::grid::CellGrid;
///
/// // A picture of 160 x 120 pixels has cells of 2 x 2.
/// let mut grid = CellGrid::<80, 60>::new(160, 120).expect("it has a size");
/// assert_eq!(grid.cell_px(), 2);
/// // The first eight pixels of each line are skin.
/// grid.begin();
/// for line in 0..120 {
///     grid.line(line, &[0xff, 0, 0, 0, 0], &[100; 160], 1);
/// }
/// grid.end();
/// assert!(grid.is_skin(3) && !grid.is_skin(4));
/// ```
#[derive(Debug, Clone)]
pub struct CellGrid<const COLUMNS: usize, const ROWS: usize> {
    size: GridSize,
    cell_px: usize,
    pub(super) cells: [[Cell; COLUMNS]; ROWS],
    /// Skin pixels and brightness of the row of cells that the lines are in.
    counts: [u16; COLUMNS],
    sums: [u32; COLUMNS],
    /// That row, with the number of its lines and of the samples of brightness in each cell.
    row: usize,
    lines: usize,
    samples: usize,
    /// Frames that were begun, up to [`MAX_FRAMES`].
    pub(super) frames: u8,
}

/// What is kept of a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cell {
    /// Mean brightness in the last frame and the one before.
    brightness: [u8; 2],
    usual_brightness: u8,
    /// Counts up in frames with skin, down in others; with [`SKIN`] and [`MOVING`].
    skin: u8,
}

/// Bit of a cell that is skin.
const SKIN: u8 = 0x80;
/// Bit of a cell whose brightness changed.
const MOVING: u8 = 0x40;
/// Bits of the count of frames.
const COUNT: u8 = 0x3f;

impl Cell {
    const EMPTY: Self = Self { brightness: [0; 2], usual_brightness: 0, skin: 0 };

    fn frames(self) -> u8 {
        self.skin & COUNT
    }

    /// Takes what a frame shows of it, the `frames`-th one.
    fn see(&mut self, is_skin: bool, level: u8, frames: u8) {
        let [last, before] = self.brightness;
        let is_moving = frames == MAX_FRAMES && before.abs_diff(level) > MIN_CHANGE;
        self.brightness = [level, last];
        let mut count = self.frames();
        if frames <= 1 {
            count = if is_skin { MAX_SKIN_FRAMES } else { 0 };
            self.usual_brightness = level;
        } else {
            count = if is_skin { (count + 1).min(MAX_SKIN_FRAMES) } else { count.saturating_sub(1) };
            // What is near is followed at once, what is far only slowly.
            let usual = self.usual_brightness;
            let step = usual.abs_diff(level);
            let step = if step > MAX_FROM_USUAL { 1 } else { step.div_ceil(4) };
            self.usual_brightness = if level > usual { usual + step } else { usual - step };
        }
        self.skin = count | if is_skin { SKIN } else { 0 } | if is_moving { MOVING } else { 0 };
    }

    /// The last brightness, the one before, the usual one, and the frames with skin.
    pub(super) fn to_word(self) -> u32 {
        let [last, before] = self.brightness;
        u32::from_le_bytes([last, before, self.usual_brightness, self.frames()])
    }

    /// Takes a word of [`Cell::to_word`]; whether it is one.
    pub(super) fn set_word(&mut self, word: u32) -> bool {
        let [last, before, usual_brightness, frames] = word.to_le_bytes();
        let skin = self.skin & !COUNT | frames.min(MAX_SKIN_FRAMES);
        *self = Self { brightness: [last, before], usual_brightness, skin };
        frames <= MAX_SKIN_FRAMES
    }
}

impl<const COLUMNS: usize, const ROWS: usize> CellGrid<COLUMNS, ROWS> {
    /// A grid for no picture, all zero, so that a static of it takes no room in flash.
    #[must_use]
    pub const fn empty() -> Self {
        Self {
            size: GridSize { columns: 0, rows: 0 },
            cell_px: 0,
            cells: [[Cell::EMPTY; COLUMNS]; ROWS],
            counts: [0; COLUMNS],
            sums: [0; COLUMNS],
            row: 0,
            lines: 0,
            samples: 0,
            frames: 0,
        }
    }

    /// A grid for pictures of this size before the first one; `None` for a size that is too narrow
    /// or low for a cell. Cells are as small as the grid's capacity lets them be. What is left of
    /// whole cells at the right and at the bottom is not seen.
    #[must_use]
    pub fn new(width_px: usize, height_px: usize) -> Option<Self> {
        let mut grid = Self::empty();
        grid.resize(width_px, height_px).then_some(grid)
    }

    /// Forgets all, and takes pictures of another size from now on, as [`CellGrid::new`]; whether
    /// there is a cell.
    pub fn resize(&mut self, width_px: usize, height_px: usize) -> bool {
        self.cell_px = width_px.div_ceil(COLUMNS).max(height_px.div_ceil(ROWS)).max(1);
        self.size = GridSize { columns: width_px / self.cell_px, rows: height_px / self.cell_px };
        self.frames = 0;
        self.size.cells() > 0
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

    /// Begins a frame; drops one that did not end.
    pub fn begin(&mut self) {
        self.frames = (self.frames + 1).min(MAX_FRAMES);
        (self.row, self.lines) = (0, 0);
    }

    /// Takes line `v`: one bit of skin a pixel, the first in the lowest, and the brightness of
    /// every `step_px`-th pixel, 0 to 255. What is missing in a slice counts as no skin, and as
    /// black.
    ///
    /// Lines come in order; of a row of cells any that come are enough, and one without any stays
    /// as it was.
    pub fn line(&mut self, v: usize, skin: &[u32], brightness: &[u8], step_px: usize) {
        if !self.is_within(v, step_px) {
            return;
        }
        let mut levels = brightness.chunks(self.samples);
        for (column, (count, sum)) in self.counts.iter_mut().zip(&mut self.sums).enumerate().take(self.size.columns) {
            *count = count.saturating_add(ones(skin, column * self.cell_px, self.cell_px));
            // Of a line of a cell: far from any overflow, and added side by side.
            let levels = levels.next().unwrap_or(&[]).iter();
            *sum = sum.saturating_add(levels.fold(0, |sum: u32, level| sum.wrapping_add(u32::from(*level))));
        }
    }

    /// The same of cells of eight pixels with the brightness of every second one, four a word, the
    /// first in the lowest byte; `false` for other cells, of which nothing is taken.
    pub(in crate::vision) fn line_of_words(
        &mut self,
        v: usize,
        skin: &[u32],
        brightness: impl Iterator<Item = u32>,
    ) -> bool {
        if self.cell_px != 8 || !self.is_within(v, 2) {
            return self.cell_px == 8;
        }
        let eights = skin.iter().flat_map(|word| word.to_le_bytes());
        for (((count, sum), eight), four) in self.counts.iter_mut().zip(&mut self.sums).zip(eights).zip(brightness) {
            if eight != 0 {
                *count = count.saturating_add(eight.count_ones() as u16);
            }
            let pairs = (four & 0x00ff_00ff) + (four >> 8 & 0x00ff_00ff);
            *sum = sum.saturating_add((pairs + (pairs >> 16)) & 0xffff);
        }
        true
    }

    /// Begins a line; whether it lies in a row of cells.
    #[inline(always)]
    fn is_within(&mut self, v: usize, step_px: usize) -> bool {
        let row = v.checked_div(self.cell_px).unwrap_or(0);
        if row != self.row {
            self.end_row();
            self.row = row;
        }
        if row >= self.size.rows {
            return false;
        }
        if self.lines == 0 {
            self.counts.fill(0);
            self.sums.fill(0);
        }
        self.lines += 1;
        self.samples = (self.cell_px / step_px.max(1)).max(1);
        true
    }

    /// Ends the frame.
    pub fn end(&mut self) {
        self.end_row();
        self.row = self.size.rows;
    }

    /// Ends a row of cells, if any of its lines came.
    fn end_row(&mut self) {
        let Self { size, cell_px, cells, counts, sums, row, lines, samples, frames } = self;
        if *lines > 0 {
            let (half, samples) = (*cell_px * *lines, (*samples * *lines) as u32);
            let first = *row * size.columns;
            let cells = cells.as_flattened_mut().iter_mut().skip(first).take(size.columns);
            for (cell, (count, sum)) in cells.zip(counts.iter().zip(sums.iter())) {
                let level = sum.checked_div(samples).unwrap_or(0);
                cell.see(2 * usize::from(*count) >= half, level as u8, *frames);
            }
        }
        self.lines = 0;
    }

    fn cell(&self, cell: usize) -> Cell {
        self.cells.as_flattened().get(cell).copied().unwrap_or(Cell::EMPTY)
    }

    /// Whether half of a cell or more is skin.
    #[must_use]
    pub fn is_skin(&self, cell: usize) -> bool {
        self.cell(cell).skin & SKIN != 0
    }

    /// Whether the brightness of a cell changed within the last frames.
    #[must_use]
    pub fn is_moving(&self, cell: usize) -> bool {
        self.cell(cell).skin & MOVING != 0
    }

    /// Whether a cell has skin that was not there before.
    #[must_use]
    pub fn is_new(&self, cell: usize) -> bool {
        let cell = self.cell(cell);
        cell.skin & SKIN != 0 && cell.frames() < NEW_FRAMES
    }

    /// Whether a cell is far from its usual brightness.
    #[must_use]
    pub fn is_unusual(&self, cell: usize) -> bool {
        let Cell { brightness: [last, _], usual_brightness, .. } = self.cell(cell);
        usual_brightness.abs_diff(last) > MAX_FROM_USUAL
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

    type Grid = CellGrid<80, 60>;

    /// A frame of 80 x 60 pixels, each a cell.
    fn show(grid: &mut Grid, skin: impl Fn(usize, usize) -> bool, level: impl Fn(usize, usize) -> u8) {
        grid.begin();
        for row in 0..60 {
            let mut bits = [0; 3];
            (0..80).filter(|column| skin(*column, row)).for_each(|column| bits[column / 32] |= 1 << (column % 32));
            let levels: [u8; 80] = core::array::from_fn(|column| level(column, row));
            grid.line(row, &bits, &levels, 1);
        }
        grid.end();
    }

    #[test]
    fn skin_is_new_for_a_while_and_then_usual() {
        let mut grid = Grid::new(80, 60).unwrap();
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
        let mut grid = Grid::new(80, 60).unwrap();
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
        let mut grid = Grid::new(80, 60).unwrap();
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
            let mut grid = Grid::new(width, height).unwrap();
            assert!(grid.size().columns <= 80 && grid.size().rows <= 60);
            for line in 0..2 * height {
                grid.line(line, &[u32::MAX], &[7], 2);
            }
        }
        assert!(Grid::new(0, 10).is_none() && Grid::new(4000, 30).is_none(), "no whole cell");
    }

    #[test]
    fn a_row_of_cells_is_judged_by_the_lines_that_came() {
        // Cells of 8 x 8 pixels; of the second row one line comes, of the third none.
        let mut grid = CellGrid::<40, 30>::new(320, 240).unwrap();
        let skin = [u32::MAX; 10];
        for frame in 0..2 {
            grid.begin();
            for line in (0..9).chain(24..240).filter(|line| frame == 0 || line % 2 == 0) {
                grid.line(line, &skin, &[100; 160], 2);
            }
            grid.end();
            assert!(grid.is_skin(40) && !grid.is_skin(80) && grid.is_skin(120), "frame {frame}");
            assert!(!grid.is_unusual(0) && !grid.is_unusual(40));
        }
    }

    #[test]
    fn words_of_four_give_what_their_bytes_give() {
        let mut grids = [(); 2].map(|()| CellGrid::<40, 30>::new(320, 240).unwrap());
        for frame in 0..4_usize {
            grids.iter_mut().for_each(CellGrid::begin);
            for v in (0..240).step_by(2) {
                let skin: [u32; 10] =
                    core::array::from_fn(|i| ((v * 0x9e37 + i * frame) as u32).wrapping_mul(0x0101_4103));
                let levels: [u8; 160] = core::array::from_fn(|u| ((u * 37 + v * 11 + frame * 29) % 255) as u8);
                grids[0].line(v, &skin, &levels, 2);
                assert!(grids[1].line_of_words(
                    v,
                    &skin,
                    levels.as_chunks().0.iter().map(|four| u32::from_le_bytes(*four))
                ));
            }
            grids.iter_mut().for_each(CellGrid::end);
            let words = grids
                .each_ref()
                .map(|grid| grid.cells.as_flattened().iter().map(|cell| cell.to_word()).collect::<Vec<_>>());
            assert_eq!(words[0], words[1], "frame {frame}");
        }
        assert!(!CellGrid::<40, 30>::new(160, 120).unwrap().line_of_words(0, &[], [].into_iter()));
    }

    #[test]
    fn ones_are_counted_across_words() {
        assert_eq!(ones(&[0xffff_0000, 0xff], 30, 8), 8);
        assert_eq!(ones(&[0xffff_0000, 0xff], 12, 8), 4);
        assert_eq!(ones(&[0xffff_0000, 0xff], 60, 8), 0);
    }
}
