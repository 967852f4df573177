//! A skin model of either kind, from a shipped default or a file, applied to whole images.

use super::bit_image::BitImage;
use super::confusion::Scores;
use super::gaussian::GaussianModel;
use super::histogram::HistogramModel;
use super::white_balance::WhiteBalance;
use crate::error::Result;
use crate::pixels::{Picture, Pixels};
use serde::{Deserialize, Serialize};
use sinew_core::vision::frame::segment;
use sinew_core::vision::skin::{CUBE_WORDS, GaussianSkin, HistogramSkin, SkinClassifier};
use std::borrow::Cow;

/// What `--skin` is when it is not given; `docs/skin.md` says why.
pub const DEFAULT_SKIN: &str = "gaussian";

/// The two kinds of model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "command", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum ModelKind {
    /// A normal distribution of chromaticity.
    Gaussian,
    /// A table over colours.
    Histogram,
}

/// The numbers of a model.
#[derive(Debug, Clone, PartialEq)]
pub enum ModelNumbers {
    /// Of a Gaussian.
    Gaussian(GaussianModel),
    /// Of a histogram.
    Histogram(HistogramModel),
}

/// The core classifier that a model's numbers make.
#[derive(Debug, Clone, PartialEq)]
enum Classifier {
    Gaussian(GaussianSkin),
    Histogram(Box<[u32; CUBE_WORDS]>),
}

/// What a model was trained on, and how well it did there.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrainedOn {
    /// Names of files or folders, without the places where they lay.
    pub sources: Vec<String>,
    /// Number of images, 0 for a list of pixels.
    pub images: u64,
    /// Pixels of skin that were counted (of images a sample, of a list the different rows).
    pub skin_pixels: u64,
    /// Other pixels that were counted.
    pub other_pixels: u64,
    /// Folds of the cross-validation.
    pub folds: u64,
    /// Seed of the shuffling.
    pub seed: u64,
    /// Pooled scores at the chosen threshold, each unit judged by a model that was not trained on
    /// it.
    pub cross_validated: Scores,
}

/// A skin model that is ready for use.
#[derive(Debug, Clone, PartialEq)]
pub struct SkinModel {
    numbers: ModelNumbers,
    classifier: Classifier,
    /// What it was trained on; kept by a calibration.
    pub trained_on: TrainedOn,
}

impl SkinModel {
    /// Builds the classifier of `numbers`.
    ///
    /// # Errors
    /// Names the number that cannot be used.
    pub fn new(numbers: ModelNumbers, trained_on: TrainedOn) -> Result<Self> {
        let classifier = match &numbers {
            ModelNumbers::Gaussian(gaussian) => Classifier::Gaussian(gaussian.classifier()?),
            ModelNumbers::Histogram(histogram) => Classifier::Histogram(histogram.table()),
        };
        Ok(Self { numbers, classifier, trained_on })
    }

    /// The numbers.
    #[must_use]
    pub fn numbers(&self) -> &ModelNumbers {
        &self.numbers
    }

    /// The kind.
    #[must_use]
    pub fn kind(&self) -> ModelKind {
        match self.numbers {
            ModelNumbers::Gaussian(_) => ModelKind::Gaussian,
            ModelNumbers::Histogram(_) => ModelKind::Histogram,
        }
    }

    /// The model as it is to be used line by line on `image`: a Gaussian follows the image's tint.
    ///
    /// As a [`SkinClassifier`] a model knows single lines only; call this for each image first.
    ///
    /// # Errors
    /// None in practice: a small change of tint keeps all numbers usable.
    pub fn for_image(&self, image: &Picture<impl Pixels>) -> Result<Cow<'_, Self>> {
        match &self.numbers {
            ModelNumbers::Gaussian(gaussian) if gaussian.white_balance == WhiteBalance::QuarterGreyWorld => {
                let raw = gaussian.before_balance(&gaussian.white_balance.gains(image));
                let raw = GaussianModel { white_balance: WhiteBalance::None, ..raw };
                Ok(Cow::Owned(Self::new(ModelNumbers::Gaussian(raw), self.trained_on.clone())?))
            }
            _ => Ok(Cow::Borrowed(self)),
        }
    }

    /// The raw skin mask of an image, without any morphology.
    ///
    /// # Errors
    /// The image has no pixels or is larger than a mask can be.
    pub fn classify(&self, image: &Picture<impl Pixels>) -> Result<BitImage> {
        let model = self.for_image(image)?;
        let mut bits = BitImage::new(image.width() as usize, image.height() as usize)?;
        segment(image.as_raw(), model.as_ref(), &mut bits.view_mut()?);
        Ok(bits)
    }
}

impl SkinClassifier for SkinModel {
    fn classify_line(&self, rgb: &[u8], bits: &mut [u32]) {
        match &self.classifier {
            Classifier::Gaussian(gaussian) => gaussian.classify_line(rgb, bits),
            Classifier::Histogram(table) => HistogramSkin::new(table).classify_line(rgb, bits),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{Rgb, RgbImage};

    #[test]
    fn both_shipped_models_separate_skin_from_sky() {
        for name in ["gaussian", "histogram"] {
            let model = SkinModel::from_option(name).unwrap();
            let image = RgbImage::from_fn(50, 3, |u, _| Rgb(if u < 20 { [196, 140, 115] } else { [120, 160, 220] }));
            let mask = model.classify(&image).unwrap();
            assert_eq!(mask.view().unwrap().count(), 60, "{name}");
            assert!(mask.view().unwrap().get(19, 2) && !mask.view().unwrap().get(20, 2));
        }
    }

    #[test]
    fn an_unknown_name_is_refused_with_the_choices() {
        let message = SkinModel::from_option("gausian").unwrap_err().to_string();
        assert!(message.contains("gaussian, histogram") && message.contains("gausian"), "{message}");
    }
}
