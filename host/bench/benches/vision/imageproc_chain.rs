//! The same steps with imageproc's functions.

use crate::scene::{FramePair, skin};
use crate::timed;
use image::{GrayImage, Luma, imageops::grayscale};
use imageproc::distance_transform::{Norm, euclidean_squared_distance_transform};
use imageproc::gradients::sobel_gradients;
use imageproc::morphology::{close, open};
use imageproc::region_labelling::{Connectivity, connected_components};
use sinew_core::vision::skin::GaussianSkin;
use std::hint::black_box;

/// What the chain keeps from frame to frame.
pub struct ImageprocChain {
    skin: GaussianSkin,
    previous: GrayImage,
}

impl ImageprocChain {
    /// The chain after the earlier frame.
    pub fn new(pair: &FramePair) -> Self {
        Self { skin: skin(), previous: grayscale(&pair.before) }
    }

    /// Analyses the later frame.
    pub fn whole(&mut self, pair: &FramePair) {
        black_box(self.steps(pair));
    }

    /// Seconds for segmentation, morphology, components with distances, edges, and for all of it.
    pub fn steps(&mut self, pair: &FramePair) -> [f64; 5] {
        let mut mask = GrayImage::new(0, 0);
        let segmentation = timed(|| mask = self.segment(pair));
        let morphology = timed(|| mask = close(&open(&mask, Norm::LInf, 1), Norm::LInf, 1));
        let components = timed(|| {
            let labels = connected_components(&mask, Connectivity::Eight, Luma([0]));
            let background =
                GrayImage::from_fn(mask.width(), mask.height(), |x, y| Luma([255 - mask.get_pixel(x, y)[0]]));
            (labels, euclidean_squared_distance_transform(&background))
        });
        let edges = timed(|| self.edges(pair));
        [segmentation, morphology, components, edges, segmentation + morphology + components + edges]
    }

    /// The Mahalanobis distance of each pixel's chromaticity, as written in the arm paper.
    fn segment(&self, pair: &FramePair) -> GrayImage {
        let [rr, rg, gg] = self.skin.covariance();
        let determinant = rr * gg - rg * rg;
        let (mean_r, mean_g) = (self.skin.mean_r(), self.skin.mean_g());
        GrayImage::from_fn(pair.now.width(), pair.now.height(), |x, y| {
            let [r, g, b] = pair.now.get_pixel(x, y).0.map(f32::from);
            let sum = r + g + b;
            if sum < f32::from(self.skin.min_sum()) {
                return Luma([0]);
            }
            let (r, g) = (r / sum - mean_r, g / sum - mean_g);
            let distance = ((gg * r * r - 2.0 * rg * r * g + rr * g * g) / determinant).sqrt();
            Luma([if distance <= self.skin.threshold() { 255 } else { 0 }])
        })
    }

    /// Pixels whose Sobel gradient and change are above the default thresholds.
    fn edges(&self, pair: &FramePair) -> Vec<(u32, u32)> {
        let luminance = grayscale(&pair.now);
        let gradients = sobel_gradients(&luminance);
        let pixels = gradients.enumerate_pixels().zip(luminance.pixels()).zip(self.previous.pixels());
        pixels
            .filter(|(((_, _, gradient), now), before)| gradient[0] >= 64 && now[0].abs_diff(before[0]) >= 12)
            .map(|(((x, y, _), _), _)| (x, y))
            .collect()
    }
}
