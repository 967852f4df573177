//! Skin-coloured or not, by one look-up a pixel in a table of 65536 bits.

use super::pixel_format::{PixelFormat, odd_pair};
use crate::vision::skin::{PIXELS_PER_WORD, SkinClassifier};
use core::marker::PhantomData;
use core::ops::Range;

/// Words of a table: one bit a key, 8 KiB.
pub const TABLE_WORDS: usize = 1 << 11;

/// Colours that are judged together.
const GROUP: usize = 8;

/// One decision bit for each of the 65536 keys of a [`PixelFormat`]: bit `key % 32` of word `key /
/// 32`.
///
/// Learned from a skin model when the program starts or the model changes, or generated and put in
/// flash.
///
/// ```
/// use sinew_core::vision::front_end::{pixel_format::Rgb565, skin_table::SkinTable};
/// use sinew_core::vision::skin::GaussianSkin;
///
/// let mut table = SkinTable::<Rgb565>::new();
/// table.learn(&GaussianSkin::new(0.44, 0.31, [0.0030, -0.0008, 0.0010], 2.0, 60)?);
/// let (hand, wall) =
///     (200 >> 3 << 11 | 140 >> 2 << 5 | 110 >> 3, 20 >> 3 << 11 | 40 >> 2 << 5 | 90 >> 3);
/// let mut bits = [0];
/// table.classify_line(&[wall, hand, hand, wall], &mut bits);
/// assert_eq!(bits, [0b0110]);
/// // Its words can be written into a program and used from flash.
/// let stored = SkinTable::<Rgb565>::from_words(*table.words());
/// assert!(stored.is_skin(hand) && !stored.is_skin(wall));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
pub struct SkinTable<F> {
    words: [u32; TABLE_WORDS],
    format: PhantomData<F>,
}

impl<F: PixelFormat> Default for SkinTable<F> {
    fn default() -> Self {
        Self::new()
    }
}

impl<F: PixelFormat> SkinTable<F> {
    /// A table without skin.
    #[must_use]
    pub const fn new() -> Self {
        Self::from_words([0; TABLE_WORDS])
    }

    /// A table from stored words.
    #[must_use]
    pub const fn from_words(words: [u32; TABLE_WORDS]) -> Self {
        Self { words, format: PhantomData }
    }

    /// The bits.
    #[must_use]
    pub const fn words(&self) -> &[u32; TABLE_WORDS] {
        &self.words
    }

    /// The bits, to be changed.
    #[must_use]
    pub const fn words_mut(&mut self) -> &mut [u32; TABLE_WORDS] {
        &mut self.words
    }

    /// Takes over the decisions of `skin` on the colours in the middle of all cells.
    pub fn learn(&mut self, skin: &impl SkinClassifier) {
        self.learn_words(skin, 0..TABLE_WORDS);
    }

    /// Takes over a part of the decisions, the `words` of [`TABLE_WORDS`].
    ///
    /// A new model can thus be learned in the pauses of several frames.
    pub fn learn_words(&mut self, skin: &impl SkinClassifier, words: Range<usize>) {
        self.learn_some(skin, words, usize::MAX);
    }

    /// The same until so many colours had to be judged one by one. Returns the word to go on with.
    pub fn learn_some(&mut self, skin: &impl SkinClassifier, words: Range<usize>, max_judged: usize) -> usize {
        let from = words.start.min(TABLE_WORDS);
        let to = words.end.clamp(from, TABLE_WORDS);
        let mut judged = 0;
        for (index, word) in self.words.iter_mut().enumerate().take(to).skip(from) {
            if judged >= max_judged {
                return index;
            }
            *word = 0;
            for place in (0..PIXELS_PER_WORD).step_by(GROUP) {
                let first = (index * PIXELS_PER_WORD + place) as u16;
                let (low, high) = F::range(first..=first | (GROUP - 1) as u16);
                if skin.is_none_skin(low, high) {
                    continue;
                }
                let (mut rgb, mut bits) = ([0; 3 * GROUP], [0]);
                for (key, pixel) in (first..=first | (GROUP - 1) as u16).zip(rgb.as_chunks_mut::<3>().0) {
                    *pixel = F::rgb(key);
                }
                skin.classify_line(&rgb, &mut bits);
                *word |= bits[0] << place;
                judged += GROUP;
            }
        }
        to
    }

    /// Whether a key's colour counts as skin.
    #[inline]
    #[must_use]
    pub fn is_skin(&self, key: u16) -> bool {
        self.at(key) & 1 == 1
    }

    /// Writes one bit a pixel of `line` into `bits`, lowest bit first; bits beyond the line become
    /// zero.
    pub fn classify_line(&self, line: &[u16], bits: &mut [u32]) {
        let (whole, rest) = line.as_chunks::<PIXELS_PER_WORD>();
        let count = whole.len().min(bits.len());
        let (first, last) = bits.split_at_mut(count);
        for (word, block) in first.iter_mut().zip(whole) {
            *word = self.classify_block(block);
        }
        if let Some((word, beyond)) = last.split_first_mut() {
            *word = 0;
            beyond.fill(0);
            let (pairs, _) = rest.as_chunks::<2>();
            let judged = 2 * pairs.len() as u32;
            if judged > 0 {
                *word = self.classify_pairs(pairs) >> (PIXELS_PER_WORD as u32 - judged);
            }
            if let Some(pair) = odd_pair(line) {
                *word |= u32::from(self.is_skin(F::keys(pair)[0])) << judged;
            }
        }
    }

    /// Bits of a word's pixels.
    #[inline]
    fn classify_block(&self, block: &[u16; PIXELS_PER_WORD]) -> u32 {
        let [a, b, c, d, e, f, g, h] = block.as_chunks::<4>().0 else { return 0 };
        // Unrolled: with a constant place, four pixels without skin take only the look-up.
        let bits = self.with_four(0, a, 0);
        let bits = self.with_four(bits, b, 4);
        let bits = self.with_four(bits, c, 8);
        let bits = self.with_four(bits, d, 12);
        let bits = self.with_four(bits, e, 16);
        let bits = self.with_four(bits, f, 20);
        let bits = self.with_four(bits, g, 24);
        self.with_four(bits, h, 28)
    }

    /// `bits` with those of four pixels from `place` on.
    ///
    /// Most words of a table are zero, so most often their union decides all four.
    #[inline]
    fn with_four(&self, bits: u32, four: &[u16; 4], place: u32) -> u32 {
        let &[left, right] = four.as_chunks::<2>().0 else { return bits };
        let ([a, b], [c, d]) = (F::keys(left), F::keys(right));
        let [in_a, in_b, in_c, in_d] = [a, b, c, d].map(|key| self.words[usize::from(key >> 5)]);
        if in_a | in_b | in_c | in_d == 0 {
            return bits;
        }
        let bit = |word: u32, key: u16| word.rotate_right(u32::from(key)) & 1;
        bits | (bit(in_a, a) | bit(in_b, b) << 1 | bit(in_c, c) << 2 | bit(in_d, d) << 3) << place
    }

    /// Bits of up to 16 pairs, the last one in the highest bit.
    #[inline]
    fn classify_pairs(&self, pairs: &[[u16; 2]]) -> u32 {
        let mut bits = 0;
        for &pair in pairs {
            for key in F::keys(pair) {
                bits = bits >> 1 | self.at(key) << 31;
            }
        }
        bits
    }

    /// The word of a key, turned so that the key's bit is the lowest.
    #[inline]
    fn at(&self, key: u16) -> u32 {
        self.words[usize::from(key >> 5)].rotate_right(u32::from(key))
    }
}

#[cfg(test)]
mod tests {
    use super::super::pixel_format::{Rgb565, SwappedRgb565, Yuyv};
    use super::*;
    use crate::vision::skin::GaussianSkin;
    use proptest::prelude::*;

    fn model() -> GaussianSkin {
        GaussianSkin::new(0.44, 0.31, [0.0030, -0.0008, 0.0010], 2.0, 60).unwrap()
    }

    fn learned<F: PixelFormat>() -> SkinTable<F> {
        let mut table = SkinTable::new();
        table.learn(&model());
        table
    }

    fn agrees<F: PixelFormat>(line: &[u16], words: usize) -> bool {
        let table = learned::<F>();
        let mut bits = vec![u32::MAX; words];
        table.classify_line(line, &mut bits);
        (0..32 * words).all(|u| {
            let bit = bits[u / 32] >> (u % 32) & 1 == 1;
            let pair = match (line.get(u & !1), line.get(u | 1)) {
                (Some(&left), Some(&right)) => [left, right],
                (Some(&left), None) => [left, line[u.saturating_sub(1)]],
                (None, _) => return !bit,
            };
            u < line.len() && bit == table.is_skin(F::keys(pair)[u & 1]) || u >= line.len() && !bit
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]
        #[test]
        fn a_line_equals_its_pixels(line in prop::collection::vec(any::<u16>(), 0..100), words in 0_usize..5) {
            prop_assert!(agrees::<Rgb565>(&line, words));
            prop_assert!(agrees::<SwappedRgb565>(&line, words));
            prop_assert!(agrees::<Yuyv>(&line, words));
        }
    }

    #[test]
    fn the_table_decides_as_the_model_in_the_middle_of_every_cell() {
        let (plain, video) = (learned::<Rgb565>(), learned::<Yuyv>());
        let decides = |rgb: [u8; 3]| {
            let mut word = [0];
            model().classify_line(&rgb, &mut word);
            word[0] == 1
        };
        assert!((0..=u16::MAX).all(|key| plain.is_skin(key) == decides(Rgb565::rgb(key))));
        assert!((0..=u16::MAX).all(|key| video.is_skin(key) == decides(Yuyv::rgb(key))));
        let skin = (0..=u16::MAX).filter(|&key| plain.is_skin(key)).count();
        assert!((1000..20_000).contains(&skin), "{skin} of 65536 colours");
    }

    #[test]
    fn a_table_learns_in_parts() {
        let mut parts = SkinTable::<Rgb565>::new();
        for first in (0..TABLE_WORDS).step_by(300) {
            parts.learn_words(&model(), first..first + 300);
        }
        assert_eq!(parts.words(), learned::<Rgb565>().words());
        parts.learn_words(&model(), 5000..6000);
        let reversed = Range { start: 9, end: 2 };
        parts.learn_words(&model(), reversed);
        assert_eq!(parts.words(), learned::<Rgb565>().words());
    }
}
