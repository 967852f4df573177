//! The colour of one person's skin, from the middle of the face.
//!
//! A normal distribution over luminance and chrominance (Y, Cr, Cb of Rec. 601). It is one-sided: a
//! hand may be more colourful than the face, since the face is lit from more sides.

use crate::math::{abs, max, min, sqrt};
use crate::vision::skin::{PIXELS_PER_WORD, SkinClassifier};

/// Most pixels of a face that are looked at.
const MAX_SAMPLES: usize = 1024;
/// Fewest pixels that make a colour. Chosen.
const MIN_SAMPLES: usize = 24;
/// Pixels of a face whose chrominance is further from the median are hair, eyes or background.
const MAX_FROM_MEDIAN: i32 = 15;
/// Added to the variances of Y, Cr and Cb.
const FLOOR_VARIANCES: [f32; 3] = [200.0, 4.0, 4.0];
/// Squared distance within which a colour is skin: three standard deviations.
const MAX_SQUARED_DISTANCE: f32 = 9.0;
/// A little more than its root: a single direction that is so far away decides alone.
const MAX_DEVIATIONS: f32 = 3.01;
/// Share of what is more colourful than the mean that is forgiven.
const FORGIVEN: f32 = 0.5;
/// Weight of the old colour when a new face is seen.
const KEPT: f32 = 0.7;

/// A person's colour.
///
/// ```
/// use sinew_core::vision::objects::person_colour::PersonColour;
///
/// // Pixels of a face's middle, some of which are lips.
/// let mut face = [[200, 150, 125]; 60];
/// face[50..].fill([170, 60, 70]);
/// let colour = PersonColour::of_face(&face).expect("most are alike");
/// assert!(colour.is_skin([185, 138, 115]), "in the shadow");
/// assert!(!colour.is_skin([90, 120, 180]) && !colour.is_skin([170, 60, 70]));
/// assert_eq!(PersonColour::of_face(&face[..5]), None, "too few");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PersonColour {
    pub(super) mean: [f32; 3],
    /// Upper triangle of the covariance: YY, YCr, YCb, CrCr, CrCb, CbCb.
    pub(super) covariance: [f32; 6],
    /// Of the inverse.
    inverse: [f32; 6],
    /// Direction of more colour in Cr, Cb; a unit vector.
    colourful: [f32; 2],
    /// Beyond these no colour is skin, whatever else it is: along that direction, and across it.
    limits: [f32; 2],
}

/// Parts of R, G and B in Cr and in Cb, see [`ycc`].
const CR_OF_RGB: [f32; 3] = [0.713 * 0.701, -0.713 * 0.587, -0.713 * 0.114];
const CB_OF_RGB: [f32; 3] = [-0.564 * 0.299, -0.564 * 0.587, 0.564 * 0.886];

/// Y, Cr and Cb of a colour (Rec. 601, full range).
#[inline(always)]
fn ycc(rgb: [u8; 3]) -> [f32; 3] {
    let [r, g, b] = rgb.map(f32::from);
    let y = 0.299 * r + 0.587 * g + 0.114 * b;
    [y, 0.713 * (r - y) + 128.0, 0.564 * (b - y) + 128.0]
}

impl Default for PersonColour {
    /// Grey.
    fn default() -> Self {
        let [y, cr, cb] = FLOOR_VARIANCES;
        let inverse = [1.0 / y, 0.0, 0.0, 1.0 / cr, 0.0, 1.0 / cb];
        Self {
            mean: [128.0; 3],
            covariance: [y, 0.0, 0.0, cr, 0.0, cb],
            inverse,
            colourful: [0.0; 2],
            limits: [0.0; 2],
        }
    }
}

impl PersonColour {
    /// The colour of pixels from a face's middle (rows 25 to 85 %, columns 20 to 80 % of its box),
    /// R, G, B each; `None` where too few are alike. Of more than 1024 the first ones count.
    #[must_use]
    pub fn of_face(rgb: &[[u8; 3]]) -> Option<Self> {
        Self::of_pixels(rgb.iter().take(MAX_SAMPLES).copied())
    }

    /// The same of any pixels.
    pub(crate) fn of_pixels(rgb: impl Iterator<Item = [u8; 3]> + Clone) -> Option<Self> {
        let colours = rgb.map(ycc);
        let [_, cr, cb] = medians(&colours);
        let is_near = |value: f32, middle: i32| abs(value - middle as f32) <= MAX_FROM_MEDIAN as f32;
        let kept = colours.filter(move |[_, r, b]| is_near(*r, cr) && is_near(*b, cb));
        let mut count = 0;
        let mut mean = [0.0_f32; 3];
        for colour in kept.clone() {
            count += 1;
            mean.iter_mut().zip(colour).for_each(|(sum, value)| *sum += value);
        }
        if count < MIN_SAMPLES {
            return None;
        }
        mean = mean.map(|sum| sum / count as f32);
        let mut covariance = [0.0_f32; 6];
        for colour in kept {
            let from_mean: [f32; 3] = core::array::from_fn(|axis| colour[axis] - mean[axis]);
            covariance.iter_mut().zip(PAIRS).for_each(|(sum, (a, b))| *sum += from_mean[a] * from_mean[b]);
        }
        for (sum, (a, b)) in covariance.iter_mut().zip(PAIRS) {
            *sum = *sum / count as f32 + if a == b { FLOOR_VARIANCES[a] } else { 0.0 };
        }
        Self::new(mean, covariance)
    }

    /// Between this colour and a newer one.
    #[must_use]
    #[inline(never)]
    pub fn moved_to(&self, newer: &Self) -> Option<Self> {
        let mix = |old: f32, new: f32| KEPT * old + (1.0 - KEPT) * new;
        let mean = core::array::from_fn(|axis| mix(self.mean[axis], newer.mean[axis]));
        let covariance = core::array::from_fn(|index| mix(self.covariance[index], newer.covariance[index]));
        Self::new(mean, covariance)
    }

    pub(super) fn new(mean: [f32; 3], covariance: [f32; 6]) -> Option<Self> {
        let inverse = inverse(&covariance)?;
        let (cr, cb) = (mean[1] - 128.0, mean[2] - 128.0);
        let size = max(sqrt(cr * cr + cb * cb), 1.0e-6);
        let [along_cr, along_cb] = [cr / size, cb / size];
        let [.., rr, rb, bb] = covariance;
        let std = |r: f32, b: f32| sqrt(max(r * r * rr + 2.0 * r * b * rb + b * b * bb, 0.0));
        let limits = [std(along_cr, along_cb), std(-along_cb, along_cr)].map(|std| MAX_DEVIATIONS * std);
        Some(Self { mean, covariance, inverse, colourful: [along_cr, along_cb], limits })
    }

    /// Whether a colour is this person's skin.
    #[must_use]
    #[inline(never)]
    pub fn is_skin(&self, rgb: [u8; 3]) -> bool {
        let [y, cr, cb] = ycc(rgb);
        let (y, mut cr, mut cb) = (y - self.mean[0], cr - self.mean[1], cb - self.mean[2]);
        let [along_cr, along_cb] = self.colourful;
        if abs(along_cr * cb - along_cb * cr) > self.limits[1] {
            return false;
        }
        let excess = FORGIVEN * max(0.0, cr * along_cr + cb * along_cb);
        cr -= excess * along_cr;
        cb -= excess * along_cb;
        let [yy, yr, yb, rr, rb, bb] = self.inverse;
        let distance = y * (yy * y + 2.0 * (yr * cr + yb * cb)) + cr * (rr * cr + 2.0 * rb * cb) + bb * cb * cb;
        distance < MAX_SQUARED_DISTANCE
    }
}

/// Axes of the six covariances.
const PAIRS: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

/// Medians of each channel, whole numbers.
fn medians(colours: &(impl Iterator<Item = [f32; 3]> + Clone)) -> [i32; 3] {
    let count = colours.clone().count();
    core::array::from_fn(|axis| {
        let mut histogram = [0_u16; 256];
        colours.clone().for_each(|colour| histogram[(colour[axis] as i32).clamp(0, 255) as usize] += 1);
        let mut below = 0;
        let is_middle = |many: &u16| {
            below += usize::from(*many);
            2 * below >= count
        };
        histogram.iter().position(is_middle).unwrap_or(0) as i32
    })
}

/// Inverse of a symmetric matrix; `None` if it has none.
fn inverse(&[a, b, c, d, e, f]: &[f32; 6]) -> Option<[f32; 6]> {
    let minors = [d * f - e * e, c * e - b * f, b * e - c * d, a * f - c * c, b * c - a * e, a * d - b * b];
    let determinant = a * minors[0] + b * minors[1] + c * minors[2];
    (determinant > 0.0 && determinant.is_finite()).then(|| minors.map(|minor| minor / determinant))
}

impl PersonColour {
    /// Least and greatest projection of the chrominance of colours from `low` to `high` on a
    /// direction of Cr, Cb, relative to the mean.
    #[inline(always)]
    fn projections(&self, [along_cr, along_cb]: [f32; 2], low: [u8; 3], high: [u8; 3]) -> [f32; 2] {
        let (cr, cb) = (CR_OF_RGB.map(|part| along_cr * part), CB_OF_RGB.map(|part| along_cb * part));
        let middle = along_cr * (128.0 - self.mean[1]) + along_cb * (128.0 - self.mean[2]);
        let mut range = [middle; 2];
        for (channel, (cr, cb)) in cr.into_iter().zip(cb).enumerate() {
            let ends = [low, high].map(|rgb| (cr + cb) * f32::from(rgb[channel]));
            range = [range[0] + min(ends[0], ends[1]), range[1] + max(ends[0], ends[1])];
        }
        range
    }
}

impl SkinClassifier for PersonColour {
    /// By the directions of colour and of hue alone.
    #[inline(always)]
    fn is_none_skin(&self, low: [u8; 3], high: [u8; 3]) -> bool {
        let ([along_cr, along_cb], [colour, hue]) = (self.colourful, self.limits);
        let [least, most] = self.projections([along_cr, along_cb], low, high);
        let [left, right] = self.projections([-along_cb, along_cr], low, high);
        // Half of the excess of colour is forgiven.
        most < -colour || least > colour / (1.0 - FORGIVEN) || right < -hue || left > hue
    }

    fn classify_line(&self, rgb: &[u8], bits: &mut [u32]) {
        for (word, pixels) in bits.iter_mut().zip(rgb.as_chunks::<3>().0.chunks(PIXELS_PER_WORD)) {
            *word = pixels
                .iter()
                .enumerate()
                .fold(0, |word, (place, pixel)| word | u32::from(self.is_skin(*pixel)) << place);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn face(rgb: [u8; 3]) -> PersonColour {
        let pixels: Vec<_> = (0..100_u8).map(|i| rgb.map(|channel| channel.saturating_add(i % 7))).collect();
        PersonColour::of_face(&pixels).unwrap()
    }

    proptest! {
        #[test]
        fn a_face_has_its_own_colour(rgb in any::<[u8; 3]>()) {
            prop_assert!(face(rgb).is_skin(rgb.map(|channel| channel.saturating_add(3))));
        }

        #[test]
        fn what_is_said_at_once_is_true(rgb in any::<[u8; 3]>(), pixel in any::<[u8; 3]>(), size in 0_u8..40) {
            let high = pixel.map(|channel| channel.saturating_add(size));
            let colour = face(rgb);
            if colour.is_none_skin(pixel, high) {
                let between = core::array::from_fn(|axis| (pixel[axis] / 2 + high[axis] / 2).max(pixel[axis]));
                prop_assert!(![pixel, between, high].into_iter().any(|rgb| colour.is_skin(rgb)));
            }
        }

        #[test]
        fn a_colour_comes_back_from_its_moments(rgb in any::<[u8; 3]>(), other in any::<[u8; 3]>()) {
            let colour = face(rgb);
            prop_assert_eq!(PersonColour::new(colour.mean, colour.covariance), Some(colour));
            let moved = colour.moved_to(&face(other)).unwrap();
            prop_assert!((moved.mean[0] - (0.7 * colour.mean[0] + 0.3 * face(other).mean[0])).abs() < 1.0e-3);
        }
    }

    #[test]
    fn what_is_more_colourful_than_the_face_is_forgiven_in_part() {
        let colour = face([190, 150, 130]);
        assert!(colour.is_skin([202, 147, 121]) && !colour.is_skin([182, 153, 139]));
    }
}
