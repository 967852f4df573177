//! Skin-coloured or not: a Gaussian in chromaticity, or a table over colours.
//!
//! Both classifiers turn a line of interleaved RGB bytes into bits, 32 pixels a word, pixel 0 in
//! the lowest bit.
//!
//! ```
//! use sinew_core::vision::skin::GaussianSkin;
//!
//! // Mean and covariance of r = R / (R + G + B) and g, three standard deviations, and not darker
//! // than 60.
//! let skin = GaussianSkin::new(0.44, 0.31, [0.0030, -0.0008, 0.0010], 3.0, 60)?;
//! let of_a_hand = skin.distance([200, 140, 110]).expect("bright enough to judge");
//! let of_a_wall = skin.distance([20, 40, 90]).expect("bright enough to judge");
//! assert!(of_a_hand < skin.threshold() && of_a_wall > skin.threshold());
//! assert_eq!(skin.distance([5, 5, 5]), None, "black has no chromaticity");
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

use crate::error::{ParameterError, Rule, finite, positive, within};
use crate::math::sqrt;

/// Pixels in one word of a line of bits.
pub const PIXELS_PER_WORD: usize = 32;
/// Bytes of the pixels of one word.
const BLOCK_BYTES: usize = 3 * PIXELS_PER_WORD;
/// Cells along one side of the colour cube of [`HistogramSkin`].
pub const CUBE_SIDE: usize = 32;
/// Words of the decision table of [`HistogramSkin`]: one bit a cell of the colour cube, 4 KiB.
pub const CUBE_WORDS: usize = CUBE_SIDE * CUBE_SIDE;

/// Decides for each pixel of a line whether it shows skin.
///
/// ```
/// use sinew_core::vision::skin::SkinClassifier;
///
/// // A hand in a red glove: a classifier of your own.
/// struct RedGlove;
///
/// impl SkinClassifier for RedGlove {
///     fn classify_line(&self, rgb: &[u8], bits: &mut [u32]) {
///         bits.fill(0);
///         for (u, pixel) in rgb.chunks_exact(3).enumerate() {
///             let is_red =
///                 pixel[0] > 120 && pixel[0] / 2 > pixel[1] && pixel[0] / 2 > pixel[2];
///             if let Some(word) = bits.get_mut(u / 32) {
///                 *word |= u32::from(is_red) << (u % 32);
///             }
///         }
///     }
/// }
///
/// let mut bits = [0];
/// RedGlove.classify_line(&[200, 20, 30, 90, 90, 90, 180, 40, 10], &mut bits);
/// assert_eq!(bits, [0b101]);
/// ```
pub trait SkinClassifier {
    /// Writes one bit a pixel of `rgb` (three bytes a pixel) into `bits`, lowest bit first, 1 =
    /// skin.
    ///
    /// Judges as many whole pixels as `rgb` holds and `bits` has room for; all other bits of `bits`
    /// become zero.
    fn classify_line(&self, rgb: &[u8], bits: &mut [u32]);

    /// Whether it is known at once that no colour from `low` to `high`, R, G and B each, is skin.
    fn is_none_skin(&self, _low: [u8; 3], _high: [u8; 3]) -> bool {
        false
    }
}

/// Skin as a normal distribution of chromaticity r = R/(R+G+B), g = G/(R+G+B), arm paper, section
/// 3.1.
///
/// ```
/// use sinew_core::vision::skin::{GaussianSkin, SkinClassifier};
///
/// let skin = GaussianSkin::new(0.44, 0.31, [0.0030, -0.0008, 0.0010], 2.0, 60)?;
/// // Skin, a blue wall, the same skin in half of the light.
/// let mut bits = [0];
/// skin.classify_line(&[200, 140, 110, 20, 40, 90, 100, 70, 55], &mut bits);
/// assert_eq!(bits, [0b101]);
/// // A matrix that is not positive definite is refused.
/// assert_eq!(
///     GaussianSkin::new(0.44, 0.31, [-1.0, 0.0, 1.0], 2.0, 60).map_err(|e| e.parameter),
///     Err("covariance")
/// );
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct GaussianSkin {
    mean: [f32; 2],
    covariance: [f32; 3],
    /// Inverse covariance: rr, rg, gg.
    precision: [f32; 3],
    threshold: f32,
    min_sum: u16,
}

impl GaussianSkin {
    /// Skin within the Mahalanobis distance `threshold` of (`mean_r`, `mean_g`), with `covariance`
    /// (rr, rg, gg).
    ///
    /// Pixels darker than `min_sum` = R+G+B (0 to 765) have no usable chromaticity and are not
    /// skin.
    ///
    /// # Errors
    /// Means within 0 to 1, a finite, positive definite covariance, a positive threshold, `min_sum`
    /// at most 765.
    pub fn new(
        mean_r: f32,
        mean_g: f32,
        covariance: [f32; 3],
        threshold: f32,
        min_sum: u16,
    ) -> Result<Self, ParameterError> {
        let mean = [within("mean_r", mean_r, 0.0, 1.0)?, within("mean_g", mean_g, 0.0, 1.0)?];
        for value in covariance {
            finite("covariance", value)?;
        }
        let [rr, rg, gg] = covariance;
        let determinant = rr * gg - rg * rg;
        let precision = [gg / determinant, -rg / determinant, rr / determinant];
        if !(rr > 0.0 && determinant > 0.0 && precision.iter().all(|p| p.is_finite())) {
            return Err(ParameterError::new("covariance", Rule::PositiveDefinite));
        }
        within("min_sum", f32::from(min_sum), 0.0, 765.0)?;
        Ok(Self { mean, covariance, precision, threshold: positive("threshold", threshold)?, min_sum })
    }

    /// Mean of r.
    #[must_use]
    pub fn mean_r(&self) -> f32 {
        self.mean[0]
    }

    /// Mean of g.
    #[must_use]
    pub fn mean_g(&self) -> f32 {
        self.mean[1]
    }

    /// Covariance of (r, g): rr, rg, gg.
    #[must_use]
    pub fn covariance(&self) -> [f32; 3] {
        self.covariance
    }

    /// Largest Mahalanobis distance of skin.
    #[must_use]
    pub fn threshold(&self) -> f32 {
        self.threshold
    }

    /// Smallest R+G+B of skin, 0 to 765.
    #[must_use]
    pub fn min_sum(&self) -> u16 {
        self.min_sum
    }

    /// Mahalanobis distance of a colour's chromaticity from the mean; `None` for a colour darker
    /// than `min_sum` (or black).
    #[must_use]
    pub fn distance(&self, rgb: [u8; 3]) -> Option<f32> {
        let sum = rgb.iter().map(|&c| f32::from(c)).sum::<f32>();
        if sum <= 0.0 || sum < f32::from(self.min_sum) {
            return None;
        }
        let (r, g) = (f32::from(rgb[0]) / sum - self.mean[0], f32::from(rgb[1]) / sum - self.mean[1]);
        let [rr, rg, gg] = self.precision;
        Some(sqrt(crate::math::max(r * (rr * r + 2.0 * rg * g) + gg * g * g, 0.0)))
    }

    /// The decision for 32 pixels; no division, since all terms are scaled by (R+G+B)^2.
    fn classify_block(&self, block: &[u8; BLOCK_BYTES]) -> u32 {
        let (mut red, mut green, mut sum) =
            ([0_i32; PIXELS_PER_WORD], [0_i32; PIXELS_PER_WORD], [0_i32; PIXELS_PER_WORD]);
        for (i, &[r, g, b]) in block.as_chunks::<3>().0.iter().enumerate() {
            red[i] = i32::from(r);
            green[i] = i32::from(g);
            sum[i] = i32::from(r) + i32::from(g) + i32::from(b);
        }
        let [rr, rg, gg] = self.precision;
        let rg_twice = 2.0 * rg;
        let threshold2 = self.threshold * self.threshold;
        let min_sum = i32::from(self.min_sum.max(1));
        let mut chosen = [0_u32; PIXELS_PER_WORD];
        for (i, bit) in chosen.iter_mut().enumerate() {
            let whole = sum[i] as f32;
            let r = red[i] as f32 - self.mean[0] * whole;
            let g = green[i] as f32 - self.mean[1] * whole;
            let form = r * (rr * r + rg_twice * g) + gg * g * g;
            let inside = u32::from(form <= threshold2 * whole * whole) & u32::from(sum[i] >= min_sum);
            *bit = inside << i;
        }
        chosen.iter().fold(0, |word, bit| word | bit)
    }
}

impl SkinClassifier for GaussianSkin {
    fn classify_line(&self, rgb: &[u8], bits: &mut [u32]) {
        let (whole, rest) = rgb.as_chunks::<BLOCK_BYTES>();
        // Pixels beyond the line's end are black, and black is never skin.
        let mut last = [0; BLOCK_BYTES];
        last.iter_mut().zip(rest.chunks_exact(3).flatten()).for_each(|(to, from)| *to = *from);
        let mut blocks = whole.iter().chain(core::iter::once(&last));
        for word in bits {
            *word = blocks.next().map_or(0, |block| self.classify_block(block));
        }
    }
}

/// Skin as a table over 32 x 32 x 32 colours, a decision bit each.
///
/// The bit of a colour is bit `B >> 3` of word `(R >> 3) * 32 + (G >> 3)`: see
/// [`HistogramSkin::bit_of`].
///
/// ```
/// use sinew_core::vision::skin::{CUBE_WORDS, HistogramSkin, SkinClassifier};
///
/// // A table with one cell of colours; a trained one lies in flash.
/// let mut table = [0; CUBE_WORDS];
/// let (word, bit) = HistogramSkin::bit_of([200, 140, 110]);
/// table[word] |= 1 << bit;
/// let skin = HistogramSkin::new(&table);
/// let mut bits = [0];
/// skin.classify_line(&[200, 140, 110, 20, 40, 90, 203, 143, 111], &mut bits);
/// assert_eq!(bits, [0b101], "the last colour falls into the same cell");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HistogramSkin<'a> {
    table: &'a [u32; CUBE_WORDS],
}

impl<'a> HistogramSkin<'a> {
    /// A classifier that looks up each colour in `table`, which may lie in flash.
    #[must_use]
    pub const fn new(table: &'a [u32; CUBE_WORDS]) -> Self {
        Self { table }
    }

    /// The decision table.
    #[must_use]
    pub const fn table(&self) -> &'a [u32; CUBE_WORDS] {
        self.table
    }

    /// Word (0 to 1023) and bit (0 to 31) of a colour in the table.
    #[inline]
    #[must_use]
    pub const fn bit_of(rgb: [u8; 3]) -> (usize, u32) {
        (((rgb[0] >> 3) as usize) << 5 | (rgb[1] >> 3) as usize, (rgb[2] >> 3) as u32)
    }

    /// Whether a colour counts as skin.
    #[inline]
    #[must_use]
    pub fn is_skin(&self, rgb: [u8; 3]) -> bool {
        let (word, bit) = Self::bit_of(rgb);
        (self.table[word & (CUBE_WORDS - 1)] >> bit) & 1 == 1
    }
}

impl SkinClassifier for HistogramSkin<'_> {
    fn classify_line(&self, rgb: &[u8], bits: &mut [u32]) {
        let mut blocks = rgb.chunks(3 * PIXELS_PER_WORD);
        for word in bits {
            let block = blocks.next().unwrap_or(&[]);
            let pixels = block.as_chunks::<3>().0.iter().enumerate();
            *word = pixels.fold(0, |packed, (i, &pixel)| packed | u32::from(self.is_skin(pixel)) << (i & 31));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn model() -> GaussianSkin {
        GaussianSkin::new(0.44, 0.31, [0.0030, -0.0008, 0.0010], 2.0, 60).unwrap()
    }

    proptest! {
        #[test]
        fn the_line_agrees_with_the_distance(rgb in prop::collection::vec(any::<u8>(), 0..400), words in 0_usize..6) {
            let mut bits = vec![u32::MAX; words];
            model().classify_line(&rgb, &mut bits);
            for i in 0..32 * words {
                let bit = bits[i / 32] >> (i % 32) & 1 == 1;
                match rgb.as_chunks::<3>().0.get(i).and_then(|&pixel| model().distance(pixel)) {
                    None => prop_assert!(!bit),
                    Some(d) if (d - 2.0).abs() > 1.0e-4 => prop_assert_eq!(bit, d < 2.0, "pixel {} at {}", i, d),
                    Some(_) => {}
                }
            }
        }

        #[test]
        fn the_table_is_read_in_the_documented_order(colour in any::<[u8; 3]>(), other in any::<[u8; 3]>()) {
            let mut table = [0_u32; CUBE_WORDS];
            table[usize::from(colour[0] / 8) * 32 + usize::from(colour[1] / 8)] = 1 << (colour[2] / 8);
            let skin = HistogramSkin::new(&table);
            let same = (0..3).all(|i| colour[i] / 8 == other[i] / 8);
            let line = [colour, other].concat();
            let mut bits = [u32::MAX; 2];
            skin.classify_line(&line, &mut bits);
            prop_assert_eq!(bits, [1 | u32::from(same) << 1, 0]);
        }
    }

    #[test]
    fn a_whole_line_of_skin_sets_no_bit_beyond_its_end() {
        let line: Vec<u8> = [200, 140, 110].repeat(35);
        let mut bits = [0; 3];
        model().classify_line(&line, &mut bits);
        assert_eq!(bits, [u32::MAX, 0b111, 0]);
    }

    #[test]
    fn distance_counts_standard_deviations() {
        let skin = GaussianSkin::new(0.4, 0.3, [0.01, 0.0, 0.04], 1.0, 0).unwrap();
        let d = skin.distance([60, 30, 10]).unwrap();
        assert!((d - 2.0).abs() < 1.0e-5, "{d}");
        assert_eq!(skin.distance([0, 0, 0]), None);
    }

    #[test]
    fn bad_parameters_are_refused_by_name() {
        let bad = |c, t, s| GaussianSkin::new(0.4, 0.3, c, t, s).unwrap_err();
        assert_eq!(bad([1.0, 1.0, 1.0], 1.0, 0), ParameterError::new("covariance", Rule::PositiveDefinite));
        assert_eq!(bad([f32::NAN, 0.0, 1.0], 1.0, 0), ParameterError::new("covariance", Rule::Finite));
        assert_eq!(bad([1.0e-30, 0.0, 1.0e-30], 1.0, 0), ParameterError::new("covariance", Rule::PositiveDefinite));
        assert_eq!(bad([1.0, 0.0, 1.0], 0.0, 0), ParameterError::new("threshold", Rule::Positive));
        assert_eq!(bad([1.0, 0.0, 1.0], 1.0, 766).parameter, "min_sum");
        assert_eq!(GaussianSkin::new(1.5, 0.3, [1.0, 0.0, 1.0], 1.0, 0).unwrap_err().parameter, "mean_r");
    }
}
