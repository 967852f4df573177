//! Pictures as JPEG inside the page, of a size that is bounded for the whole page.

use crate::error::{Context, Result};
use crate::images::load_rgb;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::RgbImage;
use image::codecs::jpeg::JpegEncoder;
use image::imageops::FilterType;
use rayon::prelude::*;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Text that all pictures of a page may take together, bytes.
pub const PAGE_BYTES: usize = 19 << 20;
/// Largest width, pixels, and quality of JPEG, the finest first.
const RUNGS: [(u32, u8); 6] = [(960, 80), (800, 70), (640, 60), (480, 55), (400, 45), (320, 35)];
/// Pictures of which the size of all is guessed.
const SAMPLES: usize = 12;

/// The pictures of a page, block by block.
#[derive(Debug, Default)]
pub struct Pictures {
    blocks: Vec<Vec<Option<PathBuf>>>,
}

/// A block that is ready for the page: base64 of a JPEG for each place, or nothing.
#[derive(Debug, Serialize)]
#[serde(transparent)]
pub struct Block(pub Vec<Option<String>>);

/// All blocks with what had to be left out.
#[derive(Debug)]
pub struct Encoded {
    /// In the order in which they were added.
    pub blocks: Vec<Block>,
    /// Names of files that could not be read.
    pub unreadable: Vec<String>,
    /// Of so many pictures one is shown, that the page stays small; 1 if all are.
    pub every: usize,
}

impl Pictures {
    /// Adds a block with a picture, or none, in each place; gives its name.
    pub fn add(&mut self, paths: Vec<Option<PathBuf>>) -> String {
        self.blocks.push(paths);
        block_name(self.blocks.len() - 1)
    }

    /// Reads all pictures and makes them as fine as [`PAGE_BYTES`] allow.
    ///
    /// # Errors
    /// None in practice: a JPEG can always be made in memory.
    pub fn encode(&self) -> Result<Encoded> {
        self.encode_within(PAGE_BYTES)
    }

    fn encode_within(&self, bytes: usize) -> Result<Encoded> {
        let all: Vec<&PathBuf> = self.blocks.iter().flatten().flatten().collect();
        let (mut rung, mut every) = choose(&all, bytes)?;
        loop {
            let encoded = self.encode_by(RUNGS[rung], every)?;
            let taken: usize = encoded.blocks.iter().flat_map(|block| &block.0).flatten().map(String::len).sum();
            if taken <= bytes {
                return Ok(encoded);
            }
            // The sample was too kind.
            if rung + 1 < RUNGS.len() { rung += 1 } else { every += 1 }
        }
    }

    fn encode_by(&self, rung: (u32, u8), every: usize) -> Result<Encoded> {
        let mut encoded = Encoded { blocks: Vec::new(), unreadable: Vec::new(), every };
        for paths in &self.blocks {
            let wanted = |index: usize| index.is_multiple_of(every);
            let texts: Vec<Result<Option<String>, String>> = paths
                .par_iter()
                .enumerate()
                .map(|(index, path)| match path {
                    Some(path) if wanted(index) => match load_regular(path) {
                        Some(image) => jpeg(&image, rung).map(Some).map_err(|error| error.chain()),
                        None => Err(path.display().to_string()),
                    },
                    _ => Ok(None),
                })
                .collect();
            encoded.unreadable.extend(texts.iter().filter_map(|text| text.as_ref().err().cloned()));
            encoded.blocks.push(Block(texts.into_iter().map(|text| text.unwrap_or_default()).collect()));
        }
        Ok(encoded)
    }
}

/// Name of the `index`-th block in the page.
#[must_use]
pub fn block_name(index: usize) -> String {
    format!("pictures-{index}")
}

/// The finest rung by which all pictures fit, as far as a sample shows, and of how many pictures
/// one has to do.
fn choose(all: &[&PathBuf], bytes: usize) -> Result<(usize, usize)> {
    let step = all.len().div_ceil(SAMPLES).max(1);
    let sample: Vec<RgbImage> = all.iter().step_by(step).filter_map(|path| load_small(path)).collect();
    let mut mean = 0;
    for (rung, &by) in RUNGS.iter().enumerate() {
        let sizes =
            sample.par_iter().map(|image| jpeg(image, by).map(|text| text.len())).collect::<Result<Vec<_>>>()?;
        mean = sizes.iter().sum::<usize>() / sizes.len().max(1);
        if mean * all.len() <= bytes {
            return Ok((rung, 1));
        }
    }
    Ok((RUNGS.len() - 1, (mean * all.len()).div_ceil(bytes.max(1))))
}

/// The picture in a regular file; none where it cannot be read or a link leads away.
fn load_regular(path: &Path) -> Option<RgbImage> {
    let is_regular = std::fs::symlink_metadata(path).is_ok_and(|facts| facts.is_file());
    is_regular.then(|| load_rgb(path).ok())?
}

/// The picture, not wider than the finest rung: a sample of large ones would take gigabytes.
fn load_small(path: &Path) -> Option<RgbImage> {
    let image = load_regular(path)?;
    Some(scaled(&image, RUNGS[0].0).unwrap_or(image))
}

/// The picture at this width; `None` if it is no wider.
fn scaled(image: &RgbImage, width: u32) -> Option<RgbImage> {
    (image.width() > width).then(|| {
        let height = (u64::from(image.height()) * u64::from(width) / u64::from(image.width())).max(1) as u32;
        image::imageops::resize(image, width, height, FilterType::Triangle)
    })
}

fn jpeg(image: &RgbImage, (width, quality): (u32, u8)) -> Result<String> {
    let scaled = scaled(image, width);
    let mut bytes = Vec::new();
    let mut encoder = JpegEncoder::new_with_quality(&mut bytes, quality);
    encoder.encode_image(scaled.as_ref().unwrap_or(image)).context("a picture cannot be made a JPEG")?;
    Ok(STANDARD.encode(&bytes))
}

/// The overlay of an image: named by its stem, or by its whole name where two images have one stem.
#[must_use]
pub fn overlay_of(folder: &Path, image: &str) -> Option<PathBuf> {
    let stem = Path::new(image).file_stem()?.to_str()?;
    [format!("{image}.png"), format!("{stem}.png")].iter().map(|name| folder.join(name)).find(|path| path.is_file())
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;

    /// A picture that compresses badly.
    fn noisy(width: u32, seed: u32) -> RgbImage {
        let value =
            |x: u32, y: u32| (x.wrapping_mul(7919) ^ y.wrapping_mul(104_729) ^ seed).wrapping_mul(2_654_435_761);
        RgbImage::from_fn(width, 200, |x, y| Rgb(value(x, y).to_le_bytes()[..3].try_into().unwrap()))
    }

    #[test]
    fn pictures_fit_and_missing_ones_leave_their_place() {
        let folder = tempfile::tempdir().unwrap();
        let mut paths: Vec<Option<PathBuf>> = Vec::new();
        for index in 0..6 {
            let path = folder.path().join(format!("{index}.png"));
            noisy(700, index).save(&path).unwrap();
            paths.push(Some(path));
        }
        paths.push(None);
        let broken = folder.path().join("broken.png");
        std::fs::write(&broken, "no picture").unwrap();
        paths.push(Some(broken));
        let huge = folder.path().join("huge.png");
        image::GrayImage::new(crate::limits::MAX_SIDE_PX + 1, 2).save(&huge).unwrap();
        paths.push(Some(huge));
        let mut pictures = Pictures::default();
        assert_eq!(pictures.add(paths), "pictures-0");
        let width = |text: &str| image::load_from_memory(&STANDARD.decode(text).unwrap()).unwrap().width();

        let fine = pictures.encode().unwrap();
        assert_eq!((fine.every, fine.unreadable.len()), (1, 2));
        assert_eq!(
            fine.blocks[0].0.iter().map(Option::is_some).collect::<Vec<_>>(),
            [true, true, true, true, true, true, false, false, false]
        );
        assert_eq!(width(fine.blocks[0].0[0].as_ref().unwrap()), 700);

        let taken = |encoded: &Encoded| encoded.blocks[0].0.iter().flatten().map(String::len).sum::<usize>();
        let small = pictures.encode_within(taken(&fine) / 3).unwrap();
        assert!(taken(&small) <= taken(&fine) / 3 && width(small.blocks[0].0[0].as_ref().unwrap()) < 700);
        let few = pictures.encode_within(20_000).unwrap();
        assert!(taken(&few) <= 20_000 && few.every > 1 && few.blocks[0].0.len() == 9);
    }

    #[test]
    fn overlays_of_one_stem_are_distinguished() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["x.png.png", "x.jpg.png", "y.png"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let name = |image: &str| Some(overlay_of(folder.path(), image)?.file_name()?.to_str()?.to_owned());
        assert_eq!(name("x.jpg").as_deref(), Some("x.jpg.png"));
        assert_eq!(name("y.JPG").as_deref(), Some("y.png"));
        assert_eq!(name("z.png"), None);
    }
}
