//! Pairs of an image and its skin mask, found by name.

use super::bit_image::BitImage;
use crate::error::{Context, Result, bail};
use crate::images::{ImageFileError, list_images, load_rgb};
use image::{DynamicImage, RgbImage};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A mask pixel is skin where it is brighter than this.
pub const MASK_THRESHOLD: u8 = 127;

/// An image file and the file of its mask.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pair {
    /// The image.
    pub image: PathBuf,
    /// Its mask.
    pub mask: PathBuf,
    /// Number of the folder pair it comes from.
    pub group: usize,
}

/// The pairs of one or more folders.
#[derive(Debug, Clone, Default)]
pub struct PairList {
    /// Images that have a mask, in the folders' order, then in natural order.
    pub pairs: Vec<Pair>,
    /// Images without a mask.
    pub without_mask: Vec<PathBuf>,
    /// A name for each folder pair: the last two parts of the image folder's path.
    pub groups: Vec<String>,
}

/// Pairs the images of each folder with the masks of the folder at the same place in `masks`.
///
/// The mask of `NAME.*` is `NAME.*`, or `NAME_skin_NAME.*` as in the ECU set.
///
/// # Errors
/// The lists differ in length, a folder cannot be used, or a folder pair has no image with a mask.
pub fn find(images: &[PathBuf], masks: &[PathBuf]) -> Result<PairList> {
    if images.len() != masks.len() {
        bail!(
            "--images was given {} times and --masks {} times; give one mask folder for each image folder, in the same order",
            images.len(),
            masks.len()
        );
    }
    let mut list = PairList::default();
    for (group, (image_folder, mask_folder)) in images.iter().zip(masks).enumerate() {
        let by_stem: BTreeMap<String, PathBuf> =
            list_images(mask_folder)?.into_iter().map(|path| (stem(&path), path)).collect();
        let before = list.pairs.len();
        for image in list_images(image_folder)? {
            let name = stem(&image);
            match by_stem.get(&name).or_else(|| by_stem.get(&format!("{name}_skin_{name}"))) {
                Some(mask) => list.pairs.push(Pair { image, mask: mask.clone(), group }),
                None => list.without_mask.push(image),
            }
        }
        if list.pairs.len() == before {
            bail!(
                "no image of `{}` has a mask in `{}`; a mask is named like its image, or NAME_skin_NAME",
                image_folder.display(),
                mask_folder.display()
            );
        }
        list.groups.push(short_name(image_folder));
    }
    Ok(list)
}

impl Pair {
    /// Reads both files; the inner error is that of the file that cannot be read.
    ///
    /// # Errors
    /// Names both files if their sizes differ.
    pub fn load(&self) -> Result<Result<(RgbImage, BitImage), ImageFileError>> {
        let (image, mask) = match (load_rgb(&self.image), load_rgb(&self.mask)) {
            (Ok(image), Ok(mask)) => (image, DynamicImage::ImageRgb8(mask).into_luma8()),
            (Err(unreadable), _) | (_, Err(unreadable)) => return Ok(Err(unreadable)),
        };
        if image.dimensions() != mask.dimensions() {
            bail!(
                "`{}` has {}x{} pixels, but its mask `{}` has {}x{}; a mask needs the size of its image",
                self.image.display(),
                image.width(),
                image.height(),
                self.mask.display(),
                mask.width(),
                mask.height()
            );
        }
        let bits = BitImage::from_gray(&mask, MASK_THRESHOLD).with_context(|| self.mask.display().to_string())?;
        Ok(Ok((image, bits)))
    }
}

/// The last two parts of a path, which say where data come from without naming a machine's folders.
#[must_use]
pub fn short_name(path: &Path) -> String {
    let parts: Vec<_> = path.iter().map(|part| part.to_string_lossy().into_owned()).collect();
    parts[parts.len().saturating_sub(2)..].join("/")
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{GrayImage, Luma};
    use std::fs;

    #[test]
    fn masks_are_found_by_either_name_and_missing_ones_are_listed() {
        let root = tempfile::tempdir().unwrap();
        let (images, masks) = (root.path().join("images"), root.path().join("masks"));
        for name in ["images/3.jpeg", "images/b.png", "images/c.png", "masks/3_skin_3.png", "masks/b.png"] {
            let path = root.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, b"").unwrap();
        }
        let list = find(std::slice::from_ref(&images), std::slice::from_ref(&masks)).unwrap();
        assert_eq!(list.pairs.len(), 2);
        assert!(list.pairs[0].mask.ends_with("3_skin_3.png") && list.pairs[1].mask.ends_with("b.png"));
        assert_eq!(list.without_mask, [images.join("c.png")]);
        assert!(find(&[images], &[]).unwrap_err().to_string().contains("1 times"));
    }

    #[test]
    fn a_mask_of_another_size_is_refused_with_both_names() {
        let root = tempfile::tempdir().unwrap();
        let (image, mask) = (root.path().join("a.png"), root.path().join("m.png"));
        RgbImage::new(4, 4).save(&image).unwrap();
        GrayImage::from_pixel(4, 5, Luma([255])).save(&mask).unwrap();
        let message = Pair { image, mask, group: 0 }.load().unwrap_err().to_string();
        assert!(message.contains("a.png") && message.contains("m.png") && message.contains("4x5"), "{message}");
    }
}
