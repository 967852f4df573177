//! What has the colour of skin and never moves, before a camera that stands still: background.
//!
//! A wall or a shelf that is as it was for a second is no hand. Something that comes and stays
//! is never learned, unless what was there before had the colour of skin, too: so a hand may rest
//! before a wall of another colour.

use crate::error::{Error, Result, ensure};
use crate::pixels::{Picture, Pixels};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use sinew_core::vision::mask::words_per_row;
use sinew_core::vision::skin::SkinClassifier;
use std::cell::Cell;

/// Greatest difference of a channel from what is usual there, levels. Chosen: five standard
/// deviations of a webcam's noise.
const MAX_FROM_USUAL: u8 = 12;
/// What stays for so long is background, seconds. Chosen on seeds 100 to 260 of `sinew demo`: of
/// the frames that say `tracking` 0.8 % are wrong, with two seconds 1.2 %.
const LEARNING_S: f64 = 1.0;
/// One of so many pixels is looked at for colours.
const SKIPPED: usize = 4;
/// Bytes of a pixel's state.
const BYTES: usize = 5;

/// What is usual at each pixel of the pictures that one camera takes.
///
/// ```
/// use image::{Rgb, RgbImage};
/// use sinew::skin::{Background, SkinModel};
///
/// let skin = SkinModel::from_option("histogram")?;
/// let wall = RgbImage::from_pixel(8, 8, Rgb([196, 140, 115]));
/// let mut background = Background::new(15.0);
/// (0..14).for_each(|_| background.see(&wall, &skin));
/// assert!(!background.is_background(3, 3));
/// background.see(&wall, &skin);
/// assert!(background.is_background(3, 3), "after a second");
/// # Ok::<(), sinew::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Background {
    /// Frames in which it is learned.
    frames: u8,
    /// Of each pixel: R, G, B as usual, frames that were like it, frames since the last of these.
    pixels: Vec<[u8; BYTES]>,
    /// One bit a pixel, row by row: background in the last picture.
    mask: Vec<u32>,
    words: usize,
}

impl Background {
    /// Before the first of so many pictures a second.
    #[must_use]
    pub fn new(rate_hz: f64) -> Self {
        let frames = (LEARNING_S * rate_hz).round().clamp(1.0, f64::from(u8::MAX - 1)) as u8;
        Self { frames, pixels: Vec::new(), mask: Vec::new(), words: 0 }
    }

    /// Takes a picture; one of another size begins anew.
    pub fn see(&mut self, image: &Picture<impl Pixels>, skin: &impl SkinClassifier) {
        let (width, now) = (image.width() as usize, image.as_raw().as_chunks::<3>().0);
        let words = words_per_row(width);
        if self.pixels.len() != now.len() || self.words != words {
            self.pixels = now.iter().map(|&[r, g, b]| [r, g, b, 0, 0]).collect();
            self.words = words;
        }
        self.mask.clear();
        self.mask.resize(words * image.height() as usize, 0);
        let lines = self.pixels.chunks_mut(width.max(1)).zip(now.chunks(width.max(1)));
        for ((pixels, now), row) in lines.zip(self.mask.chunks_mut(words.max(1))) {
            for (u, (pixel, now)) in pixels.iter_mut().zip(now).enumerate() {
                row[u / 32] |= u32::from(learn(pixel, *now, self.frames, skin)) << (u % 32);
            }
        }
    }

    /// Forgets all.
    pub fn forget(&mut self) {
        (self.pixels, self.mask, self.words) = (Vec::new(), Vec::new(), 0);
    }

    /// Whether the pixel in this column and row is background in the last picture.
    #[must_use]
    pub fn is_background(&self, u: usize, v: usize) -> bool {
        self.mask.get(v * self.words + u / 32).is_some_and(|word| word >> (u % 32) & 1 == 1)
    }

    /// Of each pixel whose background was learned: its usual colour, and the colour of the last
    /// picture, `image`, if that hides it.
    pub fn learned<'a>(
        &'a self,
        image: &'a Picture<impl Pixels>,
    ) -> impl Iterator<Item = ([u8; 3], Option<[u8; 3]>)> + 'a {
        let pixels = self.pixels.iter().zip(image.as_raw().as_chunks::<3>().0).step_by(SKIPPED);
        let learned = pixels.filter(|([.., alike, _], _)| *alike >= self.frames);
        learned.map(|([r, g, b, _, other], now)| ([*r, *g, *b], (*other > 0).then_some(*now)))
    }

    /// What `skin` says of the last picture but for the background. For one pass over its lines,
    /// from the top.
    pub fn without<'a, S>(&'a self, skin: &'a S) -> Foreground<'a, S> {
        Foreground { skin, background: self, row: Cell::new(0) }
    }

    /// The state as text, which [`Background::restore`] takes.
    #[must_use]
    pub fn saved(&self) -> String {
        STANDARD.encode(self.pixels.as_flattened())
    }

    /// Goes on from a state that was saved with pictures of so many columns.
    ///
    /// # Errors
    /// The text is not whole.
    pub fn restore(&mut self, saved: &str, width: u32) -> Result<()> {
        let bytes = STANDARD.decode(saved).map_err(Error::invalid)?;
        let (pixels, rest) = bytes.as_chunks::<BYTES>();
        ensure!(rest.is_empty(), "the background that the run left is not whole; begin the run anew");
        (self.pixels, self.words) = (pixels.to_vec(), words_per_row(width as usize));
        Ok(())
    }
}

/// Takes a pixel as it is now; whether it is background.
fn learn(pixel: &mut [u8; BYTES], now: [u8; 3], frames: u8, skin: &impl SkinClassifier) -> bool {
    let [r, g, b, alike, other] = *pixel;
    let usual = [r, g, b];
    if usual.iter().zip(now).all(|(usual, now)| usual.abs_diff(now) <= MAX_FROM_USUAL) {
        let alike = alike.saturating_add(1).min(frames);
        *pixel = [r, g, b, alike, 0];
        return alike >= frames;
    }
    *pixel = [r, g, b, alike, other.saturating_add(1)];
    if other.saturating_add(1) >= frames {
        let is_skin = |rgb: [u8; 3]| {
            let mut bits = [0];
            skin.classify_line(&rgb, &mut bits);
            bits[0] & 1 == 1
        };
        *pixel = [r, g, b, alike, 0];
        if is_skin(usual) || !is_skin(now) {
            *pixel = [now[0], now[1], now[2], 0, 0];
        }
    }
    false
}

/// Skin that is no background.
#[derive(Debug)]
pub struct Foreground<'a, S> {
    skin: &'a S,
    background: &'a Background,
    row: Cell<usize>,
}

impl<S: SkinClassifier> SkinClassifier for Foreground<'_, S> {
    fn classify_line(&self, rgb: &[u8], bits: &mut [u32]) {
        self.skin.classify_line(rgb, bits);
        let (row, words) = (self.row.get(), self.background.words);
        self.row.set(row + 1);
        let background = self.background.mask.get(row * words..(row + 1) * words).unwrap_or(&[]);
        bits.iter_mut().zip(background).for_each(|(word, background)| *word &= !background);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skin::SkinModel;
    use image::{Rgb, RgbImage};

    const SKIN: [u8; 3] = [196, 140, 115];
    const BLUE: [u8; 3] = [60, 90, 140];
    const SHELF: [u8; 3] = [150, 100, 75];

    fn show(background: &mut Background, colour: [u8; 3], frames: usize) -> bool {
        let skin = SkinModel::from_option("histogram").unwrap();
        (0..frames).for_each(|_| background.see(&RgbImage::from_pixel(40, 2, Rgb(colour)), &skin));
        background.is_background(39, 1)
    }

    #[test]
    fn a_hand_that_comes_stays_and_what_it_uncovers_is_learned() {
        let mut background = Background::new(10.0);
        assert!(show(&mut background, BLUE, 20));
        assert!(!show(&mut background, SKIN, 205), "it came to a place that is no skin");
        let hand = RgbImage::from_pixel(40, 2, Rgb(SKIN));
        assert!(background.learned(&hand).eq([(BLUE, Some(SKIN)); 20]), "each fourth pixel");
        assert!(show(&mut background, BLUE, 1) && background.learned(&hand).eq([(BLUE, None); 20]));
        let mut background = Background::new(10.0);
        assert!(show(&mut background, SKIN, 20), "it rests from the start");
        assert!(!show(&mut background, SHELF, 19) && show(&mut background, SHELF, 1), "it has gone");
        assert!(!show(&mut background, SKIN, 19), "a hand before the shelf");
    }

    #[test]
    fn background_is_no_skin_and_a_state_that_was_saved_goes_on_alike() {
        let skin = SkinModel::from_option("histogram").unwrap();
        let mut background = Background::new(10.0);
        show(&mut background, SKIN, 9);
        let mut again = Background::new(10.0);
        again.restore(&background.saved(), 40).unwrap();
        for background in [&mut background, &mut again] {
            let line = SKIN.repeat(40);
            let mut bits = [0; 2];
            background.without(&skin).classify_line(&line, &mut bits);
            assert!(show(background, SKIN, 1));
            background.without(&skin).classify_line(&line, &mut bits);
            assert_eq!(bits, [0; 2]);
        }
        assert_eq!(again, background);
        assert!(again.restore("AAAA", 40).is_err());
        background.forget();
        assert!(!background.is_background(0, 0));
    }
}
