//! Temporal edge pixels: edges of the luminance that changed since the previous frame.
//!
//! ```
//! use sinew_core::vision::edges::{EdgeDetector, EdgeList};
//! use sinew_core::vision::mask::words_per_row;
//!
//! // A bright bar that moves by three pixels.
//! const SIZE: (usize, usize) = (64, 32);
//! let frame = |left: usize| -> Vec<u8> {
//!     (0..SIZE.0 * SIZE.1)
//!         .map(|i| if (left..left + 10).contains(&(i % SIZE.0)) { 200 } else { 40 })
//!         .collect()
//! };
//! let mut bits = [0; words_per_row(SIZE.0) * SIZE.1];
//! EdgeDetector::default().find(&frame(23), &frame(20), SIZE.0, SIZE.1, &mut bits)?;
//! let mut edges = EdgeList::<500>::new();
//! edges.take_mask(&bits, SIZE.0);
//! assert!(!edges.as_slice().is_empty() && edges.dropped == 0);
//! assert!(
//!     edges.as_slice().iter().all(|pixel| (18..37).contains(&pixel.u)),
//!     "only where the bar is or was"
//! );
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

use super::mask::{MAX_SIDE_PX, words_per_row};
use crate::error::{ParameterError, Rule, within};
use heapless::Vec;

/// Pixels judged together.
const BLOCK: usize = 32;
/// A block and its neighbours on both sides.
const WINDOW: usize = BLOCK + 2;

/// A temporal edge pixel: an edge of the luminance that has changed since the previous frame.
///
/// ```
/// use sinew_core::vision::edges::{EdgeList, EdgePixel};
///
/// // The list gives places, row by row.
/// let mut list = EdgeList::<8>::new();
/// list.take_mask(&[0, 1 << 5, 1 << 3], 32);
/// assert_eq!(list.as_slice(), [EdgePixel { u: 5, v: 1 }, EdgePixel { u: 3, v: 2 }]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub struct EdgePixel {
    /// Column.
    pub u: u16,
    /// Row.
    pub v: u16,
}

/// Temporal edge pixels in the order of rows, thinned where there were more than fit.
///
/// ```
/// use sinew_core::vision::edges::EdgeList;
///
/// // A whole row of edges and room for eight: every fourth stays, and the rest is counted.
/// let mut list = EdgeList::<8>::new();
/// list.take_mask(&[u32::MAX], 32);
/// assert_eq!((list.as_slice().len(), list.dropped), (8, 24));
/// let [first, second, ..] = list.as_slice() else { panic!("there are eight") };
/// assert_eq!(second.u - first.u, 4);
/// ```
#[derive(Debug, Clone, Default)]
pub struct EdgeList<const N: usize> {
    pixels: Vec<EdgePixel, N>,
    /// Edge pixels that were left out, evenly over the image.
    pub dropped: u32,
}

impl<const N: usize> EdgeList<N> {
    /// An empty list.
    #[must_use]
    pub const fn new() -> Self {
        Self { pixels: Vec::new(), dropped: 0 }
    }

    /// The edge pixels.
    #[must_use]
    pub fn as_slice(&self) -> &[EdgePixel] {
        &self.pixels
    }

    /// Empties the list.
    pub fn clear(&mut self) {
        self.pixels.clear();
        self.dropped = 0;
    }

    /// Takes the set pixels of a mask; of more than fit every n-th, n a fraction, in the order of
    /// rows.
    pub fn take_mask(&mut self, bits: &[u32], width: usize) {
        self.clear();
        let total: u32 = bits.iter().map(|word| word.count_ones()).sum();
        let room = total.min(N as u32);
        let mut credit = 0;
        for (i, &word) in bits.iter().enumerate() {
            let (v, first) = (i / words_per_row(width).max(1), 32 * (i % words_per_row(width).max(1)));
            let mut rest = word;
            while rest != 0 {
                let u = first + rest.trailing_zeros() as usize;
                rest &= rest - 1;
                credit += u64::from(room);
                if credit >= u64::from(total) {
                    credit -= u64::from(total);
                    // `room` pixels are taken in all, so there is room.
                    let _ = self.pixels.push(EdgePixel { u: u as u16, v: v as u16 });
                }
            }
        }
        self.dropped = total - self.pixels.len() as u32;
    }
}

/// Thins a stream of edge pixels of unknown length: keeps every 2^k-th, in the order of the stream.
///
/// Invariant: the list holds the pixels number 0, `stride`, 2 `stride` ... of those offered so far.
/// After thinning, a full list is half full.
///
/// ```
/// use sinew_core::vision::edges::{EdgeList, EdgePixel, EdgeThinning};
///
/// // A stream of ten pixels, its length unknown at the start, and room for four.
/// let (mut thinning, mut list) = (EdgeThinning::new(), EdgeList::<4>::new());
/// for u in 0..10 {
///     thinning.offer(EdgePixel { u, v: 0 }, &mut list);
/// }
/// let sum: u16 = list.as_slice().iter().map(|pixel| pixel.u).sum();
/// assert_eq!(
///     (list.as_slice().len(), sum),
///     (3, 12),
///     "0, 4 and 8: every fourth is kept by now"
/// );
/// assert_eq!(list.dropped, 7);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EdgeThinning {
    stride: u32,
    offered: u32,
}

impl Default for EdgeThinning {
    fn default() -> Self {
        Self::new()
    }
}

impl EdgeThinning {
    /// Before the first pixel; for an empty list.
    #[must_use]
    pub const fn new() -> Self {
        Self { stride: 1, offered: 0 }
    }

    /// Offers the next pixel.
    #[inline]
    pub fn offer<const N: usize>(&mut self, pixel: EdgePixel, list: &mut EdgeList<N>) {
        list.dropped += self.offer_to(pixel, &mut list.pixels);
    }

    /// Offers the next pixel to a plain list; gives how many pixels were left out for it.
    #[inline]
    pub(crate) fn offer_to<const N: usize>(&mut self, pixel: EdgePixel, list: &mut Vec<EdgePixel, N>) -> u32 {
        let dropped = if self.offered & (self.stride - 1) != 0 {
            1
        } else if list.push(pixel).is_err() {
            self.offer_to_full(pixel, list)
        } else {
            0
        };
        self.offered = self.offered.wrapping_add(1);
        dropped
    }

    #[cold]
    #[inline(never)]
    fn offer_to_full<const N: usize>(&mut self, pixel: EdgePixel, list: &mut Vec<EdgePixel, N>) -> u32 {
        let len_before = list.len();
        if self.stride < 1 << 31 {
            keep_every_second(list);
            self.stride *= 2;
        }
        if self.offered & (self.stride - 1) == 0 {
            // A list without any room stays empty.
            let _ = list.push(pixel);
        }
        (len_before + 1 - list.len()) as u32
    }
}

fn keep_every_second<const N: usize>(list: &mut Vec<EdgePixel, N>) {
    let kept = list.len().div_ceil(2);
    for i in 0..kept {
        if let (Some(pixel), Some(slot)) = (list.get(2 * i).copied(), list.get_mut(i)) {
            *slot = pixel;
        }
    }
    list.truncate(kept);
}

/// Luminance 0 to 255 of a line of interleaved RGB, (77 R + 150 G + 29 B) / 256 (Rec. 601).
///
/// ```
/// use sinew_core::vision::edges::luminance_line;
///
/// // White, red, black.
/// let mut luminance = [0; 3];
/// luminance_line(&[255, 255, 255, 255, 0, 0, 0, 0, 0], &mut luminance);
/// assert_eq!(luminance, [255, 76, 0]);
/// ```
pub fn luminance_line(rgb: &[u8], luminance: &mut [u8]) {
    for (pixel, out) in rgb.as_chunks::<3>().0.iter().zip(luminance) {
        let [r, g, b] = pixel.map(u16::from);
        *out = ((77 * r + 150 * g + 29 * b) >> 8) as u8;
    }
}

/// Finds temporal edges; both thresholds are in grey levels, 0 to 255.
///
/// The gradient is Sobel's, divided by 8: a slope of one grey level a pixel has length 1. The
/// change between frames is weighted over 3x3 pixels by 1-2-1 in both directions, which suppresses
/// noise.
///
/// ```
/// use sinew_core::vision::edges::{DEFAULT_MIN_GRADIENT, DEFAULT_MIN_MOTION, EdgeDetector};
///
/// // Bright from column `left` on, in 16 x 16 pixels.
/// let frame = |left: usize| {
///     core::array::from_fn::<u8, 256, _>(|i| if i % 16 >= left { 200 } else { 40 })
/// };
/// let detector = EdgeDetector::new(DEFAULT_MIN_GRADIENT, DEFAULT_MIN_MOTION)?;
/// let mut bits = [0; 16];
/// detector.find(&frame(10), &frame(7), 16, 16, &mut bits)?;
/// assert_eq!(
///     (bits[0], bits[8]),
///     (0, 0b11 << 9),
///     "the edge has moved to columns 9 and 10; the border has none"
/// );
/// detector.find(&frame(10), &frame(10), 16, 16, &mut bits)?;
/// assert_eq!(bits, [0; 16], "what stands still is no temporal edge");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct EdgeDetector {
    /// (8 x gradient threshold)^2.
    gradient_square: i32,
    /// 16 x motion threshold.
    motion: i16,
}

/// Default of the smallest gradient, grey levels a pixel.
///
/// Chosen: a soft edge of 40 levels over five pixels passes.
pub const DEFAULT_MIN_GRADIENT: f32 = 8.0;
/// Default of the smallest smoothed change, grey levels.
///
/// Chosen: four to five standard deviations of the smoothed difference of two frames. That standard
/// deviation is 2.7 levels for a webcam's noise of 5 levels (tested).
pub const DEFAULT_MIN_MOTION: f32 = 12.0;

impl Default for EdgeDetector {
    fn default() -> Self {
        Self { gradient_square: 64 * 64, motion: 192 }
    }
}

impl EdgeDetector {
    /// A detector for gradients of at least `min_gradient` and changes of at least `min_motion`,
    /// grey levels.
    ///
    /// # Errors
    /// Both have to lie from 0 to 255.
    pub fn new(min_gradient: f32, min_motion: f32) -> Result<Self, ParameterError> {
        let gradient = 8.0 * within("min_gradient", min_gradient, 0.0, 255.0)?;
        let motion = 16.0 * within("min_motion", min_motion, 0.0, 255.0)?;
        Ok(Self { gradient_square: (gradient * gradient) as i32, motion: motion as i16 })
    }

    /// Sets the bits of the temporal edge pixels of two luminance frames in `bits`
    /// ([`words_per_row`] words a row).
    ///
    /// Pixels on the image's border are never edges.
    ///
    /// # Errors
    /// Sides up to [`MAX_SIDE_PX`], frames of `width` x `height` bytes, and enough words.
    pub fn find(
        &self,
        luminance: &[u8],
        previous: &[u8],
        width: usize,
        height: usize,
        bits: &mut [u32],
    ) -> Result<(), ParameterError> {
        if width > MAX_SIDE_PX || height > MAX_SIDE_PX {
            return Err(ParameterError::new("frame side", Rule::Capacity { capacity: MAX_SIDE_PX }));
        }
        let len = words_per_row(width);
        let same = |parameter, have: usize, expected: usize| {
            if have < expected { Err(ParameterError::new(parameter, Rule::SameLength { expected })) } else { Ok(()) }
        };
        same("luminance", luminance.len(), width * height)?;
        same("previous", previous.len(), width * height)?;
        same("bits", bits.len(), len * height)?;
        bits.fill(0);
        if width < 3 || height < 3 {
            return Ok(());
        }
        for (v, row) in bits.chunks_exact_mut(len).enumerate().take(height - 1).skip(1) {
            let lines = [v - 1, v, v + 1].map(|y| y * width..(y + 1) * width);
            let now = lines.clone().map(|range| &luminance[range]);
            let before = lines.map(|range| &previous[range]);
            for (i, word) in row.iter_mut().enumerate() {
                *word = self.block(now, before, i * BLOCK) & inner_columns(i * BLOCK, width);
            }
        }
        Ok(())
    }

    /// The bits of the block that begins at column `first`.
    fn block(&self, now: [&[u8]; 3], before: [&[u8]; 3], first: usize) -> u32 {
        let now = now.map(|line| window(line, first));
        let before = before.map(|line| window(line, first));
        let mut change = [0_i16; WINDOW];
        for (i, out) in change.iter_mut().enumerate() {
            let difference = |y: usize| i16::from(now[y][i]) - i16::from(before[y][i]);
            *out = difference(0) + 2 * difference(1) + difference(2);
        }
        let mut moving = [0_u16; BLOCK];
        for (i, out) in moving.iter_mut().enumerate() {
            let sum = change[i] + 2 * change[i + 1] + change[i + 2];
            *out = u16::from(sum >= self.motion) | u16::from(sum <= -self.motion);
        }
        if moving.iter().fold(0, |any, m| any | m) == 0 {
            return 0;
        }
        let (mut smooth, mut slope) = ([0_i16; WINDOW], [0_i16; WINDOW]);
        for i in 0..WINDOW {
            let [a, b, c] = [0, 1, 2].map(|y: usize| i16::from(now[y][i]));
            smooth[i] = a + 2 * b + c;
            slope[i] = c - a;
        }
        let mut bits = [0_u32; BLOCK];
        for (i, bit) in bits.iter_mut().enumerate() {
            let across = i32::from(smooth[i + 2] - smooth[i]);
            let down = i32::from(slope[i] + 2 * slope[i + 1] + slope[i + 2]);
            let edge = across * across + down * down >= self.gradient_square;
            *bit = (u32::from(moving[i]) & u32::from(edge)) << i;
        }
        bits.iter().fold(0, |word, bit| word | bit)
    }
}

/// Columns `first - 1` to `first + 32` of a line, zero beyond it.
#[inline]
fn window(line: &[u8], first: usize) -> [u8; WINDOW] {
    let mut out = [0; WINDOW];
    match (first.checked_sub(1), line.get(first.wrapping_sub(1)..first + BLOCK + 1)) {
        (Some(_), Some(inside)) => out.copy_from_slice(inside),
        (Some(before), None) => out.iter_mut().zip(line.iter().skip(before)).for_each(|(o, l)| *o = *l),
        (None, _) => out.iter_mut().skip(1).zip(line).for_each(|(o, l)| *o = *l),
    }
    out
}

/// The bits of a block's columns that are neither the image's first nor its last.
fn inner_columns(first: usize, width: usize) -> u32 {
    let end = (width - 1).saturating_sub(first).min(BLOCK) as u32;
    let below = 1_u32.checked_shl(end).map_or(u32::MAX, |bit| bit - 1);
    if first == 0 { below & !1 } else { below }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn naive(
        now: &[u8],
        before: &[u8],
        width: usize,
        height: usize,
        gradient: f32,
        motion: f32,
    ) -> Vec<EdgePixel, 4096> {
        let mut found = Vec::new();
        let at = |f: &[u8], u: usize, v: usize| f32::from(f[v * width + u]);
        for v in 1..height.saturating_sub(1) {
            for u in 1..width.saturating_sub(1) {
                let (mut gx, mut gy, mut change) = (0.0, 0.0, 0.0);
                for (dv, a) in [1.0, 2.0, 1.0].into_iter().enumerate() {
                    for (du, b) in [1.0, 2.0, 1.0].into_iter().enumerate() {
                        let (x, y) = (u + du - 1, v + dv - 1);
                        gx += a * (du as f32 - 1.0) * at(now, x, y) / 8.0;
                        gy += b * (dv as f32 - 1.0) * at(now, x, y) / 8.0;
                        change += a * b * (at(now, x, y) - at(before, x, y)) / 16.0;
                    }
                }
                if gx * gx + gy * gy >= gradient * gradient && change.abs() >= motion {
                    found.push(EdgePixel { u: u as u16, v: v as u16 }).unwrap();
                }
            }
        }
        found
    }

    proptest! {
        #[test]
        fn edges_equal_the_definition(
            width in 1_usize..70, height in 1_usize..8, pixels in prop::collection::vec(any::<[u8; 2]>(), 70 * 8),
            gradient in 0_u8..60, motion in 0_u8..60,
        ) {
            let now: std::vec::Vec<u8> = pixels[..width * height].iter().map(|p| p[0]).collect();
            let before: std::vec::Vec<u8> = pixels[..width * height].iter().map(|p| p[1]).collect();
            let (gradient, motion) = (f32::from(gradient), f32::from(motion));
            let mut bits = vec![u32::MAX; words_per_row(width) * height];
            EdgeDetector::new(gradient, motion).unwrap().find(&now, &before, width, height, &mut bits).unwrap();
            let mut list = EdgeList::<4096>::new();
            list.take_mask(&bits, width);
            let wanted = naive(&now, &before, width, height, gradient, motion);
            prop_assert_eq!(list.as_slice(), wanted.as_slice());
            let mut short = EdgeList::<10>::new();
            short.take_mask(&bits, width);
            prop_assert_eq!(short.as_slice().len() + short.dropped as usize, wanted.len());
            prop_assert_eq!(short.as_slice().len(), wanted.len().min(10));
        }
    }

    #[test]
    fn thinning_keeps_every_part_of_the_image() {
        let bits = [u32::MAX; 64];
        let mut list = EdgeList::<128>::new();
        list.take_mask(&bits, 64);
        assert_eq!((list.as_slice().len(), list.dropped), (128, 1920));
        for v in 0..32 {
            assert_eq!(list.as_slice().iter().filter(|p| p.v == v).count(), 4);
        }
    }

    #[test]
    fn pixels_that_come_one_by_one_are_thinned_evenly() {
        fn thinned<const N: usize>(count: u16) -> (std::vec::Vec<u16>, u32) {
            let (mut thinning, mut list) = (EdgeThinning::new(), EdgeList::<N>::new());
            (0..count).for_each(|u| thinning.offer(EdgePixel { u, v: 0 }, &mut list));
            (list.as_slice().iter().map(|pixel| pixel.u).collect(), list.dropped)
        }
        assert_eq!(thinned::<5>(5), (vec![0, 1, 2, 3, 4], 0));
        assert_eq!(thinned::<5>(6), (vec![0, 2, 4], 3));
        assert_eq!(thinned::<4>(5), (vec![0, 2, 4], 2));
        assert_eq!(thinned::<5>(33), (vec![0, 8, 16, 24, 32], 28));
        assert_eq!(thinned::<0>(3), (vec![], 3));
        assert_eq!(thinned::<1>(9), (vec![0], 8));
    }

    #[test]
    fn noise_of_five_levels_gives_hardly_any_edges() {
        use rand_core::{Rng, SeedableRng};
        let mut random = rand_xoshiro::Xoshiro128PlusPlus::seed_from_u64(1);
        // A sum of four uniform draws, standard deviation 5; the scene holds strong edges.
        let mut noisy = |base: u8| {
            let draws: i32 = (0..4).map(|_| (random.next_u32() >> 8) as i32 % 1000 - 500).sum();
            (i32::from(base) + draws * 5 / 577) as u8
        };
        let scene: std::vec::Vec<u8> = (0..320 * 240).map(|i| if (i % 320 / 16) % 2 == 0 { 60 } else { 180 }).collect();
        let now: std::vec::Vec<u8> = scene.iter().map(|&p| noisy(p)).collect();
        let before: std::vec::Vec<u8> = scene.iter().map(|&p| noisy(p)).collect();
        let mut bits = vec![0; 10 * 240];
        EdgeDetector::default().find(&now, &before, 320, 240, &mut bits).unwrap();
        let count: u32 = bits.iter().map(|w| w.count_ones()).sum();
        assert!(count < 20, "{count} of 76800 pixels");
        let moved: std::vec::Vec<u8> = (0..320 * 240).map(|i| now[i / 320 * 320 + (i % 320 + 3) % 320]).collect();
        EdgeDetector::default().find(&moved, &before, 320, 240, &mut bits).unwrap();
        let count: u32 = bits.iter().map(|w| w.count_ones()).sum();
        assert!((8_000..20_000).contains(&count), "{count}");
    }

    #[test]
    fn short_slices_are_refused_by_name() {
        let find = |a: usize, b: usize, c: usize| {
            EdgeDetector::default().find(&vec![0; a], &vec![0; b], 40, 2, &mut vec![0; c]).unwrap_err().parameter
        };
        assert_eq!((find(79, 80, 4), find(80, 79, 4), find(80, 80, 3)), ("luminance", "previous", "bits"));
    }

    #[test]
    fn white_is_255_and_green_is_brighter_than_blue() {
        let mut out = [0; 3];
        luminance_line(&[255, 255, 255, 0, 200, 0, 0, 0, 200], &mut out);
        assert_eq!(out, [255, 117, 22]);
    }
}
