//! A probability density over the orientation of a line in the image, modulo pi.
//!
//! ```
//! use sinew_core::observation::orientation::OrientationDensity;
//!
//! // Votes for one orientation of 36; densities are relative to uniform.
//! let flat = OrientationDensity::uniform(36)?;
//! let mut votes = [0; 36];
//! votes[flat.bin_of(0.5)] = 100;
//! let limb = flat.from_votes(&votes);
//! assert!(limb.at(0.5) > 10.0 && limb.at(2.0) < 1.0);
//! assert_eq!(
//!     limb.bin_of(0.5 + std::f32::consts::PI),
//!     limb.bin_of(0.5),
//!     "a line has no direction"
//! );
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

use crate::error::{ParameterError, Rule};
use crate::math::{clamp, floor, ln, sqrt, wrap_orientation};
use crate::numeric::rolled::rolled;
use crate::saved_state::{SavedState, StateVisitor};
use core::f32::consts::PI;

/// Largest number of bins of a histogram.
pub const MAX_BINS: usize = 72;

/// Histogram density of an orientation. It is stored relative to the uniform density: 1 everywhere
/// means uniform.
///
/// ```
/// use sinew_core::observation::orientation::OrientationDensity;
///
/// // Three quarters of the votes for one of 36 orientations, the others for one across it.
/// let flat = OrientationDensity::uniform(36)?;
/// let mut votes = [0; 36];
/// votes[flat.bin_of_line(1.0, 0.1)] = 75;
/// votes[flat.bin_of_line(-0.1, 1.0)] = 25;
/// let mut density = flat.from_votes(&votes).smoothed();
/// assert!(density.at(0.1) > 2.0 * density.at(0.1 + core::f32::consts::FRAC_PI_2));
/// // Nothing was seen for a while: it goes half of the way back to uniform, where every density is
/// // 1.
/// let before = density.at(0.1);
/// density.fade(0.5);
/// assert!((density.at(0.1) - 0.5 * (before + 1.0)).abs() < 1e-4);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrientationDensity {
    bins: [f32; MAX_BINS],
    len: usize,
}

impl SavedState for OrientationDensity {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.reals(&mut self.bins, &(0.0..=MAX_BINS as f32));
        visitor.index(&mut self.len, MAX_BINS);
        if self.len < 2 {
            self.len = MAX_BINS;
            visitor.refuse();
        }
    }
}

impl OrientationDensity {
    /// A density before [`Self::begin`]: zeros, which take less flash than ones.
    pub(crate) const fn empty() -> Self {
        Self { bins: [0.0; MAX_BINS], len: 0 }
    }

    /// Makes it uniform over its bins.
    pub fn forget(&mut self) {
        self.bins.fill(1.0);
    }

    /// The uniform density over `bins` bins.
    ///
    /// # Errors
    /// From 2 to [`MAX_BINS`] bins.
    pub fn uniform(bins: usize) -> Result<Self, ParameterError> {
        Self::check(bins)?;
        Ok(Self { bins: [1.0; MAX_BINS], len: bins })
    }

    /// Whether there is room for so many bins.
    pub(crate) fn check(bins: usize) -> Result<(), ParameterError> {
        if (2..=MAX_BINS).contains(&bins) {
            return Ok(());
        }
        Err(ParameterError::new("orientation_bins", Rule::Within { low: 2.0, high: MAX_BINS as f32 }))
    }

    /// Becomes [`Self::uniform`] in place, with the most bins where there is no room for so many.
    pub(crate) fn begin(&mut self, bins: usize) {
        self.forget();
        self.len = if Self::check(bins).is_ok() { bins } else { MAX_BINS };
    }

    /// The density with `counts` votes in its bins (normalised to mass one); uniform without a
    /// vote. Counts beyond the bins are ignored.
    #[must_use]
    pub fn from_votes(&self, counts: &[u16]) -> Self {
        let mut result = *self;
        let total: u32 = counts.iter().take(self.len).map(|&c| u32::from(c)).sum();
        if total == 0 {
            result.bins = [1.0; MAX_BINS];
            return result;
        }
        let scale = self.len as f32 / total as f32;
        for (bin, &count) in result.bins.iter_mut().zip(counts).take(self.len) {
            *bin = f32::from(count) * scale;
        }
        result
    }

    /// Index of the bin that holds `orientation_rad`.
    #[inline]
    #[must_use]
    pub fn bin_of(&self, orientation_rad: f32) -> usize {
        let position = wrap_orientation(orientation_rad) * (self.len as f32 / PI);
        (position as usize).min(self.len - 1)
    }

    /// Index of the bin that holds the orientation of a line that goes `du` across and `dv` down;
    /// they are not both zero.
    ///
    /// The same bin as [`Self::bin_of`] has for atan2(`dv`, `du`), but for lines within 2e-5 rad of
    /// a bin's border.
    #[inline]
    #[must_use]
    pub fn bin_of_line(&self, du: f32, dv: f32) -> usize {
        ((half_turns(du, dv) * self.len as f32) as usize).min(self.len - 1)
    }

    /// Density at `orientation_rad` relative to uniform, linear between the bins' centres, across
    /// the seam too.
    #[must_use]
    pub fn at(&self, orientation_rad: f32) -> f32 {
        let position = wrap_orientation(orientation_rad) * (self.len as f32 / PI) - 0.5;
        let below = floor(position);
        let share = position - below;
        let index = if below < 0.0 { self.len - 1 } else { (below as usize).min(self.len - 1) };
        let next = if index + 1 < self.len { index + 1 } else { 0 };
        let (a, b) = (self.bins.get(index).copied().unwrap_or(1.0), self.bins.get(next).copied().unwrap_or(1.0));
        a + share * (b - a)
    }

    /// Moves the density towards uniform: `keep` of 1 leaves it, 0 forgets it.
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    pub fn fade(&mut self, keep: f32) {
        let keep = clamp(keep, 0.0, 1.0);
        for bin in self.bins.iter_mut().take(rolled(MAX_BINS)) {
            *bin = 1.0 + keep * (*bin - 1.0);
        }
    }

    /// Spreads each bin over its neighbours (1/4, 1/2, 1/4).
    #[must_use]
    pub fn smoothed(&self) -> Self {
        let mut result = *self;
        for i in 0..self.len {
            let before = if i == 0 { self.len - 1 } else { i - 1 };
            let after = if i + 1 < self.len { i + 1 } else { 0 };
            let get = |k: usize| self.bins.get(k).copied().unwrap_or(1.0);
            if let Some(bin) = result.bins.get_mut(i) {
                *bin = 0.25 * get(before) + 0.5 * get(i) + 0.25 * get(after);
            }
        }
        result
    }
}

/// Orientation of a line that goes `du` across and `dv` down, in half turns from 0 to 1; within
/// 2e-5 rad.
///
/// For a slope q from -1 to 1, atan(q) / pi is q (1/4 + (1 - q^2) P(q^2)). It is exact at 0
/// and +-1. P is a minimax fit of third degree.
#[inline]
fn half_turns(du: f32, dv: f32) -> f32 {
    let is_flat = dv * dv <= du * du;
    let slope = if is_flat { dv / du } else { du / dv };
    let square = slope * slope;
    let fit = 0.068_263_9 + square * (-0.036_818_22 + square * (0.020_282_84 - square * 0.006_444_42));
    let turned = slope * (0.25 + (1.0 - square) * fit);
    match (is_flat, turned < 0.0) {
        (false, _) => 0.5 - turned,
        (true, true) => 1.0 + turned,
        (true, false) => turned,
    }
}

/// Running circular variance of orientations, on the doubled angle.
///
/// For small spreads it is the plain variance in square radians: -2 ln R / 4, R the doubled angles'
/// resultant length.
///
/// ```
/// use sinew_core::observation::orientation::OrientationVariance;
///
/// // Lines a tenth of a radian to both sides of the horizontal; which way they are drawn does not
/// // matter.
/// let mut variance = OrientationVariance::default();
/// for (du, dv) in [(1.0, 0.1), (1.0, -0.1), (-1.0, -0.1), (-1.0, 0.1)] {
///     variance.add(du, dv);
/// }
/// assert!((variance.variance_rad2() - 0.01).abs() < 2e-4);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OrientationVariance {
    cosine: f32,
    sine: f32,
    count: f32,
}

impl OrientationVariance {
    /// Adds the orientation of a line that goes `du` across and `dv` down; they are not both zero.
    /// The doubled angle's cosine and sine are those of the square of du + i dv.
    #[inline]
    pub fn add(&mut self, du: f32, dv: f32) {
        let scale = 1.0 / (du * du + dv * dv);
        self.cosine += scale * (du * du - dv * dv);
        self.sine += scale * (2.0 * du * dv);
        self.count += 1.0;
    }

    /// Variance in square radians; that of nearly uniform orientations is bounded by R >= 0.001.
    #[must_use]
    pub fn variance_rad2(&self) -> f32 {
        if !(self.count > 0.0) {
            return 0.0;
        }
        let length = sqrt(self.cosine * self.cosine + self.sine * self.sine) / self.count;
        -0.5 * ln(clamp(length, 1.0e-3, 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_density_has_mass_one(counts in prop::collection::vec(0_u16..100, 36)) {
            let density = OrientationDensity::uniform(36).unwrap().from_votes(&counts);
            let steps = 3600_u16;
            let mean = (0..steps).map(|i| density.at(PI * f32::from(i) / f32::from(steps))).sum::<f32>() / f32::from(steps);
            prop_assert!((mean - 1.0).abs() < 2.0e-3, "mean density {}", mean);
            let smooth = density.smoothed();
            let mean = (0..steps).map(|i| smooth.at(PI * f32::from(i) / f32::from(steps))).sum::<f32>() / f32::from(steps);
            prop_assert!((mean - 1.0).abs() < 2.0e-3);
        }

        #[test]
        fn an_orientation_is_the_same_half_a_turn_on(angle in -7.0_f32..7.0) {
            let mut counts = [0_u16; 36];
            counts[3] = 5;
            counts[35] = 2;
            let density = OrientationDensity::uniform(36).unwrap().from_votes(&counts);
            prop_assert!((density.at(angle) - density.at(angle + PI)).abs() < 1.0e-3);
        }
    }

    #[test]
    fn a_line_falls_into_the_bin_of_its_angle() {
        let density = OrientationDensity::uniform(36).unwrap();
        for (du, dv) in (-60..=60_i8).flat_map(|du| (-60..=60_i8).map(move |dv| (f32::from(du), f32::from(dv)))) {
            if (du, dv) == (0.0, 0.0) {
                continue;
            }
            let angle = dv.atan2(du).rem_euclid(PI) % PI;
            let error = (PI * half_turns(du, dv) - angle).abs();
            assert!(error < 2.0e-5 || (PI - error).abs() < 2.0e-5, "{du}, {dv}: {error}");
            // Only a multiple of 45 degrees lies on the border of a bin; there the fit is exact.
            let border = (angle * 36.0 / PI).round();
            let wanted = if (angle * 36.0 / PI - border).abs() < 1.0e-4 { border } else { (angle * 36.0 / PI).floor() };
            assert_eq!(density.bin_of_line(du, dv), wanted as usize % 36, "{du}, {dv}");
        }
    }

    #[test]
    fn fading_ends_at_uniform() {
        let mut density = OrientationDensity::uniform(4).unwrap().from_votes(&[8, 0, 0, 0]);
        assert!((density.at(PI / 8.0) - 4.0).abs() < 1.0e-5);
        density.fade(0.5);
        assert!((density.at(PI / 8.0) - 2.5).abs() < 1.0e-5);
        density.fade(0.0);
        assert_eq!(density, OrientationDensity::uniform(4).unwrap());
        assert!(OrientationDensity::uniform(1).is_err());
    }

    #[test]
    fn the_variance_of_a_narrow_spread_across_the_seam_is_the_plain_one() {
        let mut variance = OrientationVariance::default();
        for i in -50..=50_i8 {
            let angle = f32::from(i) * 0.004;
            variance.add(30.0 * angle.cos(), 30.0 * angle.sin());
        }
        let plain = (-50..=50_i8).map(|i| (f32::from(i) * 0.004).powi(2)).sum::<f32>() / 101.0;
        assert!((variance.variance_rad2() / plain - 1.0).abs() < 0.02);
    }
}
