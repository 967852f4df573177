//! Erosion, dilation, opening and closing by the 3x3 square, 32 pixels at a time and in place.
//!
//! Border rule: what lies outside of the image counts as background for dilation and as foreground
//! for erosion, that is, it has no influence. Erosion and dilation are then adjoint: an opening
//! never adds a pixel, a closing never removes one, and both are idempotent.
//!
//! ```
//! use sinew_core::vision::mask::{MaskMut, words_per_row};
//! use sinew_core::vision::morphology::{open, scratch_words};
//!
//! let mut words = [0; 20 * words_per_row(40)];
//! let mut mask = MaskMut::new(&mut words, 40, 20)?;
//! mask.set(3, 3, true); // a speck
//! for v in 8..14 {
//!     for u in 10..30 {
//!         mask.set(u, v, true);
//!     }
//! }
//! open(&mut mask, &mut [0; scratch_words(40)])?;
//! assert!(!mask.view().get(3, 3), "the speck is gone");
//! assert_eq!(mask.view().count(), 6 * 20, "the rest stays");
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

use super::mask::{MaskMut, last_word_bits, words_per_row};
use crate::error::{ParameterError, Rule};

/// Words of scratch for a mask of `width` pixels: three rows.
///
/// ```
/// use sinew_core::vision::mask::words_per_row;
/// use sinew_core::vision::morphology::scratch_words;
///
/// // Known when the program is compiled, so that it can be a static array.
/// static SCRATCH: [u32; scratch_words(320)] = [0; scratch_words(320)];
/// assert_eq!(SCRATCH.len(), 3 * words_per_row(320));
/// ```
#[must_use]
pub const fn scratch_words(width: usize) -> usize {
    3 * words_per_row(width)
}

/// Keeps a pixel where it and all of its up to eight neighbours are set.
///
/// ```
/// use sinew_core::vision::mask::MaskMut;
/// use sinew_core::vision::morphology::{erode, scratch_words};
///
/// // Of a square of three by three pixels its middle stays.
/// let mut rows = [0, 0x700, 0x700, 0x700, 0];
/// erode(&mut MaskMut::new(&mut rows, 32, 5)?, &mut [0; scratch_words(32)])?;
/// assert_eq!(rows, [0, 0, 0x200, 0, 0]);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
///
/// # Errors
/// `scratch` needs [`scratch_words`].
pub fn erode(mask: &mut MaskMut<'_>, scratch: &mut [u32]) -> Result<(), ParameterError> {
    sweep::<true>(mask, scratch)
}

/// Sets a pixel where it or one of its up to eight neighbours is set.
///
/// ```
/// use sinew_core::vision::mask::MaskMut;
/// use sinew_core::vision::morphology::{dilate, scratch_words};
///
/// // A pixel becomes a square of three by three.
/// let mut rows = [0, 0, 0x200, 0, 0];
/// dilate(&mut MaskMut::new(&mut rows, 32, 5)?, &mut [0; scratch_words(32)])?;
/// assert_eq!(rows, [0, 0x700, 0x700, 0x700, 0]);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
///
/// # Errors
/// `scratch` needs [`scratch_words`].
pub fn dilate(mask: &mut MaskMut<'_>, scratch: &mut [u32]) -> Result<(), ParameterError> {
    sweep::<false>(mask, scratch)
}

/// Erosion, then dilation: removes what a 3x3 square does not fit into.
///
/// ```
/// use sinew_core::vision::mask::MaskMut;
/// use sinew_core::vision::morphology::{open, scratch_words};
///
/// // A speck goes, a square of three by three stays as it is.
/// let mut rows = [0, 0x700, 0x10_0700, 0x700, 0];
/// open(&mut MaskMut::new(&mut rows, 32, 5)?, &mut [0; scratch_words(32)])?;
/// assert_eq!(rows, [0, 0x700, 0x700, 0x700, 0]);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
///
/// # Errors
/// `scratch` needs [`scratch_words`].
pub fn open(mask: &mut MaskMut<'_>, scratch: &mut [u32]) -> Result<(), ParameterError> {
    erode(mask, scratch)?;
    dilate(mask, scratch)
}

/// Dilation, then erosion: fills background that a 3x3 square does not fit into.
///
/// ```
/// use sinew_core::vision::mask::MaskMut;
/// use sinew_core::vision::morphology::{close, scratch_words};
///
/// // A hole is filled, the outline stays as it is.
/// let mut rows = [0, 0, 0x700, 0x500, 0x700, 0, 0];
/// close(&mut MaskMut::new(&mut rows, 32, 7)?, &mut [0; scratch_words(32)])?;
/// assert_eq!(rows, [0, 0, 0x700, 0x700, 0x700, 0, 0]);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
///
/// # Errors
/// `scratch` needs [`scratch_words`].
pub fn close(mask: &mut MaskMut<'_>, scratch: &mut [u32]) -> Result<(), ParameterError> {
    dilate(mask, scratch)?;
    erode(mask, scratch)
}

/// `steps` dilations, then as many erosions: closing by a square of 2 `steps` + 1 pixels.
///
/// ```
/// use sinew_core::vision::mask::MaskMut;
/// use sinew_core::vision::morphology::{close_by, scratch_words};
///
/// // Two bars, three pixels apart: a closing by five pixels joins them, one by three does not.
/// let bars = [0b111_1000_1111 << 8; 7];
/// for (steps, joined) in [(1, bars[3]), (2, 0b111_1111_1111 << 8)] {
///     let mut rows = bars;
///     close_by(&mut MaskMut::new(&mut rows, 32, 7)?, steps, &mut [0; scratch_words(32)])?;
///     assert_eq!(rows[3], joined);
/// }
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
///
/// # Errors
/// `scratch` needs [`scratch_words`].
pub fn close_by(mask: &mut MaskMut<'_>, steps: u8, scratch: &mut [u32]) -> Result<(), ParameterError> {
    (0..steps).try_for_each(|_| dilate(mask, scratch))?;
    (0..steps).try_for_each(|_| erode(mask, scratch))
}

#[inline]
pub(super) fn join<const ERODE: bool>(a: u32, b: u32) -> u32 {
    if ERODE { a & b } else { a | b }
}

/// Joins a word with its copies shifted by one pixel to either side, given the words before and
/// after it.
#[inline]
pub(super) fn spread<const ERODE: bool>(before: u32, word: u32, after: u32) -> u32 {
    join::<ERODE>(join::<ERODE>(word, word << 1 | before >> 31), word >> 1 | after << 31)
}

/// Joins a row with its copies shifted by one pixel to either side.
fn spread_row<const ERODE: bool>(row: &[u32], padding: u32, to: &mut [u32]) {
    let outside = if ERODE { u32::MAX } else { 0 };
    let last = row.len().saturating_sub(1);
    let mut before = outside;
    for (i, (&word, out)) in row.iter().zip(to.iter_mut()).enumerate() {
        let word = if ERODE && i == last { word | padding } else { word };
        let after = match row.get(i + 1) {
            Some(&next) => next,
            None => outside,
        };
        *out = spread::<ERODE>(before, word, after);
        before = word;
    }
}

fn sweep<const ERODE: bool>(mask: &mut MaskMut<'_>, scratch: &mut [u32]) -> Result<(), ParameterError> {
    let (width, height, len) = (mask.width(), mask.height(), words_per_row(mask.width()));
    let Some(scratch) = scratch.get_mut(..scratch_words(width)) else {
        return Err(ParameterError::new("scratch", Rule::SameLength { expected: scratch_words(width) }));
    };
    let (above, rest) = scratch.split_at_mut(len);
    let (here, below) = rest.split_at_mut(len);
    let (mut above, mut here, mut below) = (above, here, below);
    let outside = if ERODE { u32::MAX } else { 0 };
    let pixels = last_word_bits(width);
    let words = mask.words_mut();
    above.fill(outside);
    spread_row::<ERODE>(words.get(..len).unwrap_or(&[]), !pixels, here);
    for v in 0..height {
        match words.get((v + 1) * len..(v + 2) * len) {
            Some(next) => spread_row::<ERODE>(next, !pixels, below),
            None => below.fill(outside),
        }
        let Some(row) = words.get_mut(v * len..(v + 1) * len) else { break };
        for (((out, a), h), b) in row.iter_mut().zip(above.iter()).zip(here.iter()).zip(below.iter()) {
            *out = join::<ERODE>(join::<ERODE>(*a, *h), *b);
        }
        if let Some(word) = row.last_mut() {
            *word &= pixels;
        }
        (above, here, below) = (here, below, above);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vision::mask::Mask;
    use proptest::prelude::*;

    type Operation = fn(&mut MaskMut<'_>, &mut [u32]) -> Result<(), ParameterError>;

    fn apply(operation: Operation, words: &[u32], width: usize, height: usize) -> Vec<u32> {
        let mut words = words.to_vec();
        let mut scratch = vec![0xdead_beef; scratch_words(width)];
        operation(&mut MaskMut::new(&mut words, width, height).unwrap(), &mut scratch).unwrap();
        words
    }

    fn naive(words: &[u32], width: usize, height: usize, erosion: bool) -> Vec<u32> {
        let from = Mask::new(words, width, height).unwrap();
        let mut to = vec![0; words.len()];
        let mut out = MaskMut::new(&mut to, width, height).unwrap();
        for v in 0..height {
            for u in 0..width {
                let around = (v.saturating_sub(1)..=(v + 1).min(height - 1))
                    .flat_map(|y| (u.saturating_sub(1)..=(u + 1).min(width - 1)).map(move |x| (x, y)));
                let mut pixels = around.map(|(x, y)| from.get(x, y));
                let value = if erosion { pixels.all(|p| p) } else { pixels.any(|p| p) };
                out.set(u, v, value);
            }
        }
        to
    }

    fn inside(a: &[u32], b: &[u32]) -> bool {
        a.iter().zip(b).all(|(a, b)| a & !b == 0)
    }

    prop_compose! {
        fn any_mask()(width in 1_usize..101, height in 1_usize..12, density in 0_u32..4)
            (words in prop::collection::vec(any::<[u32; 2]>(), words_per_row(width) * height),
             width in Just(width), height in Just(height), density in Just(density)) -> (Vec<u32>, usize, usize) {
            let mut words: Vec<u32> = words.iter().map(|[a, b]| match density {
                0 => a & b,
                1 => *a,
                2 => a | b,
                _ => a | b | b.rotate_left(7) | a.rotate_left(3),
            }).collect();
            MaskMut::new(&mut words, width, height).unwrap();
            (words, width, height)
        }
    }

    proptest! {
        #[test]
        fn both_equal_the_definition((words, width, height) in any_mask()) {
            prop_assert_eq!(apply(erode, &words, width, height), naive(&words, width, height, true));
            prop_assert_eq!(apply(dilate, &words, width, height), naive(&words, width, height, false));
        }

        #[test]
        fn opening_and_closing_are_ordered_and_idempotent((words, width, height) in any_mask()) {
            let opened = apply(open, &words, width, height);
            let closed = apply(close, &words, width, height);
            prop_assert!(inside(&opened, &words) && inside(&words, &closed));
            prop_assert_eq!(apply(open, &opened, width, height), opened);
            prop_assert_eq!(&apply(close, &closed, width, height), &closed);
            let wide: Operation = |mask, scratch| close_by(mask, 3, scratch);
            let wider = apply(wide, &words, width, height);
            prop_assert!(inside(&closed, &wider));
            prop_assert_eq!(&apply(wide, &wider, width, height), &wider);
            prop_assert!(Mask::new(&closed, width, height).is_ok(), "a bit beyond the width is set");
        }
    }

    #[test]
    fn scratch_that_is_too_short_is_refused() {
        let mut words = [0; 4];
        let mut mask = MaskMut::new(&mut words, 40, 2).unwrap();
        let error = erode(&mut mask, &mut [0; 5]).unwrap_err();
        assert_eq!(error, ParameterError::new("scratch", Rule::SameLength { expected: 6 }));
    }
}
