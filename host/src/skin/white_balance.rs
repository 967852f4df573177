//! How a skin model follows the tint of an image; the correction is
//! [`sinew_core::vision::white_balance`].

use crate::pixels::{Picture, Pixels};
use serde::{Deserialize, Serialize};
use sinew_core::vision::white_balance::Gains;

/// How a model's chromaticities relate to those of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WhiteBalance {
    /// They are the same.
    None,
    /// The model's are those of the image after [`Gains::quarter_grey_world`].
    QuarterGreyWorld,
}

impl WhiteBalance {
    /// The gains that balance `image`.
    #[must_use]
    pub fn gains(self, image: &Picture<impl Pixels>) -> Gains {
        match self {
            Self::None => Gains::NEUTRAL,
            Self::QuarterGreyWorld => Gains::of_picture(image.as_raw(), image.width() as usize),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::gaussian::{GaussianModel, chromaticity};
    use super::*;
    use image::{Rgb, RgbImage};

    fn model() -> GaussianModel {
        let white_balance = WhiteBalance::QuarterGreyWorld;
        GaussianModel {
            mean: [0.45, 0.31],
            covariance: [1.6e-3, 1e-4, 1.8e-4],
            threshold: 2.0,
            min_sum: 60,
            white_balance,
        }
    }

    #[test]
    fn a_grey_image_changes_nothing() {
        let grey = RgbImage::from_fn(9, 9, |u, v| Rgb([(u * 20 + v) as u8; 3]));
        assert_eq!(WhiteBalance::QuarterGreyWorld.gains(&grey), Gains::NEUTRAL);
        let same = model().before_balance(&Gains::NEUTRAL);
        assert!((same.mean[0] - 0.45).abs() < 1e-12 && (same.covariance[0] - 1.6e-3).abs() < 1e-12);
    }

    #[test]
    fn the_raw_model_measures_as_the_model_does_after_balancing() {
        let gains = Gains::quarter_grey_world([180.0, 120.0, 90.0]);
        let (raw, balanced) = (model().before_balance(&gains).classifier().unwrap(), model().classifier().unwrap());
        for rgb in [[180, 120, 90], [200, 130, 120], [150, 110, 70], [120, 90, 85]] {
            let scaled = gains.apply(rgb);
            let after = balanced.distance(scaled.map(|c| (c.round()) as u8)).unwrap();
            let before = raw.distance(rgb).unwrap();
            assert!((before - after).abs() < 0.15, "{rgb:?}: {before} and {after}");
        }
    }

    #[test]
    fn red_light_pulls_the_raw_mean_to_red_and_black_is_no_trouble() {
        let raw = model().before_balance(&Gains::quarter_grey_world([200.0, 100.0, 100.0]));
        assert!(raw.mean[0] > 0.47, "{:?}", raw.mean);
        assert_eq!(WhiteBalance::QuarterGreyWorld.gains(&RgbImage::new(3, 3)), Gains::NEUTRAL);
        assert!(chromaticity([0.0; 3]).is_none());
    }
}
