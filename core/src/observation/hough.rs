//! The dynamic Hough transform: the orientations of lines through random pairs of pixels; arm (10)
//! to (12).
//!
//! Pairs are drawn until the variance of the orientations is stable, arm (10) to (12), or until a
//! stated maximum. The rule is checked every tenth pair. It keeps the constant 12 of arm (12); an
//! interval of +-lambda has variance lambda^2/3, which only rescales gamma.

use super::orientation::{MAX_BINS, OrientationDensity, OrientationVariance};
use crate::error::{ParameterError, Rule, positive};
use crate::random::Stream;
use crate::vision::edges::EdgePixel;

/// Pairs between two checks of the stop rule.
pub const CHECK_EVERY: usize = 10;
/// Longest window j, in checks.
pub const MAX_WINDOW: usize = 32;

/// Settings of the transform.
///
/// ```
/// use sinew_core::observation::hough::HoughSettings;
///
/// // Half of the work at most, on a coarser histogram.
/// let quick = HoughSettings { bins: 18, max_pairs: 500, ..HoughSettings::default() };
/// assert!(quick.check().is_ok());
/// // A wrong value is refused by its name.
/// let wrong = HoughSettings { window: 1, ..quick };
/// assert_eq!(wrong.check().map_err(|error| error.parameter), Err("hough.window"));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct HoughSettings {
    /// Bins of the histogram over pi.
    pub bins: usize,
    /// Number j of the last variances that have to agree, one every [`CHECK_EVERY`] pairs.
    pub window: usize,
    /// gamma of arm (11): how closely they have to agree.
    pub gamma: f32,
    /// Largest number of pairs drawn; the bound of the work.
    pub max_pairs: usize,
    /// Pairs nearer than this are drawn but do not vote: neighbours have only eight orientations.
    pub min_separation_px: f32,
    /// With fewer pixels than this the density is uniform.
    pub min_pixels: usize,
    /// The density of n pixels has the weight n / (n + `doubt_pixels`), the uniform one the rest.
    pub doubt_pixels: f32,
}

impl Default for HoughSettings {
    fn default() -> Self {
        Self {
            bins: 36,
            window: 10,
            gamma: 10.0,
            max_pairs: 1000,
            min_separation_px: 8.0,
            min_pixels: 12,
            doubt_pixels: 60.0,
        }
    }
}

impl HoughSettings {
    /// Checks every value.
    ///
    /// # Errors
    /// Bins from 2 to [`MAX_BINS`], window from 2 to [`MAX_WINDOW`], gamma and separation positive,
    /// pairs from 10 to 65,535.
    pub fn check(&self) -> Result<(), ParameterError> {
        OrientationDensity::check(self.bins)?;
        if !(2..=MAX_WINDOW).contains(&self.window) {
            return Err(ParameterError::new("hough.window", Rule::Within { low: 2.0, high: MAX_WINDOW as f32 }));
        }
        positive("hough.gamma", self.gamma)?;
        positive("hough.min_separation_px", self.min_separation_px)?;
        crate::error::not_negative("hough.doubt_pixels", self.doubt_pixels)?;
        if !(CHECK_EVERY..=usize::from(u16::MAX)).contains(&self.max_pairs) {
            return Err(ParameterError::new("hough.max_pairs", Rule::Within { low: 10.0, high: 65_535.0 }));
        }
        Ok(())
    }
}

/// Result of the transform.
///
/// ```
/// use sinew_core::observation::hough::{HoughSettings, dynamic_hough};
/// use sinew_core::random::Stream;
/// use sinew_core::vision::edges::EdgePixel;
///
/// // One clean line: the drawing ends long before the bound, as soon as the variance has settled.
/// let line =
///     core::array::from_fn::<EdgePixel, 90, _>(|i| EdgePixel { u: 100 + 2 * i as u16, v: 80 });
/// let settings = HoughSettings::default();
/// let found = dynamic_hough(&line, &settings, &mut Stream::new(1, 0, 0)).expect("enough pixels");
/// assert!(found.stable && found.pairs < settings.max_pairs / 2, "{} pairs", found.pairs);
/// assert!(found.density.at(0.0) > 3.0, "times as likely as by chance");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HoughResult {
    /// Density of the orientation.
    pub density: OrientationDensity,
    /// Pairs that were drawn.
    pub pairs: usize,
    /// Whether the stop rule ended the drawing (and not the maximum).
    pub stable: bool,
}

/// The last j variances, arm (10).
#[derive(Debug, Clone, Copy)]
struct StopRule {
    values: [f32; MAX_WINDOW],
    window: usize,
    seen: usize,
}

impl StopRule {
    /// Adds a variance; whether arm (12) holds for the last j.
    fn is_stable(&mut self, variance: f32, gamma: f32) -> bool {
        let oldest = self.seen.checked_rem(self.window);
        if let Some(slot) = oldest.and_then(|oldest| self.values.get_mut(oldest)) {
            *slot = variance;
        }
        self.seen += 1;
        if self.seen < self.window {
            return false;
        }
        let last = self.values.iter().take(self.window);
        let mean = last.clone().sum::<f32>() / self.window as f32;
        let spread = last.map(|v| (v - mean) * (v - mean)).sum::<f32>() / self.window as f32;
        spread <= mean * mean / (12.0 * gamma * gamma)
    }
}

/// Orientation density of the lines in `pixels`; uniform where they are too few or too near to one
/// another.
///
/// ```
/// use sinew_core::observation::hough::{HoughSettings, dynamic_hough};
/// use sinew_core::random::Stream;
/// use sinew_core::vision::edges::EdgePixel;
///
/// // A limb that goes as far down as across.
/// let limb = core::array::from_fn::<EdgePixel, 60, _>(|i| EdgePixel {
///     u: 100 + i as u16,
///     v: 80 + i as u16,
/// });
/// let find = |pixels: &[EdgePixel]| {
///     dynamic_hough(pixels, &HoughSettings::default(), &mut Stream::new(1, 0, 0))
/// };
/// let density = find(&limb).expect("enough pixels").density;
/// assert!(density.at(45.0_f32.to_radians()) > 4.0 * density.at(135.0_f32.to_radians()));
/// assert!(find(&limb[..5]).is_none(), "five pixels are too few");
/// ```
#[must_use]
pub fn dynamic_hough(pixels: &[EdgePixel], settings: &HoughSettings, stream: &mut Stream) -> Option<HoughResult> {
    let uniform = OrientationDensity::uniform(settings.bins).ok()?;
    if pixels.len() < settings.min_pixels.max(2) {
        return None;
    }
    let mut votes = [0_u16; MAX_BINS];
    let mut voters = 0_usize;
    let mut variance = OrientationVariance::default();
    let mut stop = StopRule { values: [0.0; MAX_WINDOW], window: settings.window.clamp(2, MAX_WINDOW), seen: 0 };
    let least = settings.min_separation_px * settings.min_separation_px;
    let mut pairs = 0;
    let mut stable = false;
    while pairs < settings.max_pairs && !stable {
        let drawn = |stream: &mut Stream| pixels.get(stream.below(pixels.len() as u32) as usize).copied();
        let (Some(a), Some(b)) = (drawn(stream), drawn(stream)) else { break };
        let (du, dv) = (f32::from(a.u) - f32::from(b.u), f32::from(a.v) - f32::from(b.v));
        if du * du + dv * dv >= least {
            variance.add(du, dv);
            if let Some(vote) = votes.get_mut(uniform.bin_of_line(du, dv)) {
                *vote = vote.saturating_add(1);
            }
            voters += 1;
        }
        pairs += 1;
        if pairs % CHECK_EVERY == 0 && voters > 0 {
            stable = stop.is_stable(variance.variance_rad2(), settings.gamma);
        }
    }
    let mut density = uniform.from_votes(&votes).smoothed();
    // Few pixels make sharp peaks by chance.
    density.fade(pixels.len() as f32 / (pixels.len() as f32 + settings.doubt_pixels));
    (voters > 0).then_some(HoughResult { density, pairs, stable })
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::PI;

    fn line(angle: f32, count: u16) -> Vec<EdgePixel> {
        (0..count)
            .map(|i| {
                let along = f32::from(i) * 2.0;
                EdgePixel { u: (300.0 + along * angle.cos()) as u16, v: (200.0 + along * angle.sin()) as u16 }
            })
            .collect()
    }

    #[test]
    fn a_line_s_orientation_is_found_and_ends_the_drawing_early() {
        let settings = HoughSettings { doubt_pixels: 0.0, ..HoughSettings::default() };
        for angle in [0.0_f32, 0.4, 1.2, 1.57] {
            let result = dynamic_hough(&line(angle, 60), &settings, &mut Stream::new(1, 0, 0)).unwrap();
            assert!(result.density.at(angle) > 5.0, "density {} at {angle}", result.density.at(angle));
            assert!(result.density.at(angle + PI / 2.0) < 0.1);
            assert!(result.stable && result.pairs < 600, "{} pairs", result.pairs);
        }
    }

    #[test]
    fn doubt_leaves_a_uniform_part_that_shrinks_with_the_pixels() {
        let settings = HoughSettings { doubt_pixels: 20.0, ..HoughSettings::default() };
        for (count, uniform_part) in [(20, 0.5), (60, 0.25), (180, 0.1)] {
            let result = dynamic_hough(&line(0.4, count), &settings, &mut Stream::new(1, 0, 0)).unwrap();
            let across = result.density.at(0.4 + PI / 2.0);
            assert!((across - uniform_part).abs() < 1.0e-3, "{across} with {count} pixels");
        }
    }

    #[test]
    fn weak_lines_need_more_pairs_than_strong_ones() {
        let mut stream = Stream::new(2, 0, 0);
        let mut noisy = line(0.8, 30);
        for _ in 0..200 {
            noisy.push(EdgePixel { u: 200 + stream.below(200) as u16, v: 100 + stream.below(200) as u16 });
        }
        let pairs = |pixels: &[EdgePixel]| -> usize {
            (0..20)
                .map(|i| dynamic_hough(pixels, &HoughSettings::default(), &mut Stream::new(3, 0, i)).unwrap().pairs)
                .sum()
        };
        assert!(pairs(&noisy) > pairs(&line(0.8, 200)));
    }

    #[test]
    fn too_few_or_coinciding_pixels_say_nothing() {
        let settings = HoughSettings::default();
        assert_eq!(dynamic_hough(&[], &settings, &mut Stream::new(1, 0, 0)), None);
        let heap = vec![EdgePixel { u: 5, v: 5 }; 100];
        assert_eq!(dynamic_hough(&heap, &settings, &mut Stream::new(1, 0, 0)), None);
    }

    #[test]
    fn settings_out_of_range_are_named() {
        let wrong = HoughSettings { window: 100, ..HoughSettings::default() };
        assert_eq!(wrong.check().unwrap_err().parameter, "hough.window");
    }
}
