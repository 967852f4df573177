//! Opening and closing by the 3x3 square line by line: the same pixels as [`super::morphology`],
//! four lines later.

use super::mask::last_word_bits;
use super::morphology::{join, spread};

/// One erosion or dilation of lines: keeps two of them.
#[derive(Debug, Clone)]
struct LineSweep<const ERODE: bool, const WORDS: usize> {
    /// The last two lines; number `lines - 1` is in place `(lines - 1) % 2`. Before the first line:
    /// the operation's neutral element.
    kept: [[u32; WORDS]; 2],
    /// Whether a kept line may have pixels; true for the neutral element of an erosion.
    occupied: [bool; 2],
    lines: u32,
}

/// A line and whether it has pixels; without any all bits are zero.
#[derive(Debug, Clone)]
struct Line<const WORDS: usize> {
    bits: [u32; WORDS],
    occupied: bool,
}

impl<const ERODE: bool, const WORDS: usize> LineSweep<ERODE, WORDS> {
    /// A line beyond the image.
    const OUTSIDE: [u32; WORDS] = [if ERODE { u32::MAX } else { 0 }; WORDS];

    const fn new() -> Self {
        Self { kept: [Self::OUTSIDE; 2], occupied: [ERODE; 2], lines: 0 }
    }

    fn restart(&mut self) {
        *self = Self::new();
    }

    /// Takes a line and puts the result of the line before it in its place; false where there was
    /// none.
    fn push(&mut self, line: &mut Line<WORDS>, width: usize) -> bool {
        let earlier = (self.lines & 1) as usize;
        let all = [line.occupied, self.occupied[0], self.occupied[1]];
        if let Some(occupied) = self.occupied.get_mut(earlier) {
            *occupied = line.occupied;
        }
        let stays = if ERODE { all.iter().all(|&o| o) } else { all.iter().any(|&o| o) };
        if stays {
            line.occupied = self.join(earlier, &mut line.bits, width);
        } else {
            if let Some(kept) = self.kept.get_mut(earlier) {
                *kept = line.bits;
            }
            if line.occupied {
                *line = Line { bits: [0; WORDS], occupied: false };
            }
        }
        self.lines = self.lines.saturating_add(1);
        self.lines > 1
    }

    /// Ends the image and gives the result of its last line; false where there was none.
    fn finish(&mut self, line: &mut Line<WORDS>, width: usize) -> bool {
        *line = Line { bits: Self::OUTSIDE, occupied: ERODE };
        let any = self.lines > 0;
        self.push(line, width);
        self.restart();
        any
    }

    /// Joins `bits` with both kept lines and all with their neighbours to both sides.
    ///
    /// Keeps `bits` in place of the earlier line and returns whether the result has pixels.
    fn join(&mut self, earlier: usize, bits: &mut [u32; WORDS], width: usize) -> bool {
        let outside = if ERODE { u32::MAX } else { 0 };
        let last = width.div_ceil(32).min(WORDS).saturating_sub(1);
        let pixels = last_word_bits(width);
        let [even, odd] = &mut self.kept;
        let (replaced, later) = if earlier == 0 { (even, odd) } else { (odd, even) };
        let (mut before, mut here, mut any) = (outside, outside, 0);
        // Each round takes the column of a word and finishes the word before it.
        for (i, (old, kept)) in replaced.iter_mut().zip(later.iter()).enumerate().take(last + 1) {
            let Some(&word) = bits.get(i) else { break };
            let column = join::<ERODE>(word, join::<ERODE>(*old, *kept));
            let after = if ERODE && i == last { column | !pixels } else { column };
            *old = word;
            if let Some(finished) = i.checked_sub(1).and_then(|before| bits.get_mut(before)) {
                // Most words are empty, and so are their results.
                let empty = if ERODE { here == 0 } else { before | here | after == 0 };
                let done = if empty { 0 } else { spread::<ERODE>(before, here, after) };
                *finished = done;
                any |= done;
            }
            (before, here) = (here, after);
        }
        bits.iter_mut().skip(last + 1).for_each(|word| *word = 0);
        if let Some(done) = bits.get_mut(last) {
            *done = spread::<ERODE>(before, here, outside) & pixels;
            any |= *done;
        }
        any != 0
    }
}

/// Opening and then closing by the 3x3 square for lines of up to 32 `WORDS` pixels; keeps eight
/// lines.
///
/// As [`super::morphology::open`] and [`super::morphology::close`], with the same rule for the
/// border. Lines without pixels take almost no time.
///
/// ```
/// use sinew_core::vision::line_morphology::LineMorphology;
///
/// // A square of three by three pixels and a speck, line by line.
/// let mut morphology = LineMorphology::<1>::new();
/// let (mut lines, mut pixels) = (0, 0);
/// for line in [0, 0, 0x700, 0x10_0700, 0x700, 0, 0] {
///     morphology.line(&[line], 32, |done| {
///         lines += 1;
///         pixels += done[0].count_ones();
///     });
/// }
/// assert_eq!(lines, 3, "a line is finished when four more were read");
/// morphology.finish(32, |done| pixels += done[0].count_ones());
/// assert_eq!(pixels, 9, "the speck is gone");
/// ```
#[derive(Debug, Clone)]
pub struct LineMorphology<const WORDS: usize> {
    erosion: LineSweep<true, WORDS>,
    dilation: LineSweep<false, WORDS>,
    second_dilation: LineSweep<false, WORDS>,
    second_erosion: LineSweep<true, WORDS>,
}

impl<const WORDS: usize> Default for LineMorphology<WORDS> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const WORDS: usize> LineMorphology<WORDS> {
    /// Before the first line.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            erosion: LineSweep::new(),
            dilation: LineSweep::new(),
            second_dilation: LineSweep::new(),
            second_erosion: LineSweep::new(),
        }
    }

    /// Forgets all lines.
    pub fn restart(&mut self) {
        self.erosion.restart();
        self.dilation.restart();
        self.second_dilation.restart();
        self.second_erosion.restart();
    }

    /// Takes the next line of an image of `width` pixels (bits beyond are zero) and gives a
    /// finished one, if any, to `sink`.
    pub fn line(&mut self, bits: &[u32; WORDS], width: usize, sink: impl FnMut(&[u32; WORDS])) {
        let occupied = bits.iter().fold(0, |any, word| any | word) != 0;
        let mut line = Line { bits: *bits, occupied };
        if self.erosion.push(&mut line, width) && self.dilation.push(&mut line, width) {
            self.close(&mut line, width, sink);
        }
    }

    /// Ends the image and gives its last lines to `sink`.
    pub fn finish(&mut self, width: usize, mut sink: impl FnMut(&[u32; WORDS])) {
        let mut line = Line { bits: [0; WORDS], occupied: false };
        if self.erosion.finish(&mut line, width) && self.dilation.push(&mut line, width) {
            self.close(&mut line, width, &mut sink);
        }
        if self.dilation.finish(&mut line, width) {
            self.close(&mut line, width, &mut sink);
        }
        if self.second_dilation.finish(&mut line, width) && self.second_erosion.push(&mut line, width) {
            sink(&line.bits);
        }
        if self.second_erosion.finish(&mut line, width) {
            sink(&line.bits);
        }
    }

    #[inline(always)]
    fn close(&mut self, opened: &mut Line<WORDS>, width: usize, mut sink: impl FnMut(&[u32; WORDS])) {
        if self.second_dilation.push(opened, width) && self.second_erosion.push(opened, width) {
            sink(&opened.bits);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vision::mask::{Mask, MaskMut, words_per_row};
    use crate::vision::morphology::{close, open, scratch_words};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn lines_equal_the_whole_image(
            width in 1_usize..101, height in 1_usize..14, density in 0_u32..4,
            noise in prop::collection::vec(any::<[u32; 2]>(), 4 * 14), empty in prop::collection::vec(any::<bool>(), 14),
        ) {
            let len = words_per_row(width);
            let mut words: Vec<u32> = noise[..len * height].iter().map(|&[a, b]| match density {
                0 => a & b,
                1 => a,
                2 => a | b,
                _ => a | b | b.rotate_left(7) | a.rotate_left(3),
            }).collect();
            words.chunks_exact_mut(len).zip(empty).filter(|(_, e)| *e).for_each(|(row, _)| row.fill(0));
            let mut scratch = vec![0; scratch_words(width)];
            let mut mask = MaskMut::new(&mut words, width, height).unwrap();
            let mut lines = LineMorphology::<4>::new();
            let mut found: Vec<[u32; 4]> = Vec::new();
            // Twice, since a second image must not see the first.
            for _ in 0..2 {
                found.clear();
                for row in mask.view().rows() {
                    let mut bits = [0; 4];
                    bits[..len].copy_from_slice(row);
                    lines.line(&bits, width, |line| found.push(*line));
                }
                lines.finish(width, |line| found.push(*line));
            }
            open(&mut mask, &mut scratch).unwrap();
            close(&mut mask, &mut scratch).unwrap();
            let wanted: Mask<'_> = mask.view();
            prop_assert_eq!(found.len(), height);
            for (line, row) in found.iter().zip(wanted.rows()) {
                prop_assert_eq!(&line[..len], row);
                prop_assert!(line[len..].iter().all(|&word| word == 0));
            }
        }
    }
}
