//! A one-bit image that owns its words, laid out as the core's masks.

use anyhow::Result;
use image::{GrayImage, Luma};
use sinew_core::vision::frame::{DEFAULT_CLOSING_FRACTION, closing_steps};
use sinew_core::vision::mask::{Mask, MaskMut, words_per_row};
use sinew_core::vision::morphology::{close_by, open, scratch_words};

/// A one-bit image, 32 pixels a word; see [`sinew_core::vision::mask`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BitImage {
    words: Vec<u32>,
    width: usize,
    height: usize,
}

impl BitImage {
    /// An image of `width` x `height` pixels, all clear.
    ///
    /// # Errors
    /// Sides from 1 to the core's largest.
    pub fn new(width: usize, height: usize) -> Result<Self> {
        let mut words = vec![0; words_per_row(width).saturating_mul(height)];
        MaskMut::new(&mut words, width, height)?;
        Ok(Self { words, width, height })
    }

    /// Sets each pixel of `mask` that is brighter than `above`.
    ///
    /// # Errors
    /// As [`BitImage::new`].
    pub fn from_gray(mask: &GrayImage, above: u8) -> Result<Self> {
        let mut bits = Self::new(mask.width() as usize, mask.height() as usize)?;
        let row_len = words_per_row(bits.width).max(1);
        for (row, pixels) in bits.words.chunks_exact_mut(row_len).zip(mask.rows()) {
            for (u, pixel) in pixels.enumerate() {
                row[u / 32] |= u32::from(pixel.0[0] > above) << (u % 32);
            }
        }
        Ok(bits)
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

    /// The packed words, row by row.
    #[must_use]
    pub fn words(&self) -> &[u32] {
        &self.words
    }

    /// The packed words of each row, to be filled; bits beyond the width have to stay zero.
    pub(super) fn rows_mut(&mut self) -> std::slice::ChunksExactMut<'_, u32> {
        self.words.chunks_exact_mut(words_per_row(self.width).max(1))
    }

    /// The core's view of it.
    ///
    /// # Errors
    /// None in practice: the sizes were checked when it was made.
    pub fn view(&self) -> Result<Mask<'_>> {
        Ok(Mask::new(&self.words, self.width, self.height)?)
    }

    /// Opening by the 3x3 square, then a closing in proportion to the width: the morphology of the tracker.
    ///
    /// # Errors
    /// None in practice: the scratch memory fits.
    pub fn clean(&mut self) -> Result<()> {
        let mut scratch = vec![0; scratch_words(self.width)];
        let mut mask = MaskMut::new(&mut self.words, self.width, self.height)?;
        open(&mut mask, &mut scratch)?;
        close_by(&mut mask, closing_steps(self.width, DEFAULT_CLOSING_FRACTION), &mut scratch)?;
        Ok(())
    }

    /// An 8-bit image, 255 where a pixel is set and 0 elsewhere.
    #[must_use]
    pub fn to_gray(&self) -> GrayImage {
        let row_len = words_per_row(self.width);
        GrayImage::from_fn(self.width as u32, self.height as u32, |u, v| {
            let word = self.words[v as usize * row_len + u as usize / 32];
            Luma([if word >> (u % 32) & 1 == 1 { 255 } else { 0 }])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gray_and_back_is_the_same_picture() {
        let gray = GrayImage::from_fn(67, 5, |u, v| Luma([if (u * 7 + v * 3) % 5 < 2 { 255 } else { 0 }]));
        let bits = BitImage::from_gray(&gray, 127).unwrap();
        assert_eq!(bits.to_gray(), gray);
        let set = gray.pixels().filter(|pixel| pixel.0[0] == 255).count();
        assert_eq!(bits.view().unwrap().count(), set);
    }

    #[test]
    fn cleaning_removes_a_speck_and_keeps_a_square() {
        let gray = GrayImage::from_fn(40, 20, |u, v| {
            let square = (5..15).contains(&u) && (5..15).contains(&v) && (u, v) != (9, 9);
            Luma([if square || (u, v) == (30, 10) { 255 } else { 0 }])
        });
        let mut bits = BitImage::from_gray(&gray, 127).unwrap();
        bits.clean().unwrap();
        let view = bits.view().unwrap();
        assert!(!view.get(30, 10) && view.get(5, 5) && view.get(14, 14));
    }
}
