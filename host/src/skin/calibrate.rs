//! Adapts a skin model to a scene's light and person, from a rectangle of skin in one frame.

use super::colour_cube::{CELLS, cell_of, relit, smooth};
use super::gaussian::{GaussianModel, Moments, chromaticity};
use super::histogram::{HistogramModel, SMOOTHING_STD_CELLS};
use super::model::{ModelNumbers, SkinModel};
use crate::error::{Result, bail, ensure};
use crate::pixels::{Picture, Pixels};
use serde::Serialize;
use sinew_core::vision::white_balance::Gains;
use std::str::FromStr;

/// Pixels' worth of evidence that the trained Gaussian counts against the rectangle's pixels.
const TRAINED_PIXELS: f64 = 30.0;
/// Largest part that the rectangle gets: one patch of skin does not show all its shades.
const MAX_RECTANGLE_PART: f64 = 0.8;
/// Rounds of trimming.
const TRIMMING_ROUNDS: usize = 5;
/// Squared Mahalanobis distance beyond which a pixel is trimmed: 99 % of a two-dimensional normal
/// distribution.
const TRIM_SQUARED: f64 = 9.21;
/// Part of the scene's skin that is taken to look like the rectangle, in the histogram.
const RECTANGLE_SHARE: f64 = 0.3;
/// Strengths of light under which the rectangle's colours are expected elsewhere in the scene.
const SHADES: [f64; 7] = [0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3];

/// A rectangle of pixels, as given to `--calibrate X,Y,W,H`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Rectangle {
    /// Column of its left edge, pixels.
    pub x_px: u32,
    /// Row of its top edge, pixels.
    pub y_px: u32,
    /// Width, pixels, at least 1.
    pub width_px: u32,
    /// Height, pixels, at least 1.
    pub height_px: u32,
}

impl FromStr for Rectangle {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts: Vec<Option<u32>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
        let [Some(x_px), Some(y_px), Some(width_px), Some(height_px)] = parts[..] else {
            return Err(format!("`{text}` is not X,Y,W,H: four whole numbers of pixels, such as 300,120,40,60"));
        };
        if width_px == 0 || height_px == 0 {
            return Err(format!("`{text}` has no pixels: width and height have to be at least 1"));
        }
        Ok(Self { x_px, y_px, width_px, height_px })
    }
}

impl Rectangle {
    /// The colours inside.
    ///
    /// # Errors
    /// It does not lie wholly in the image.
    fn colours(&self, image: &Picture<impl Pixels>) -> Result<Vec<[u8; 3]>> {
        let fits = |from: u32, length: u32, side: u32| from.checked_add(length).is_some_and(|end| end <= side);
        ensure!(
            fits(self.x_px, self.width_px, image.width()) && fits(self.y_px, self.height_px, image.height()),
            "calibration rectangle {},{},{},{} does not lie inside of the image, which has {}x{} pixels",
            self.x_px,
            self.y_px,
            self.width_px,
            self.height_px,
            image.width(),
            image.height()
        );
        let rows = self.y_px..self.y_px + self.height_px;
        let pixel = |x, y| image.get_pixel(x, y).0;
        Ok(rows.flat_map(|y| (self.x_px..self.x_px + self.width_px).map(move |x| pixel(x, y))).collect())
    }
}

impl SkinModel {
    /// This model adapted to a scene in which `rectangle` of `image` shows skin.
    ///
    /// # Errors
    /// The rectangle does not lie inside of the image, or holds only black.
    pub fn calibrated(&self, image: &Picture<impl Pixels>, rectangle: Rectangle) -> Result<Self> {
        let colours = rectangle.colours(image)?;
        let numbers = match self.numbers() {
            ModelNumbers::Gaussian(gaussian) => {
                ModelNumbers::Gaussian(adapt_gaussian(gaussian, &colours, gaussian.white_balance.gains(image))?)
            }
            ModelNumbers::Histogram(histogram) => ModelNumbers::Histogram(adapt_histogram(histogram, &colours)?),
        };
        Self::new(numbers, self.trained_on.clone())
    }
}

/// Blends the trained moments with the rectangle's, trimmed of what is not skin in it (rings,
/// glare, background).
fn adapt_gaussian(trained: &GaussianModel, colours: &[[u8; 3]], gains: Gains) -> Result<GaussianModel> {
    let points: Vec<[f64; 2]> = colours.iter().filter_map(|&rgb| chromaticity(gains.apply(rgb))).collect();
    let (mean, covariance, kept) = trimmed_moments(&points)?;
    let mut sums: Vec<u16> = colours.iter().map(|rgb| rgb.iter().map(|&c| u16::from(c)).sum()).collect();
    sums.sort_unstable();
    // Half as bright as the rectangle's darker part may still be this skin, in its own shadow.
    let shadow = sums[sums.len() / 10] / 2;
    let blended = blended(trained, (mean, covariance), kept);
    Ok(GaussianModel { min_sum: trained.min_sum.min(shadow), ..blended })
}

/// The trained model with mean and covariance of so many pixels of this scene in part.
pub(super) fn blended(trained: &GaussianModel, here: ([f64; 2], [f64; 3]), pixels: f64) -> GaussianModel {
    let part = (pixels / (pixels + TRAINED_PIXELS)).min(MAX_RECTANGLE_PART);
    let blend = |trained: f64, here: f64| (1.0 - part) * trained + part * here;
    let (mean, covariance) = here;
    GaussianModel {
        mean: [0, 1].map(|i| blend(trained.mean[i], mean[i])),
        covariance: [0, 1, 2].map(|i| blend(trained.covariance[i], covariance[i])),
        ..*trained
    }
}

/// Mean, covariance and number of points, after rounds of leaving out what lies far from the rest.
fn trimmed_moments(points: &[[f64; 2]]) -> Result<([f64; 2], [f64; 3], f64)> {
    if points.is_empty() {
        bail!("the calibration rectangle is all black; choose one that shows skin");
    }
    let middle = [0, 1].map(|i| {
        let mut values: Vec<f64> = points.iter().map(|point| point[i]).collect();
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    });
    // First the half that is nearest to the median.
    let square = |point: &[f64; 2]| (point[0] - middle[0]).powi(2) + (point[1] - middle[1]).powi(2);
    let mut nearest: Vec<[f64; 2]> = points.to_vec();
    nearest.sort_by(|a, b| square(a).total_cmp(&square(b)));
    nearest.truncate(points.len().div_ceil(2));
    let mut kept = nearest;
    for _ in 0..TRIMMING_ROUNDS {
        let (mean, covariance) = moments_of(&kept)?;
        kept = points
            .iter()
            .filter(|&&point| squared_distance(point, mean, covariance) <= TRIM_SQUARED)
            .copied()
            .collect();
    }
    let (mean, covariance) = moments_of(&kept)?;
    Ok((mean, covariance, kept.len() as f64))
}

fn moments_of(points: &[[f64; 2]]) -> Result<([f64; 2], [f64; 3])> {
    let mut moments = Moments::default();
    points.iter().for_each(|&point| moments.add(point, 1.0));
    match moments.mean_and_covariance() {
        Some(found) => Ok(found),
        None => bail!("the calibration rectangle shows no common colour; choose one that shows only skin"),
    }
}

fn squared_distance(point: [f64; 2], mean: [f64; 2], [rr, rg, gg]: [f64; 3]) -> f64 {
    let (r, g) = (point[0] - mean[0], point[1] - mean[1]);
    (gg * r * r - 2.0 * rg * r * g + rr * g * g) / (rr * gg - rg * rg)
}

/// Makes [`RECTANGLE_SHARE`] of all skin look like the rectangle, in all [`SHADES`]; the rest looks
/// as it was trained.
fn adapt_histogram(trained: &HistogramModel, colours: &[[u8; 3]]) -> Result<HistogramModel> {
    let mut density = vec![0.0; CELLS];
    for rgb in colours.iter().flat_map(|&rgb| SHADES.iter().filter_map(move |&gain| relit(rgb, gain, [1.0; 3]))) {
        density[cell_of(rgb)] += 1.0;
    }
    let total: f64 = density.iter().sum();
    ensure!(total > density[0], "the calibration rectangle is all black; choose one that shows skin");
    let density = smooth(&density, SMOOTHING_STD_CELLS);
    let (mut skin, other): (Vec<f64>, Vec<f64>) = (0..CELLS).map(|cell| trained.masses(cell)).unzip();
    let rectangle_mass = RECTANGLE_SHARE * skin.iter().sum::<f64>() / total;
    for (mass, part) in skin.iter_mut().zip(density) {
        *mass = (1.0 - RECTANGLE_SHARE) * *mass + rectangle_mass * part;
    }
    Ok(HistogramModel::from_masses(&skin, &other, trained.min_probability))
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{Rgb, RgbImage};

    /// Bluish light: neither shipped model takes it for skin.
    const LIT_SKIN: [u8; 3] = [120, 105, 140];

    fn scene() -> RgbImage {
        RgbImage::from_fn(60, 40, |u, v| {
            let noise = ((u * 7 + v * 13) % 5) as u8;
            Rgb(if u < 30 { LIT_SKIN.map(|c| c + noise) } else { [40 + noise, 130, 60] })
        })
    }

    #[test]
    fn a_rectangle_teaches_both_models_the_scene() {
        let rectangle = Rectangle { x_px: 5, y_px: 5, width_px: 20, height_px: 30 };
        for name in ["gaussian", "histogram"] {
            let trained = SkinModel::from_option(name).unwrap();
            assert!(trained.classify(&scene()).unwrap().view().unwrap().count() < 100, "{name} before");
            let adapted = trained.calibrated(&scene(), rectangle).unwrap();
            let mask = adapted.classify(&scene()).unwrap();
            let found = mask.view().unwrap().count();
            assert!((1100..=1200).contains(&found), "{name} finds {found} of 1200 pixels");
            let usual = RgbImage::from_pixel(2, 2, Rgb([196, 140, 115]));
            if name == "histogram" {
                assert_eq!(adapted.classify(&usual).unwrap().view().unwrap().count(), 4);
            }
        }
    }

    #[test]
    fn glare_in_the_rectangle_is_trimmed() {
        let mut points = vec![[0.40, 0.30]; 300];
        for (i, point) in points.iter_mut().enumerate() {
            point[0] += 0.001 * (i % 7) as f64;
            point[1] += 0.001 * (i % 5) as f64;
        }
        points.extend([[0.33, 0.33]; 60]);
        let (mean, _, kept) = trimmed_moments(&points).unwrap();
        assert!((mean[0] - 0.403).abs() < 0.001 && (mean[1] - 0.302).abs() < 0.001, "{mean:?}");
        assert!((270.0..=300.0).contains(&kept), "{kept}");
    }

    #[test]
    fn bad_rectangles_are_refused() {
        let parse = |text: &str| text.parse::<Rectangle>();
        assert!(parse("1,2,3").unwrap_err().contains("X,Y,W,H"));
        assert!(parse("1,2,3,x").unwrap_err().contains("X,Y,W,H"));
        assert!(parse("-1,2,3,4").unwrap_err().contains("X,Y,W,H"));
        assert!(parse("1,2,0,4").unwrap_err().contains("at least 1"));
        let model = SkinModel::from_option("gaussian").unwrap();
        for text in ["50,0,11,5", "0,36,5,5", "4294967295,0,2,2"] {
            let message = model.calibrated(&scene(), parse(text).unwrap()).unwrap_err().to_string();
            assert!(message.contains("60x40") && message.contains(text), "{message}");
        }
        let black = RgbImage::new(9, 9);
        for name in ["gaussian", "histogram"] {
            let refused = SkinModel::from_option(name).unwrap().calibrated(&black, parse("0,0,9,9").unwrap());
            assert!(refused.unwrap_err().to_string().contains("black"));
        }
    }
}
