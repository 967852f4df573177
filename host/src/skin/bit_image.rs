//! The words of a one-bit image; the image itself is the core's mask.

use crate::error::Result;
use image::{GrayImage, Luma};
use sinew_core::vision::frame::{DEFAULT_CLOSING_FRACTION, closing_steps};
use sinew_core::vision::mask::{Mask, MaskMut, words_per_row};
use sinew_core::vision::morphology::{close_by, open, scratch_words};

/// A one-bit image that owns its words; pixels are read and written by the views of
/// [`sinew_core::vision::mask`].
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
        bits.view_mut()?.write_rows(|v, row| {
            for u in 0..mask.width() {
                row[u as usize / 32] |= u32::from(mask.get_pixel(u, v as u32).0[0] > above) << (u % 32);
            }
        });
        Ok(bits)
    }

    /// The packed words, row by row.
    #[must_use]
    pub fn words(&self) -> &[u32] {
        &self.words
    }

    /// The core's view of it, to be read.
    ///
    /// # Errors
    /// None in practice: the sizes were checked when it was made.
    pub fn view(&self) -> Result<Mask<'_>> {
        Ok(Mask::new(&self.words, self.width, self.height)?)
    }

    /// The core's view of it, to be written.
    ///
    /// # Errors
    /// None in practice: the sizes were checked when it was made.
    pub fn view_mut(&mut self) -> Result<MaskMut<'_>> {
        Ok(MaskMut::new(&mut self.words, self.width, self.height)?)
    }

    /// Opening by the 3x3 square, then a closing in proportion to the width: the morphology of the
    /// tracker.
    ///
    /// # Errors
    /// None in practice: the scratch memory fits.
    pub fn clean(&mut self) -> Result<()> {
        let mut scratch = vec![0; scratch_words(self.width)];
        let steps = closing_steps(self.width, DEFAULT_CLOSING_FRACTION);
        let mut mask = self.view_mut()?;
        open(&mut mask, &mut scratch)?;
        close_by(&mut mask, steps, &mut scratch)?;
        Ok(())
    }

    /// An 8-bit image, 255 where a pixel is set and 0 elsewhere.
    #[must_use]
    pub fn to_gray(&self) -> GrayImage {
        let row_len = words_per_row(self.width);
        let is_set = |u: u32, v: u32| self.words[v as usize * row_len + u as usize / 32] >> (u % 32) & 1 == 1;
        GrayImage::from_fn(self.width as u32, self.height as u32, |u, v| Luma([if is_set(u, v) { 255 } else { 0 }]))
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
