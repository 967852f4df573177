//! Skin calibration at run time: a sample of a box of pixels that shows only skin adapts a Gaussian model.

use super::pixel_format::{PixelFormat, odd_pair};
use crate::error::{ParameterError, Rule};
use crate::math::min;
use crate::vision::components::BoundingBox;
use crate::vision::skin::GaussianSkin;
use core::marker::PhantomData;

/// Pixels' worth of evidence that the trained model counts against the sample's.
const TRAINED_PIXELS: f32 = 30.0;
/// Largest part that the sample gets: one patch of skin does not show all its shades.
const MAX_SAMPLE_PART: f32 = 0.8;
/// Rounds of trimming.
const TRIMMING_ROUNDS: usize = 5;
/// Squared Mahalanobis distance beyond which a pixel is trimmed: 99 % of a two-dimensional normal distribution.
const TRIM_SQUARED: f32 = 9.21;
/// Variance of a chromaticity that a table's cells cannot resolve.
const CELL_VARIANCE: f32 = 1.0e-5;

/// An even sample of the pixels of a box, `N` at most; feed it the lines of one frame.
///
/// The same steps as the host's `--calibrate`: mean and covariance of the chromaticities, trimmed of what is not skin (rings, glare,
/// background), are blended with the trained ones.
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
        let pixels = bounds.width_px() * bounds.height_px();
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

    /// `trained` adapted to the sample. Its part is n / (n + 30) for n pixels, at most 0.8; the darkest accepted sum falls to half of the
    /// sample's tenth percentile if that is lower.
    ///
    /// # Errors
    /// A sample without colours; and as [`GaussianSkin::new`].
    pub fn adapted(&self, trained: &GaussianSkin) -> Result<GaussianSkin, ParameterError> {
        let mut points = heapless::Vec::<[f32; 2], N>::new();
        let mut sums = heapless::Vec::<u16, N>::new();
        for &key in &self.keys {
            let [r, g, b] = F::rgb(key).map(u16::from);
            let sum = r + g + b;
            if sum > 0 {
                // As long as `keys` at most.
                let _ = points.push([f32::from(r) / f32::from(sum), f32::from(g) / f32::from(sum)]);
                let _ = sums.push(sum);
            }
        }
        let moments = trimmed(&mut points).ok_or(ParameterError::new("skin sample", Rule::NotEmpty))?;
        sums.sort_unstable();
        let shadow = sums.get(sums.len() / 10).map_or(trained.min_sum(), |sum| sum / 2);
        let part = min(moments.count / (moments.count + TRAINED_PIXELS), MAX_SAMPLE_PART);
        let blend = |trained: f32, here: f32| (1.0 - part) * trained + part * here;
        let [rr, rg, gg] = trained.covariance();
        GaussianSkin::new(
            blend(trained.mean_r(), moments.mean[0]),
            blend(trained.mean_g(), moments.mean[1]),
            [blend(rr, moments.covariance[0]), blend(rg, moments.covariance[1]), blend(gg, moments.covariance[2])],
            trained.threshold(),
            trained.min_sum().min(shadow),
        )
    }
}

/// Count, mean and covariance of chromaticities.
#[derive(Debug, Clone, Copy)]
struct Moments {
    count: f32,
    mean: [f32; 2],
    covariance: [f32; 3],
}

impl Moments {
    /// `None` without points.
    fn of<'p>(points: impl Iterator<Item = &'p [f32; 2]> + Clone) -> Option<Self> {
        let count = points.clone().count() as f32;
        if !(count > 0.0) {
            return None;
        }
        let mean = [0, 1].map(|i: usize| points.clone().map(|point| point[i & 1]).sum::<f32>() / count);
        let mut covariance = [0.0; 3];
        for point in points {
            let (r, g) = (point[0] - mean[0], point[1] - mean[1]);
            for (sum, term) in covariance.iter_mut().zip([r * r, r * g, g * g]) {
                *sum += term / count;
            }
        }
        covariance[0] += CELL_VARIANCE;
        covariance[2] += CELL_VARIANCE;
        Some(Self { count, mean, covariance })
    }

    fn holds(&self, point: &[f32; 2]) -> bool {
        let [rr, rg, gg] = self.covariance;
        let (r, g) = (point[0] - self.mean[0], point[1] - self.mean[1]);
        gg * r * r - 2.0 * rg * r * g + rr * g * g <= TRIM_SQUARED * (rr * gg - rg * rg)
    }
}

/// Moments of the half that is nearest to the median, then, a few times, of what lies close to the last ones.
fn trimmed(points: &mut [[f32; 2]]) -> Option<Moments> {
    let middle = points.len() / 2;
    let mut median = [0.0; 2];
    for (i, median) in median.iter_mut().enumerate() {
        points.sort_unstable_by(|a, b| a[i & 1].total_cmp(&b[i & 1]));
        *median = points.get(middle)?[i & 1];
    }
    let square = |point: &[f32; 2]| {
        let (r, g) = (point[0] - median[0], point[1] - median[1]);
        r * r + g * g
    };
    points.sort_unstable_by(|a, b| square(a).total_cmp(&square(b)));
    let mut moments = Moments::of(points.iter().take(points.len().div_ceil(2)))?;
    for _ in 0..TRIMMING_ROUNDS {
        let last = moments;
        moments = Moments::of(points.iter().filter(|point| last.holds(point)))?;
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

    /// Bluish skin in the box, which the trained model does not take for skin, a third of it glare; green around it.
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

    proptest! {
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
