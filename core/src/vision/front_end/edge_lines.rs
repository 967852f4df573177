//! Temporal edge pixels from lines, against a 1-bit map of the frame before.

use super::pixel_format::PixelFormat;
use crate::error::{ParameterError, within};
use crate::vision::edges::{EdgeList, EdgePixel, EdgeThinning};

/// Side of an edge cell, pixels: edges are judged at every second column of every second line.
pub const EDGE_CELL_PX: usize = 2;
/// Cells in 32 columns.
const CELLS_PER_BLOCK: usize = 16;
/// Columns of a block of cells.
const BLOCK_PX: usize = EDGE_CELL_PX * CELLS_PER_BLOCK;
/// Words of the luminances of a block's cells, a byte each.
const BLOCK_WORDS: usize = 4;
/// The highest bit of each byte.
const TOPS: u32 = 0x8080_8080;

/// Luminances of a line's cells, 0 to 127, four a word, in blocks of 32 columns.
type Cells<const WORDS: usize> = [[u32; BLOCK_WORDS]; WORDS];

/// How steep an edge has to be; grey levels are those of a camera from 0 to 255.
///
/// ```
/// use sinew_core::vision::front_end::edge_lines::EdgeSteps;
/// use sinew_core::vision::front_end::edge_lines::{DEFAULT_KNOWN_STEP, DEFAULT_NEW_STEP};
///
/// assert_eq!(EdgeSteps::new(DEFAULT_NEW_STEP, DEFAULT_KNOWN_STEP)?, EdgeSteps::default());
/// // The map has to remember what is as steep as a new edge, else one that stands still would be
/// // new for ever.
/// assert_eq!(EdgeSteps::new(14.0, 28.0).map_err(|error| error.parameter), Err("known_step"));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct EdgeSteps {
    new: Limit,
    known: Limit,
}

/// A limit for half of a difference of luminances, 1 to 63, made ready for four bytes at once; see
/// [`Limit::reached`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Limit {
    rise: u32,
    fall: u32,
}

impl Limit {
    const fn new(limit: u32) -> Self {
        const ONES: u32 = 0x0101_0101;
        Self { rise: (64 - limit) * ONES, fall: (192 - limit) * ONES }
    }

    /// Sets the highest bit of each byte that is at least the limit away from 64; bytes from 0 to
    /// 127.
    #[inline]
    fn reached(self, halves: u32) -> u32 {
        // No byte carries or borrows: sums lie from 1 to 190, differences from 2 to 191.
        halves.wrapping_add(self.rise) | self.fall.wrapping_sub(halves)
    }
}

/// Default of the smallest step over four pixels that makes an edge, grey levels.
///
/// Chosen: agrees with the host's edges; measured by `cargo test --release -p sinew --test
/// front_end` (`docs/front_end.md`).
pub const DEFAULT_NEW_STEP: f32 = 28.0;
/// Default of the smallest step that the map remembers as an edge, grey levels.
///
/// Chosen: half of [`DEFAULT_NEW_STEP`], so that noise makes no edges of gradients near that limit.
pub const DEFAULT_KNOWN_STEP: f32 = 14.0;
/// Grey levels of one unit of half a difference of luminances: (255 / 109) x 2, see
/// [`PixelFormat::luminances`].
const LEVELS_PER_UNIT: f32 = 510.0 / 109.0;

impl Default for EdgeSteps {
    fn default() -> Self {
        Self { new: Limit::new(6), known: Limit::new(3) }
    }
}

impl EdgeSteps {
    /// Thresholds of an edge pixel, grey levels; both are rounded to steps of 4.7 levels.
    ///
    /// An edge pixel has a step of at least `new_step`, across or down, from two pixels before to
    /// two pixels behind it. The previous frame has none of at least `known_step` there.
    ///
    /// # Errors
    /// From 5 to 255, `known_step` not above `new_step`.
    pub fn new(new_step: f32, known_step: f32) -> Result<Self, ParameterError> {
        within("new_step", new_step, 5.0, 255.0)?;
        within("known_step", known_step, 5.0, new_step)?;
        let units = |step: f32| crate::math::clamp(crate::math::round(step / LEVELS_PER_UNIT), 1.0, 63.0) as u32;
        Ok(Self { new: Limit::new(units(new_step)), known: Limit::new(units(known_step)) })
    }
}

/// The edges of the previous frame, a bit a cell: for 320 x 240 pixels (`WORDS` 10, `ROWS` 120)
/// 2400 bytes.
#[derive(Debug, Clone)]
struct EdgeMap<const WORDS: usize, const ROWS: usize> {
    rows: [[u16; WORDS]; ROWS],
}

/// Finds the temporal edge pixels of lines; keeps three lines of luminances and the previous
/// frame's map.
///
/// Lines have up to 32 `WORDS` pixels, frames up to 2 `ROWS` lines; what lies beyond has no edges.
///
/// ```
/// use sinew_core::vision::edges::EdgeList;
/// use sinew_core::vision::front_end::edge_lines::{EdgeLines, EdgeSteps};
/// use sinew_core::vision::front_end::pixel_format::Rgb565;
///
/// // Frames of 32 x 32 pixels, white from a column on.
/// let mut lines = EdgeLines::<1, 16>::new(EdgeSteps::default());
/// let mut edges = EdgeList::<64>::new();
/// for left in [10, 16] {
///     lines.begin_frame(&mut edges);
///     for v in 0..32 {
///         let line =
///             core::array::from_fn::<u16, 32, _>(|u| if u >= left { 0xffff } else { 0 });
///         lines.line::<Rgb565, 64>(v, &line, 32, &mut edges);
///     }
///     lines.end_frame();
/// }
/// assert!(!edges.as_slice().is_empty());
/// assert!(
///     edges.as_slice().iter().all(|pixel| (14..=16).contains(&pixel.u)),
///     "where the edge is now"
/// );
/// ```
#[derive(Debug, Clone)]
pub struct EdgeLines<const WORDS: usize, const ROWS: usize> {
    cells: [Cells<WORDS>; 3],
    map: EdgeMap<WORDS, ROWS>,
    /// Whether `map` is that of the previous frame.
    known: bool,
    thinning: EdgeThinning,
    steps: EdgeSteps,
}

impl<const WORDS: usize, const ROWS: usize> EdgeLines<WORDS, ROWS> {
    /// Bytes of the map.
    pub const MAP_BYTES: usize = size_of::<EdgeMap<WORDS, ROWS>>();

    /// Before the first frame.
    #[must_use]
    pub const fn new(steps: EdgeSteps) -> Self {
        Self {
            cells: [[[0; BLOCK_WORDS]; WORDS]; 3],
            map: EdgeMap { rows: [[0; WORDS]; ROWS] },
            known: false,
            thinning: EdgeThinning::new(),
            steps,
        }
    }

    /// Becomes what [`Self::new`] gives, in place.
    pub(super) fn begin(&mut self, steps: EdgeSteps) {
        self.cells.as_flattened_mut().fill([0; BLOCK_WORDS]);
        self.map.rows.as_flattened_mut().fill(0);
        self.known = false;
        self.thinning = EdgeThinning::new();
        self.steps = steps;
    }

    /// Forgets the previous frame: the next one has no temporal edges.
    pub fn forget_last_frame(&mut self) {
        self.known = false;
    }

    /// Begins a frame.
    pub fn begin_frame<const EDGES: usize>(&mut self, edges: &mut EdgeList<EDGES>) {
        edges.clear();
        self.thinning = EdgeThinning::new();
    }

    /// Ends a frame; its map becomes that of the previous frame.
    pub fn end_frame(&mut self) {
        self.known = true;
    }

    /// Reads line `v` of `width` pixels; lines have to come in order.
    pub fn line<F: PixelFormat, const EDGES: usize>(
        &mut self,
        v: usize,
        line: &[u16],
        width: usize,
        edges: &mut EdgeList<EDGES>,
    ) {
        let row = v / EDGE_CELL_PX;
        if !v.is_multiple_of(EDGE_CELL_PX) || row >= ROWS {
            return;
        }
        read_cells::<F, WORDS>(line, width, &mut self.cells[row % 3]);
        if row >= 2 {
            self.judge(row - 1, width / EDGE_CELL_PX, edges);
        }
    }

    /// Luminances of every second pixel of line `v`, 0 to 127, four a word; those of the last line
    /// that was read of its kind.
    pub(super) fn luminances(&self, v: usize) -> impl Iterator<Item = u32> {
        self.cells[v / EDGE_CELL_PX % 3].as_flattened().iter().copied()
    }

    /// Finds the edges of a row of cells from its luminances and those of the rows above and below
    /// it.
    fn judge<const EDGES: usize>(&mut self, row: usize, columns: usize, edges: &mut EdgeList<EDGES>) {
        let [above, here, below] = [row + 2, row, row + 1].map(|r| &self.cells[r % 3]);
        let Some(map) = self.map.rows.get_mut(row) else { return };
        let (steps, mut before, mut inner) = (self.steps, 0, INNER_OF_FIRST);
        let blocks = columns.div_ceil(CELLS_PER_BLOCK);
        let rows = above.iter().zip(here).zip(below);
        for (i, (((above, here_block), below), map)) in rows.zip(map).enumerate().take(blocks) {
            let next = here.get(i + 1).map_or(0, |block| block[0]);
            if i + 1 >= blocks {
                inner &= inner_of_last(columns);
            }
            // Without a previous frame nothing is new.
            let old = if self.known { u32::from(*map) } else { u32::MAX };
            let (new, known) = steep(steps, [above, here_block, below], [before, next], old);
            before = here_block[BLOCK_WORDS - 1];
            *map = (known & inner) as u16;
            let moving = new & inner & !old;
            if moving != 0 {
                self.thinning.offer_bits(moving, i * CELLS_PER_BLOCK, row, edges);
            }
            inner = u32::MAX;
        }
    }
}

impl EdgeThinning {
    /// Offers the cells of a row whose bits are set, the first of them cell `first`.
    fn offer_bits<const N: usize>(&mut self, bits: u32, first: usize, row: usize, edges: &mut EdgeList<N>) {
        let mut rest = bits;
        while rest != 0 {
            let column = first + rest.trailing_zeros() as usize;
            rest &= rest - 1;
            self.offer(EdgePixel { u: (column * EDGE_CELL_PX) as u16, v: (row * EDGE_CELL_PX) as u16 }, edges);
        }
    }
}

/// Luminances of a line's whole cells, four a word, the first in the lowest byte.
fn read_cells<F: PixelFormat, const WORDS: usize>(line: &[u16], width: usize, cells: &mut Cells<WORDS>) {
    let line = &line[..line.len().min(width)];
    let (whole, rest) = line.as_chunks::<BLOCK_PX>();
    let mut blocks = cells.iter_mut();
    for (pixels, block) in whole.iter().zip(blocks.by_ref()) {
        *block = block_luminances::<F>(pixels);
    }
    if let Some(block) = blocks.next() {
        let mut last = [0; BLOCK_PX];
        last.iter_mut().zip(rest).for_each(|(to, from)| *to = *from);
        *block = block_luminances::<F>(&last);
    }
    blocks.for_each(|block| *block = [0; BLOCK_WORDS]);
}

#[inline]
fn block_luminances<F: PixelFormat>(pixels: &[u16; BLOCK_PX]) -> [u32; BLOCK_WORDS] {
    let mut block = [0; BLOCK_WORDS];
    for (word, eight) in block.iter_mut().zip(pixels.as_chunks::<{ BLOCK_PX / BLOCK_WORDS }>().0) {
        *word = F::luminances(eight);
    }
    block
}

/// Bits of the cells of a block whose steps reach the two limits.
///
/// The first ones are right only for cells that are not in `old`.
#[inline]
fn steep(
    steps: EdgeSteps,
    [above, here, below]: [&[u32; BLOCK_WORDS]; 3],
    [before, next]: [u32; 2],
    old: u32,
) -> (u32, u32) {
    let (mut new, mut known) = (0, 0);
    let mut last = before;
    for i in 0..BLOCK_WORDS {
        let after = if i + 1 < BLOCK_WORDS { here[i + 1] } else { next };
        let (left, right) = (here[i] << 8 | last >> 24, here[i] >> 8 | after << 24);
        last = here[i];
        let (across, down) = (half_difference(right, left), half_difference(below[i], above[i]));
        let at_least = |limit: Limit| nibble((limit.reached(across) | limit.reached(down)) & TOPS);
        let here_known = at_least(steps.known);
        known |= here_known << (4 * i);
        if here_known & !(old >> (4 * i)) != 0 {
            new |= at_least(steps.new) << (4 * i);
        }
    }
    (new, known)
}

/// 64 + (a - b) / 2 of four bytes at once, bytes up to 127.
#[inline]
fn half_difference(a: u32, b: u32) -> u32 {
    // No byte borrows: 128 + a - b is from 1 to 255.
    (a | TOPS).wrapping_sub(b) >> 1 & !TOPS
}

/// The highest bits of four bytes, all other bits zero, as four bits.
#[inline]
fn nibble(tops: u32) -> u32 {
    // Bits 7, 15, 23 and 31 move to 28 to 31; no two of the sixteen products overlap.
    tops.wrapping_mul(1 << 21 | 1 << 14 | 1 << 7 | 1) >> 28
}

/// The bits of a line's first block but its first cell's.
const INNER_OF_FIRST: u32 = !1;

/// The bits of a line's last block that lie before its last cell; lines of `columns` cells.
fn inner_of_last(columns: usize) -> u32 {
    (1 << (columns.saturating_sub(1) % CELLS_PER_BLOCK)) - 1
}

#[cfg(test)]
mod tests {
    use super::super::pixel_format::{Rgb565, Yuyv};
    use super::*;
    use proptest::prelude::*;

    type Lines = EdgeLines<3, 8>;

    /// Grey pixels in YUYV.
    fn grey(level: u8) -> u16 {
        u16::from(level) | 0x8000
    }

    fn frame<const N: usize>(lines: &mut Lines, pixels: &[u16], width: usize) -> EdgeList<N> {
        let mut edges = EdgeList::new();
        lines.begin_frame(&mut edges);
        for (v, line) in pixels.chunks(width).enumerate() {
            lines.line::<Yuyv, N>(v, line, width, &mut edges);
        }
        lines.end_frame();
        edges
    }

    /// The definition, cell by cell.
    fn naive(now: &[u16], before: &[u16], width: usize, height: usize, steps: EdgeSteps) -> Vec<(u16, u16)> {
        let (columns, rows) = (width / 2, height.div_ceil(2).min(8));
        let at = |frame: &[u16], c: usize, r: usize| {
            let first = 2 * r * width + 2 * c;
            i32::from(frame[first] & 0xff) / 2
        };
        let reaches = |frame: &[u16], c: usize, r: usize, limit: Limit| {
            let limit = 64 - (limit.rise & 0xff) as i32;
            let across = at(frame, c + 1, r) - at(frame, c - 1, r);
            let down = at(frame, c, r + 1) - at(frame, c, r - 1);
            [across, down].iter().any(|d| d.div_euclid(2) >= limit || -d.div_euclid(2) >= limit)
        };
        let cells = (1..rows.max(2) - 1).flat_map(|r| (1..columns.max(2) - 1).map(move |c| (c, r)));
        let moving = cells.filter(|&(c, r)| reaches(now, c, r, steps.new) && !reaches(before, c, r, steps.known));
        moving.map(|(c, r)| (2 * c as u16, 2 * r as u16)).collect()
    }

    proptest! {
        #[test]
        fn edges_equal_the_definition(
            width in 1_usize..97, height in 1_usize..20, pixels in prop::collection::vec(any::<[u8; 2]>(), 97 * 20),
            coarse in 1_usize..9, new in 5.0_f32..120.0, share in 0.1_f32..1.0,
        ) {
            let steps = EdgeSteps::new(new, (new * share).max(5.0)).unwrap();
            let plane = |which: usize| -> Vec<u16> {
                let level = |i: usize| pixels[(i / width / coarse) * 97 + i % width / coarse][which];
                (0..width * height).map(|i| grey(level(i))).collect()
            };
            let (before, now) = (plane(0), plane(1));
            let mut lines = Lines::new(steps);
            prop_assert!(frame::<9>(&mut lines, &before, width).as_slice().is_empty());
            let mut again = lines.clone();
            let found = frame::<4096>(&mut lines, &now, width);
            let found: Vec<(u16, u16)> = found.as_slice().iter().map(|p| (p.u, p.v)).collect();
            let wanted = naive(&now, &before, width, height, steps);
            prop_assert_eq!(&found, &wanted);
            let few = frame::<10>(&mut again, &now, width);
            prop_assert_eq!(few.as_slice().len() + few.dropped as usize, wanted.len());
            prop_assert!(few.as_slice().len() >= wanted.len().min(5));
        }
    }

    /// A texture of 16-pixel stripes with a sensor's noise of standard deviation 5, moved by
    /// `shift` pixels.
    fn stripes(seed: u64, shift: usize) -> Vec<u16> {
        use rand_core::{Rng, SeedableRng};
        let mut random = rand_xoshiro::Xoshiro128PlusPlus::seed_from_u64(seed);
        let mut noise = || (0..4).map(|_| (random.next_u32() >> 8) as i32 % 1000 - 500).sum::<i32>() * 5 / 577;
        let level = |i: usize| if ((i % 320 + shift) / 16).is_multiple_of(2) { 60 } else { 180 };
        (0..320 * 240).map(|i| grey((level(i) + noise()) as u8)).collect()
    }

    #[test]
    fn noise_of_five_levels_gives_hardly_any_edges_and_motion_many() {
        let mut lines = EdgeLines::<10, 120>::new(EdgeSteps::default());
        let mut counts = [0; 3];
        for (count, pixels) in counts.iter_mut().zip([stripes(1, 0), stripes(2, 0), stripes(3, 6)]) {
            let mut edges = EdgeList::<32>::new();
            lines.begin_frame(&mut edges);
            pixels.chunks(320).enumerate().for_each(|(v, line)| lines.line::<Yuyv, 32>(v, line, 320, &mut edges));
            lines.end_frame();
            *count = edges.as_slice().len() + edges.dropped as usize;
        }
        println!("edges of the first, a still and a moved frame: {counts:?} of 19200 cells");
        assert_eq!(counts[0], 0);
        assert!((1..30).contains(&counts[1]), "{counts:?}");
        assert!((1500..6000).contains(&counts[2]), "{counts:?}");
    }

    #[test]
    fn a_forgotten_frame_gives_no_edges() {
        let mut lines = Lines::new(EdgeSteps::default());
        let step = |at: usize| -> Vec<u16> { (0..64 * 9).map(|i| grey(if i % 64 < at { 20 } else { 200 })).collect() };
        frame::<99>(&mut lines, &step(20), 64);
        assert!(!frame::<99>(&mut lines, &step(31), 64).as_slice().is_empty());
        lines.forget_last_frame();
        assert!(frame::<99>(&mut lines, &step(44), 64).as_slice().is_empty());
        assert!(frame::<99>(&mut lines, &step(44), 64).as_slice().is_empty(), "a still frame");
        let short: &[u16] = &[1, 2, 3];
        lines.line::<Rgb565, 99>(0, short, 64, &mut EdgeList::new());
    }

    #[test]
    fn steps_out_of_range_are_refused_by_name() {
        assert_eq!(EdgeSteps::new(4.0, 4.0).unwrap_err().parameter, "new_step");
        assert_eq!(EdgeSteps::new(20.0, 21.0).unwrap_err().parameter, "known_step");
        assert_eq!(EdgeSteps::new(DEFAULT_NEW_STEP, DEFAULT_KNOWN_STEP).unwrap(), EdgeSteps::default());
    }
}
