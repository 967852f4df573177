//! What skin models are trained from: units (images, or parts of a pixel list) of weighted colours.

use super::bit_image::BitImage;
use super::folds;
use super::labelled_pixels::LabelledPixels;
use image::RgbImage;
use sinew_core::random::Stream;

/// Pixels kept of one image: more do not change a colour model, but would fill the memory.
pub const SAMPLED_PIXELS_PER_IMAGE: usize = 40_000;

/// Units that a list of labelled pixels is dealt into.
pub const UNITS_OF_A_PIXEL_LIST: usize = 100;

/// A colour and how many pixels of it a unit holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeightedColour {
    /// Red, green, blue.
    pub rgb: [u8; 3],
    /// Whether these pixels are skin.
    pub is_skin: bool,
    /// Number of pixels, at least 1.
    pub count: u32,
}

/// What is never split between training and testing: one image, or one part of a pixel list.
#[derive(Debug, Clone, PartialEq)]
pub struct Unit {
    /// Number of the source it comes from.
    pub group: usize,
    /// Its colours, sorted, each once for each label.
    pub colours: Vec<WeightedColour>,
    /// Pixels that each counted pixel stands for: 1 where all pixels were kept.
    pub pixels_per_count: f64,
}

/// Where the units come from; it decides the rule by which a threshold is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// Selected, labelled pixels, without the places they come from.
    PixelList,
    /// Whole images with a mask.
    Images,
}

/// The units of all sources.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainingSet {
    /// Pixel list or images.
    pub source: Source,
    /// Names of the groups.
    pub groups: Vec<String>,
    /// The units.
    pub units: Vec<Unit>,
}

impl TrainingSet {
    /// Deals the different rows of a pixel list into units, in an order drawn from `seed`.
    #[must_use]
    pub fn from_pixels(name: String, pixels: &LabelledPixels, seed: u64) -> Self {
        let unit_of = folds::assign(pixels.unique.len(), UNITS_OF_A_PIXEL_LIST, seed);
        let mut units = vec![Unit { group: 0, colours: Vec::new(), pixels_per_count: 1.0 }; UNITS_OF_A_PIXEL_LIST];
        for (pixel, unit) in pixels.unique.iter().zip(unit_of) {
            units[unit].colours.push(WeightedColour { rgb: pixel.rgb, is_skin: pixel.is_skin, count: 1 });
        }
        units.retain(|unit| !unit.colours.is_empty());
        Self { source: Source::PixelList, groups: vec![name], units }
    }

    /// The set that holds only the units that `keep` says, by their index.
    #[must_use]
    pub fn subset(&self, keep: impl Fn(usize) -> bool) -> Self {
        let kept = self.units.iter().enumerate().filter(|(index, _)| keep(*index)).map(|(_, unit)| unit.clone());
        Self { source: self.source, groups: self.groups.clone(), units: kept.collect() }
    }

    /// Number of (sampled) pixels that are skin, and of those that are not.
    #[must_use]
    pub fn pixel_counts(&self) -> (u64, u64) {
        self.units.iter().flat_map(|unit| &unit.colours).fold((0, 0), |(skin, other), colour| {
            let count = u64::from(colour.count);
            if colour.is_skin { (skin + count, other) } else { (skin, other + count) }
        })
    }
}

impl Unit {
    /// Samples an image of the given `group`: one pixel of each of up to
    /// [`SAMPLED_PIXELS_PER_IMAGE`] equal stretches, chosen by `seed` and `index`.
    #[must_use]
    pub fn from_image(image: &RgbImage, mask: &BitImage, group: usize, seed: u64, index: u32) -> Self {
        let gray = mask.to_gray();
        let total = gray.len();
        let samples = total.min(SAMPLED_PIXELS_PER_IMAGE);
        let mut stream = Stream::new(seed, 1, index);
        let (pixels, labels) = (image.as_raw().as_chunks::<3>().0, gray.as_raw());
        let mut drawn: Vec<([u8; 3], bool)> = (0..samples)
            .map(|k| {
                let (from, to) = (k * total / samples, (k + 1) * total / samples);
                let at = from + stream.below(u32::try_from(to - from).unwrap_or(u32::MAX)) as usize;
                (pixels[at], labels[at] > 0)
            })
            .collect();
        drawn.sort_unstable();
        let colours = drawn
            .chunk_by(|a, b| a == b)
            .map(|same| WeightedColour { rgb: same[0].0, is_skin: same[0].1, count: same.len() as u32 })
            .collect();
        Self { group, colours, pixels_per_count: total as f64 / samples as f64 }
    }

    /// Number of counted pixels.
    #[must_use]
    pub fn counted_pixels(&self) -> f64 {
        self.colours.iter().map(|colour| f64::from(colour.count)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::super::labelled_pixels::LabelledPixel;
    use super::*;
    use image::{GrayImage, Luma, Rgb};

    #[test]
    fn an_image_is_sampled_evenly_and_from_the_seed() {
        let image = RgbImage::from_fn(400, 300, |u, v| Rgb([(u % 16) as u8, (v % 8) as u8, 0]));
        let mask = GrayImage::from_fn(400, 300, |u, _| Luma([if u < 100 { 255 } else { 0 }]));
        let mask = BitImage::from_gray(&mask, 127).unwrap();
        let unit = Unit::from_image(&image, &mask, 0, 3, 9);
        assert_eq!(unit, Unit::from_image(&image, &mask, 0, 3, 9));
        assert_eq!((unit.counted_pixels(), unit.pixels_per_count), (40_000.0, 3.0));
        let skin: u32 = unit.colours.iter().filter(|colour| colour.is_skin).map(|colour| colour.count).sum();
        assert!((9_900..=10_100).contains(&skin), "{skin}");
    }

    #[test]
    fn every_row_of_a_list_is_in_one_unit() {
        let unique: Vec<_> = (0..=255).map(|r| LabelledPixel { rgb: [r, 0, 0], is_skin: r < 50 }).collect();
        let set = TrainingSet::from_pixels("x".to_owned(), &LabelledPixels { unique, row_count: 256 }, 1);
        assert_eq!(set.units.len(), UNITS_OF_A_PIXEL_LIST);
        assert_eq!(set.pixel_counts(), (50, 206));
        assert_eq!(set.subset(|index| index < 30).units.len(), 30);
    }
}
