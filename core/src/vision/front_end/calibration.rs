//! Skin calibration at run time: a sample of a box of pixels that shows only skin adapts a Gaussian
//! model.
//!
//! ```
//! use sinew_core::vision::components::BoundingBox;
//! use sinew_core::vision::front_end::calibration::SkinSample;
//! use sinew_core::vision::front_end::pixel_format::Rgb565;
//! use sinew_core::vision::skin::GaussianSkin;
//!
//! // A hand of another colour than the model's, held into a box of 16 x 8 pixels.
//! let trained = GaussianSkin::new(0.44, 0.31, [0.0030, -0.0008, 0.0010], 2.0, 60)?;
//! let hand = [150_u16, 120, 110];
//! let pixel = (hand[0] >> 3) << 11 | (hand[1] >> 2) << 5 | hand[2] >> 3;
//! let bounds = BoundingBox { min_u: 8, min_v: 4, max_u: 23, max_v: 11 };
//! let mut sample = SkinSample::<Rgb565, 256>::new(bounds);
//! for v in 0..20 {
//!     sample.line(v, &[pixel; 40]);
//! }
//! assert_eq!(sample.len(), 128, "what is outside of the box does not count");
//! let adapted = sample.adapted(&trained)?;
//! let far = |skin: &GaussianSkin| {
//!     skin.distance(hand.map(|value| value as u8)).expect("bright enough")
//! };
//! assert!(far(&adapted) < far(&trained));
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

use super::pixel_format::{PixelFormat, odd_pair};
use crate::error::{ParameterError, Rule};
use crate::math::min;
use crate::vision::components::BoundingBox;
use crate::vision::objects::person_colour::PersonColour;
use crate::vision::skin::GaussianSkin;
use core::marker::PhantomData;

/// Weight of the trained model in the blend, in pixels of the sample.
///
/// Chosen: a small sample barely moves the model; the host's `--calibrate` has the same number.
const TRAINED_PIXELS: f32 = 30.0;
/// Largest weight of the sample in the blend, 0 to 1.
///
/// Chosen: one patch of skin does not show all shades; the host's `--calibrate` has the same
/// number.
const MAX_SAMPLE_PART: f32 = 0.8;
/// Rounds of trimming; the bound of the work.
const TRIMMING_ROUNDS: usize = 5;
/// Squared Mahalanobis distance beyond which a pixel is trimmed: -2 ln 0.01.
///
/// The 99 % quantile of chi-squared with two degrees of freedom.
const TRIM_SQUARED: f32 = 9.21;
/// Variance added to each chromaticity.
///
/// Chosen: a standard deviation of 0.003, below which a table's cells resolve nothing.
const CELL_VARIANCE: f32 = 1.0e-5;

/// An even sample of the pixels of a box, `N` at most; feed it the lines of one frame.
///
/// The same steps as the host's `--calibrate`: mean and covariance of the chromaticities, trimmed
/// of rings, glare and background, are blended with the trained ones.
///
/// ```
/// use sinew_core::vision::components::BoundingBox;
/// use sinew_core::vision::front_end::{calibration::SkinSample, pixel_format::Rgb565};
/// use sinew_core::vision::skin::GaussianSkin;
///
/// let trained = GaussianSkin::new(0.44, 0.31, [0.0030, -0.0008, 0.0010], 2.0, 60)?;
/// let mut sample =
///     SkinSample::<Rgb565, 50>::new(BoundingBox { min_u: 0, min_v: 0, max_u: 15, max_v: 7 });
/// // Before the frame came there is nothing to learn from.
/// assert_eq!(sample.adapted(&trained).map_err(|error| error.parameter), Err("skin sample"));
/// for v in 0..8 {
///     sample.line(v, &[150 >> 3 << 11 | 120 >> 2 << 5 | 110 >> 3; 40]);
/// }
/// assert_eq!(sample.len(), 43, "every third of 128 pixels: 50 have room");
/// assert!(sample.adapted(&trained)?.mean_r() < trained.mean_r(), "this skin is paler");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
pub struct SkinSample<F, const N: usize> {
    bounds: BoundingBox,
    keys: heapless::Vec<u16, N>,
    stride: u32,
    seen: u32,
    format: PhantomData<F>,
}

impl<F: PixelFormat, const N: usize> SkinSample<F, N> {
    /// An empty sample of the pixels inside of `bounds`; its corners belong to it.
    #[must_use]
    pub fn new(bounds: BoundingBox) -> Self {
        let pixels = bounds.width_px().saturating_mul(bounds.height_px());
        let stride = pixels.div_ceil((N as u32).max(1));
        Self { bounds, keys: heapless::Vec::new(), stride, seen: 0, format: PhantomData }
    }

    /// Pixels taken so far.
    #[must_use]
    pub fn len(&self) -> usize {
        self.keys.len()
    }

    /// Whether no pixel was taken.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.keys.is_empty()
    }

    /// Reads line `v` of a frame.
    pub fn line(&mut self, v: usize, line: &[u16]) {
        let BoundingBox { min_u, min_v, max_u, max_v } = self.bounds;
        if !(usize::from(min_v)..=usize::from(max_v)).contains(&v) {
            return;
        }
        for u in usize::from(min_u)..=usize::from(max_u) {
            let taken = self.seen.is_multiple_of(self.stride.max(1));
            self.seen = self.seen.saturating_add(1);
            let key = match (line.get(u & !1), line.get(u | 1)) {
                (Some(&left), Some(&right)) => F::keys([left, right])[u & 1],
                (Some(_), None) => odd_pair(line).map_or(0, |pair| F::keys(pair)[0]),
                (None, _) => continue,
            };
            if taken {
                // The stride leaves at most the capacity.
                let _ = self.keys.push(key);
            }
        }
    }

    /// The colour of a person whose face's middle was sampled; `None` where too few pixels are
    /// alike.
    #[must_use]
    pub fn person_colour(&self) -> Option<PersonColour> {
        PersonColour::of_pixels(self.keys.iter().map(|key| F::rgb(*key)))
    }

    /// `trained` adapted to the sample. Its part is n / (n + 30) for n pixels, at most 0.8. The
    /// darkest accepted sum falls to half of the sample's tenth percentile if that is lower.
    ///
    /// # Errors
    /// A sample without colours; and as [`GaussianSkin::new`].
    pub fn adapted(&self, trained: &GaussianSkin) -> Result<GaussianSkin, ParameterError> {
        let colours = self.keys.iter().filter_map(|&key| Colour::of(F::rgb(key)));
        let moments = trimmed(&colours).ok_or(ParameterError::new("skin sample", Rule::NotEmpty))?;
        let sums = colours.clone().map(|colour| colour.sum);
        let shadow = kth_smallest(&sums, colours.count() / 10) / 2;
        let part = min(moments.count / (moments.count + TRAINED_PIXELS), MAX_SAMPLE_PART);
        let blend = |trained: f32, here: f32| (1.0 - part) * trained + part * here;
        let [rr, rg, gg] = trained.covariance();
        GaussianSkin::new(
            blend(trained.mean_r(), moments.mean[0]),
            blend(trained.mean_g(), moments.mean[1]),
            [blend(rr, moments.covariance[0]), blend(rg, moments.covariance[1]), blend(gg, moments.covariance[2])],
            trained.threshold(),
            // Sums are 765 at most.
            trained.min_sum().min(shadow as u16),
        )
    }
}

/// R + G + B of a pixel that is not black, and its chromaticities r and g.
#[derive(Debug, Clone, Copy)]
struct Colour {
    sum: u32,
    r: f32,
    g: f32,
}

impl Colour {
    fn of(rgb: [u8; 3]) -> Option<Self> {
        let [red, green, blue] = rgb.map(f32::from);
        let sum = red + green + blue;
        (sum > 0.0).then(|| Self { sum: sum as u32, r: red / sum, g: green / sum })
    }
}

/// The number that `k` others come before in order; `u32::MAX` of too few. Decides one bit after
/// the other by counting, so that nothing is sorted or kept.
fn kth_smallest(numbers: &(impl Iterator<Item = u32> + Clone), k: usize) -> u32 {
    let mut found = 0;
    for bit in (0..u32::BITS).rev() {
        // Of all numbers with the bits found so far, those below this one have a zero here.
        let middle = found | 1 << bit;
        if numbers.clone().filter(|&number| number < middle).count() <= k {
            found = middle;
        }
    }
    found
}

/// [`kth_smallest`] of numbers from 0 on, whose order is that of their bits.
fn kth_smallest_real(numbers: impl Iterator<Item = f32> + Clone, k: usize) -> f32 {
    f32::from_bits(kth_smallest(&numbers.map(f32::to_bits), k))
}

/// Count, mean and covariance of chromaticities.
#[derive(Debug, Clone, Copy)]
struct Moments {
    count: f32,
    mean: [f32; 2],
    covariance: [f32; 3],
}

impl Moments {
    /// `None` without colours.
    fn of(colours: impl Iterator<Item = Colour> + Clone) -> Option<Self> {
        let count = colours.clone().count() as f32;
        if !(count > 0.0) {
            return None;
        }
        let mean_r = colours.clone().map(|colour| colour.r).sum::<f32>() / count;
        let mean_g = colours.clone().map(|colour| colour.g).sum::<f32>() / count;
        let mut covariance = [0.0; 3];
        for colour in colours {
            let (r, g) = (colour.r - mean_r, colour.g - mean_g);
            for (sum, term) in covariance.iter_mut().zip([r * r, r * g, g * g]) {
                *sum += term / count;
            }
        }
        covariance[0] += CELL_VARIANCE;
        covariance[2] += CELL_VARIANCE;
        Some(Self { count, mean: [mean_r, mean_g], covariance })
    }

    fn holds(&self, colour: &Colour) -> bool {
        let [rr, rg, gg] = self.covariance;
        let (r, g) = (colour.r - self.mean[0], colour.g - self.mean[1]);
        gg * r * r - 2.0 * rg * r * g + rr * g * g <= TRIM_SQUARED * (rr * gg - rg * rg)
    }
}

/// Moments of the half that is nearest to the median, with what is as near as its farthest. Then, a
/// few times, moments of what lies close to the last ones.
fn trimmed(colours: &(impl Iterator<Item = Colour> + Clone)) -> Option<Moments> {
    let count = colours.clone().count();
    let median_r = kth_smallest_real(colours.clone().map(|colour| colour.r), count / 2);
    let median_g = kth_smallest_real(colours.clone().map(|colour| colour.g), count / 2);
    let square = |colour: &Colour| {
        let (r, g) = (colour.r - median_r, colour.g - median_g);
        r * r + g * g
    };
    let farthest =
        kth_smallest_real(colours.clone().map(|colour| square(&colour)), count.div_ceil(2).saturating_sub(1));
    let mut moments = Moments::of(colours.clone().filter(|colour| square(colour) <= farthest))?;
    for _ in 0..TRIMMING_ROUNDS {
        let last = moments;
        moments = Moments::of(colours.clone().filter(|colour| last.holds(colour)))?;
    }
    Some(moments)
}

#[cfg(test)]
mod tests {
    use super::super::pixel_format::{Rgb565, Yuyv};
    use super::super::skin_table::SkinTable;
    use super::*;
    use proptest::prelude::*;

    const BOX: BoundingBox = BoundingBox { min_u: 5, min_v: 2, max_u: 36, max_v: 17 };

    fn trained() -> GaussianSkin {
        GaussianSkin::new(0.45, 0.316, [0.0017, 0.0, 0.0002], 2.25, 215).unwrap()
    }

    /// Bluish skin in the box, which the trained model does not take for skin, a third of it glare;
    /// green around it.
    fn line(v: usize) -> Vec<u16> {
        let colour = |u: usize| match u {
            5..=36 if (u + v).is_multiple_of(3) => [31, 63, 31],
            5..=36 => [15 + (u % 2) as u16, 26, 17 + (v % 2) as u16],
            _ => [5, 40, 6],
        };
        (0..50).map(colour).map(|[r, g, b]| r << 11 | g << 5 | b).collect()
    }

    #[test]
    fn a_box_of_skin_teaches_the_table_the_scene() {
        let mut sample = SkinSample::<Rgb565, 200>::new(BOX);
        (0..30).for_each(|v| sample.line(v, &line(v)));
        assert!((150..=200).contains(&sample.len()), "{}", sample.len());
        let mut table = SkinTable::<Rgb565>::new();
        let count = |table: &SkinTable<Rgb565>| {
            let mut bits = [0; 2];
            (2..18).fold(0, |sum, v| {
                table.classify_line(&line(v), &mut bits);
                sum + bits[0].count_ones() + bits[1].count_ones()
            })
        };
        table.learn(&trained());
        assert_eq!(count(&table), 0);
        table.learn(&sample.adapted(&trained()).unwrap());
        let skin = 32 * 16 - (2..18).flat_map(|v| (5..=36).filter(move |u| (u + v) % 3 == 0)).count() as u32;
        assert_eq!(count(&table), skin, "the skin, neither glare nor background");
    }

    #[test]
    fn black_and_empty_samples_are_refused() {
        let mut sample = SkinSample::<Rgb565, 50>::new(BOX);
        assert!(sample.is_empty());
        assert_eq!(sample.adapted(&trained()).unwrap_err().parameter, "skin sample");
        (0..30).for_each(|v| sample.line(v, &[0; 40]));
        assert!(!sample.is_empty());
        assert_eq!(sample.adapted(&trained()).unwrap_err().parameter, "skin sample");
        let mut none = SkinSample::<Rgb565, 0>::new(BOX);
        none.line(4, &line(4));
        assert!(none.adapted(&trained()).is_err());
    }

    #[test]
    fn black_pixels_are_no_colours_and_of_too_few_there_is_none() {
        assert!(Colour::of([0; 3]).is_none());
        assert!(trimmed(&core::iter::empty()).is_none());
        assert_eq!(kth_smallest(&[3, 1].into_iter(), 2), u32::MAX);
    }

    proptest! {
        #[test]
        fn the_kth_smallest_is_that_of_a_sorted_list(
            numbers in prop::collection::vec(prop_oneof![0_u32..9, any::<u32>()], 1..40),
            reals in prop::collection::vec(prop_oneof![Just(0.0), 0.0_f32..1.0], 1..40), place in 0.0_f32..1.0,
        ) {
            let at = |len: usize| (place * len as f32) as usize;
            let k = at(numbers.len()).min(numbers.len() - 1);
            let mut sorted = numbers.clone();
            sorted.sort_unstable();
            prop_assert_eq!(kth_smallest(&numbers.iter().copied(), k), sorted[k]);
            let k = at(reals.len()).min(reals.len() - 1);
            let mut sorted = reals.clone();
            sorted.sort_unstable_by(f32::total_cmp);
            prop_assert_eq!(kth_smallest_real(reals.iter().copied(), k), sorted[k]);
        }

        #[test]
        fn any_lines_give_a_model_or_an_error(
            lines in prop::collection::vec(prop::collection::vec(any::<u16>(), 0..20), 0..12),
            corners in prop::array::uniform4(0_u16..25),
        ) {
            let [min_u, min_v, max_u, max_v] = corners;
            let mut sample = SkinSample::<Yuyv, 20>::new(BoundingBox { min_u, min_v, max_u, max_v });
            lines.iter().enumerate().for_each(|(v, line)| sample.line(v, line));
            if let Ok(model) = sample.adapted(&trained()) {
                prop_assert!(model.min_sum() <= 215);
            }
        }
    }
}
