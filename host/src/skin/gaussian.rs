//! Fit of the Gaussian chromaticity model: the arm paper's section 3.1.

use super::threshold::{Choice, ColourLevels, cross_validate};
use super::training_set::{Source, TrainingSet, Unit};
use super::white_balance::WhiteBalance;
use crate::error::{Result, bail};
use serde::{Deserialize, Serialize};
use sinew_core::vision::skin::GaussianSkin;
use sinew_core::vision::white_balance::Gains;

/// Step between two threshold levels, Mahalanobis distance.
pub const THRESHOLD_STEP: f64 = 0.05;
/// Threshold levels that are tried: up to a distance of 5.
pub const THRESHOLD_LEVELS: usize = 101;
/// Part of the labelled skin that may be darker than what the model judges.
const DARK_SKIN_PART: f64 = 0.001;
/// Variance of chromaticity added in a fit: an error of about one in R+G+B = 500.
const VARIANCE_FLOOR: f64 = 4.0e-6;

/// Numbers of the Gaussian model; r = R/(R+G+B), g = G/(R+G+B).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GaussianModel {
    /// Mean of r and g.
    pub mean: [f64; 2],
    /// Covariance: rr, rg, gg.
    pub covariance: [f64; 3],
    /// Largest Mahalanobis distance that is skin.
    pub threshold: f64,
    /// Smallest R+G+B that is judged, 0 to 765.
    pub min_sum: u16,
    /// Whether chromaticities are those after a white balance.
    pub white_balance: WhiteBalance,
}

impl GaussianModel {
    /// The core's classifier with these numbers.
    ///
    /// # Errors
    /// Names the number that cannot be used.
    pub fn classifier(&self) -> Result<GaussianSkin> {
        let covariance = self.covariance.map(|value| value as f32);
        let [mean_r, mean_g] = self.mean.map(|value| value as f32);
        Ok(GaussianSkin::new(mean_r, mean_g, covariance, self.threshold as f32, self.min_sum)?)
    }

    /// The Gaussian of raw chromaticities that becomes this one when balanced by `gains`, to first
    /// order around its mean.
    #[must_use]
    pub fn before_balance(&self, gains: &Gains) -> Self {
        let (mean, covariance) = gains.raw_moments(self.mean, self.covariance);
        Self { mean, covariance, ..*self }
    }
}

impl ColourLevels for GaussianSkin {
    fn level(&self, rgb: [u8; 3]) -> usize {
        self.distance(rgb).map_or(usize::MAX, |distance| (f64::from(distance) / THRESHOLD_STEP).ceil() as usize)
    }
}

/// Weighted mean and covariance of chromaticities.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Moments {
    weight: f64,
    sum: [f64; 2],
    products: [f64; 3],
}

impl Moments {
    pub(super) fn add(&mut self, [r, g]: [f64; 2], weight: f64) {
        self.weight += weight;
        self.sum = [self.sum[0] + weight * r, self.sum[1] + weight * g];
        self.products =
            [self.products[0] + weight * r * r, self.products[1] + weight * r * g, self.products[2] + weight * g * g];
    }

    /// Sum of the weights.
    pub(super) fn weight(&self) -> f64 {
        self.weight
    }

    /// Leaves a share of all weights.
    pub(super) fn fade(&mut self, kept: f64) {
        *self = Self::of_numbers(self.numbers().map(|number| kept * number));
    }

    /// All that is known: the weight, sums of r and g, sums of the products rr, rg, gg.
    pub(super) fn numbers(&self) -> [f64; 6] {
        let ([r, g], [rr, rg, gg]) = (self.sum, self.products);
        [self.weight, r, g, rr, rg, gg]
    }

    /// From these.
    pub(super) fn of_numbers([weight, r, g, rr, rg, gg]: [f64; 6]) -> Self {
        Self { weight, sum: [r, g], products: [rr, rg, gg] }
    }

    /// Mean (r, g) and covariance (rr, rg, gg, with a small floor on the diagonal); `None` without
    /// any weight.
    pub(super) fn mean_and_covariance(&self) -> Option<([f64; 2], [f64; 3])> {
        if self.weight <= 0.0 {
            return None;
        }
        let [r, g] = self.sum.map(|sum| sum / self.weight);
        let [rr, rg, gg] = self.products.map(|product| product / self.weight);
        let floored = |variance: f64| variance.max(0.0) + VARIANCE_FLOOR;
        Some(([r, g], [floored(rr - r * r), rg - r * g, floored(gg - g * g)]))
    }
}

/// Chromaticity (r, g) of a colour; `None` for black.
pub(super) fn chromaticity(rgb: [f64; 3]) -> Option<[f64; 2]> {
    let sum: f64 = rgb.iter().sum();
    (sum > 0.0).then(|| [rgb[0] / sum, rgb[1] / sum])
}

/// Fits mean, covariance and the darkest sum to the skin of `units`; the threshold is left at
/// `threshold`.
fn fit(units: &[&Unit], threshold: f64) -> Result<GaussianModel> {
    let mut moments = Moments::default();
    let mut count_of_sum = vec![0_u64; 766];
    for colour in units.iter().flat_map(|unit| &unit.colours).filter(|colour| colour.is_skin) {
        if let Some(rg) = chromaticity(colour.rgb.map(f64::from)) {
            moments.add(rg, f64::from(colour.count));
        }
        count_of_sum[colour.rgb.iter().map(|&c| usize::from(c)).sum::<usize>()] += u64::from(colour.count);
    }
    let Some((mean, covariance)) = moments.mean_and_covariance() else {
        bail!("there is no skin pixel to train from; label some as skin");
    };
    let allowed = (count_of_sum.iter().sum::<u64>() as f64 * DARK_SKIN_PART) as u64;
    let mut darker = 0;
    let min_sum = count_of_sum.iter().position(|&count| {
        darker += count;
        darker > allowed
    });
    Ok(GaussianModel {
        mean,
        covariance,
        threshold,
        min_sum: min_sum.unwrap_or(0) as u16,
        white_balance: WhiteBalance::QuarterGreyWorld,
    })
}

/// The set with the colours of each image balanced; a list of pixels has no image to balance by and
/// stays as it is.
fn balanced(set: &TrainingSet) -> TrainingSet {
    let mut set = set.clone();
    if set.source == Source::PixelList {
        return set;
    }
    for unit in &mut set.units {
        let mut mean = [0.0; 3];
        for colour in &unit.colours {
            mean = [0, 1, 2].map(|i| mean[i] + f64::from(colour.rgb[i]) * f64::from(colour.count));
        }
        let gains = Gains::quarter_grey_world(mean.map(|sum| sum / unit.counted_pixels().max(1.0)));
        for colour in &mut unit.colours {
            colour.rgb = gains.apply(colour.rgb).map(|channel| channel.round().min(255.0) as u8);
        }
    }
    set
}

/// Trains the model: moments from all skin, the threshold by cross-validation.
///
/// # Errors
/// No skin in a training fold.
pub fn train(set: &TrainingSet, folds: usize, seed: u64) -> Result<(GaussianModel, Choice)> {
    let set = &balanced(set);
    let curve = cross_validate(set, folds, seed, THRESHOLD_LEVELS, |units| fit(units, 1.0)?.classifier())?;
    let choice = curve.choose();
    let units: Vec<&Unit> = set.units.iter().collect();
    Ok((fit(&units, choice.level.max(1) as f64 * THRESHOLD_STEP)?, choice))
}

#[cfg(test)]
mod tests {
    use super::super::labelled_pixels::{LabelledPixel, LabelledPixels};
    use super::*;
    use sinew_core::random::Stream;

    fn drawn_set() -> TrainingSet {
        let mut stream = Stream::new(5, 0, 0);
        let mut unique = Vec::new();
        for _ in 0..4000 {
            let sum = 300.0 + 300.0 * stream.uniform();
            let (r, g) = (0.45 + 0.02 * stream.normal(), 0.31 + 0.01 * stream.normal());
            let rgb = [r * sum, g * sum, (1.0 - r - g) * sum].map(|c| c.round().clamp(0.0, 255.0) as u8);
            unique.push(LabelledPixel { rgb, is_skin: true });
            let rgb = [0; 3].map(|_| stream.below(256) as u8);
            unique.push(LabelledPixel { rgb, is_skin: false });
        }
        unique.sort_unstable();
        unique.dedup();
        TrainingSet::from_pixels("drawn".to_owned(), &LabelledPixels { row_count: unique.len(), unique }, 1)
    }

    #[test]
    fn the_fit_finds_the_distribution_that_was_drawn_from() {
        let (model, choice) = train(&drawn_set(), 5, 1).unwrap();
        assert!((model.mean[0] - 0.45).abs() < 0.002 && (model.mean[1] - 0.31).abs() < 0.002, "{model:?}");
        let std = [model.covariance[0].sqrt(), model.covariance[2].sqrt()];
        assert!((std[0] - 0.02).abs() < 0.002 && (std[1] - 0.01).abs() < 0.0015, "{std:?}");
        assert!((1.5..4.0).contains(&model.threshold), "{}", model.threshold);
        assert!((280..330).contains(&model.min_sum), "{}", model.min_sum);
        assert!(choice.scores.f1 > 0.9 && choice.scores.f1 < 1.0, "{choice:?}");
    }

    #[test]
    fn the_level_is_the_tightest_that_accepts() {
        let skin = GaussianModel {
            mean: [0.4, 0.3],
            covariance: [0.01, 0.0, 0.04],
            threshold: 1.0,
            min_sum: 50,
            white_balance: WhiteBalance::None,
        };
        let skin = skin.classifier().unwrap();
        assert_eq!(skin.level([1, 1, 1]), usize::MAX);
        let level = skin.level([60, 32, 8]);
        let distance = f64::from(skin.distance([60, 32, 8]).unwrap());
        assert!(level as f64 * THRESHOLD_STEP >= distance && (level - 1) as f64 * THRESHOLD_STEP < distance);
    }

    #[test]
    fn one_colour_only_still_gives_a_model() {
        let unique = [([200, 140, 110], true), ([0, 0, 0], true), ([10, 200, 30], false)];
        let unique = unique.map(|(rgb, is_skin)| LabelledPixel { rgb, is_skin }).to_vec();
        let set = TrainingSet::from_pixels("one".to_owned(), &LabelledPixels { unique, row_count: 3 }, 1);
        let units: Vec<&Unit> = set.units.iter().collect();
        assert!(fit(&units, 2.0).unwrap().classifier().unwrap().distance([200, 140, 110]).unwrap() < 0.01);
    }
}
