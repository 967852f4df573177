//! One-bit images: 32 pixels a word, pixel 0 of a row in the lowest bit of its first word.
//!
//! Invariant of both views: the bits of a row's last word beyond the image's width are zero.
//!
//! ```
//! use sinew_core::vision::mask::{MaskMut, words_per_row};
//!
//! let mut words = [0; 5 * words_per_row(40)];
//! let mut mask = MaskMut::new(&mut words, 40, 5)?;
//! mask.set(33, 2, true);
//! let view = mask.view();
//! assert!(view.get(33, 2) && !view.get(33, 3));
//! assert_eq!(view.row(2), [0, 1 << 1], "pixel 33 is bit 1 of the second word");
//! assert_eq!(view.count(), 1);
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

use crate::error::{ParameterError, Rule, positive};

/// Longest side of a mask, pixels; sums of squares over any mask of this size fit in 64 bits.
pub const MAX_SIDE_PX: usize = 8192;

/// Words that one row of `width` pixels takes.
///
/// ```
/// use sinew_core::vision::mask::words_per_row;
///
/// assert_eq!(words_per_row(640), 20);
/// assert_eq!(words_per_row(641), 21, "a row begins with a new word");
/// ```
#[must_use]
pub const fn words_per_row(width: usize) -> usize {
    width.div_ceil(32)
}

/// The bits of a row's last word that hold pixels.
#[must_use]
pub(super) const fn last_word_bits(width: usize) -> u32 {
    match width % 32 {
        0 => u32::MAX,
        rest => (1 << rest) - 1,
    }
}

fn checked_len(len: usize, width: usize, height: usize) -> Result<usize, ParameterError> {
    positive("width", width as f32)?;
    positive("height", height as f32)?;
    if width > MAX_SIDE_PX || height > MAX_SIDE_PX {
        return Err(ParameterError::new("mask side", Rule::Capacity { capacity: MAX_SIDE_PX }));
    }
    let expected = words_per_row(width) * height;
    if len < expected {
        return Err(ParameterError::new("words", Rule::SameLength { expected }));
    }
    Ok(expected)
}

/// A one-bit image that is read.
///
/// ```
/// use sinew_core::vision::mask::Mask;
///
/// // 24 rows of 32 pixels, one word each: a band of eight pixels across row 5.
/// let mut words = [0; 24];
/// words[5] = 0x0000_ff00;
/// let mask = Mask::new(&words, 32, 24)?;
/// assert!(mask.get(8, 5) && mask.get(15, 5) && !mask.get(16, 5));
/// assert_eq!(mask.count(), 8);
/// // A view as narrow as 12 pixels would hide some of them.
/// assert_eq!(
///     Mask::new(&words, 12, 24).map_err(|error| error.parameter).err(),
///     Some("bits beyond the width")
/// );
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Mask<'a> {
    words: &'a [u32],
    width: usize,
    height: usize,
}

/// A one-bit image that is written.
///
/// ```
/// use sinew_core::vision::mask::{MaskMut, words_per_row};
///
/// // What lies beyond the width is cleared.
/// let mut words = [u32::MAX; 2 * words_per_row(40)];
/// let mut mask = MaskMut::new(&mut words, 40, 2)?;
/// assert_eq!(mask.view().count(), 80);
/// mask.set(39, 1, false);
/// assert_eq!(words, [u32::MAX, 0xff, u32::MAX, 0x7f]);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug)]
pub struct MaskMut<'a> {
    words: &'a mut [u32],
    width: usize,
    height: usize,
}

impl<'a> Mask<'a> {
    /// A view of `height` rows of [`words_per_row`] words each; words beyond are left out.
    ///
    /// # Errors
    /// Sides from 1 to [`MAX_SIDE_PX`], enough words, and no bit set beyond the width.
    pub fn new(words: &'a [u32], width: usize, height: usize) -> Result<Self, ParameterError> {
        let len = checked_len(words.len(), width, height)?;
        let words = &words[..len];
        let stray = !last_word_bits(width);
        if words.chunks_exact(words_per_row(width)).any(|row| row.last().is_some_and(|word| word & stray != 0)) {
            return Err(ParameterError::new("bits beyond the width", Rule::Within { low: 0.0, high: 0.0 }));
        }
        Ok(Self { words, width, height })
    }

    /// Width, pixels.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height, pixels.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// All words, row by row.
    #[must_use]
    pub fn words(&self) -> &'a [u32] {
        self.words
    }

    /// The words of row `v`; empty beyond the image.
    #[must_use]
    pub fn row(&self, v: usize) -> &'a [u32] {
        let len = words_per_row(self.width);
        self.words.get(v.saturating_mul(len)..v.saturating_mul(len).saturating_add(len)).unwrap_or(&[])
    }

    /// All rows, from the top.
    pub fn rows(&self) -> core::slice::ChunksExact<'a, u32> {
        self.words.chunks_exact(words_per_row(self.width).max(1))
    }

    /// The pixel at column `u` and row `v`; false beyond the image.
    #[must_use]
    pub fn get(&self, u: usize, v: usize) -> bool {
        self.row(v).get(u / 32).is_some_and(|word| word >> (u % 32) & 1 == 1)
    }

    /// Number of pixels that are set.
    #[must_use]
    pub fn count(&self) -> usize {
        self.words.iter().map(|word| word.count_ones() as usize).sum()
    }
}

impl<'a> MaskMut<'a> {
    /// A view of `height` rows of [`words_per_row`] words each; bits beyond the width are cleared.
    ///
    /// # Errors
    /// Sides from 1 to [`MAX_SIDE_PX`], and enough words.
    pub fn new(words: &'a mut [u32], width: usize, height: usize) -> Result<Self, ParameterError> {
        let len = checked_len(words.len(), width, height)?;
        let mut mask = Self { words: &mut words[..len], width, height };
        mask.clear_padding();
        Ok(mask)
    }

    /// The same image, to be read.
    #[must_use]
    pub fn view(&self) -> Mask<'_> {
        Mask { words: self.words, width: self.width, height: self.height }
    }

    /// Width, pixels.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height, pixels.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// Sets the pixel at column `u` and row `v`; nothing happens beyond the image.
    pub fn set(&mut self, u: usize, v: usize, value: bool) {
        if u >= self.width || v >= self.height {
            return;
        }
        let bit = 1 << (u % 32);
        if let Some(word) = self.words.get_mut(v * words_per_row(self.width) + u / 32) {
            *word = if value { *word | bit } else { *word & !bit };
        }
    }

    /// Clears all pixels.
    pub fn clear(&mut self) {
        self.words.fill(0);
    }

    /// Lets `write` fill each row's words, given the row's number; bits beyond the width are
    /// cleared afterwards.
    pub fn write_rows(&mut self, mut write: impl FnMut(usize, &mut [u32])) {
        for (v, row) in self.words.chunks_exact_mut(words_per_row(self.width).max(1)).enumerate() {
            write(v, row);
        }
        self.clear_padding();
    }

    /// All words, for code of this crate that keeps the invariant.
    pub(super) fn words_mut(&mut self) -> &mut [u32] {
        self.words
    }

    fn clear_padding(&mut self) {
        let keep = last_word_bits(self.width);
        for row in self.words.chunks_exact_mut(words_per_row(self.width).max(1)) {
            if let Some(word) = row.last_mut() {
                *word &= keep;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
            #[test]
            fn padding_stays_zero_and_pixels_read_back(
                width in 1_usize..80, height in 1_usize..6,
                noise in prop::collection::vec(any::<u32>(), 20), u in 0_usize..90, v in 0_usize..8, value: bool,
            ) {
                let mut words = noise;
                let mut mask = MaskMut::new(&mut words, width, height).unwrap();
                mask.set(u, v, value);
    prop_assert_eq!(mask.view().get(u, v), value && u < width && v < height);
                let pixels = (0..height).flat_map(|v| (0..width).map(move |u| (u, v)));
                prop_assert_eq!(mask.view().count(), pixels.filter(|&(u, v)| mask.view().get(u, v)).count());
                mask.write_rows(|_, row| row.fill(u32::MAX));
                prop_assert_eq!(mask.view().count(), width * height);
                prop_assert!(Mask::new(&words, width, height).is_ok());
            }
        }

    #[test]
    fn wrong_sizes_and_stray_bits_are_refused() {
        assert_eq!(Mask::new(&[0], 0, 1).unwrap_err().parameter, "width");
        assert_eq!(Mask::new(&[0], 33, 1).unwrap_err().rule, Rule::SameLength { expected: 2 });
        assert_eq!(Mask::new(&[8], 3, 1).unwrap_err().parameter, "bits beyond the width");
        assert!(Mask::new(&[7], 3, 1).is_ok());
        assert!(Mask::new(&[], MAX_SIDE_PX + 1, 1).is_err());
    }
}
