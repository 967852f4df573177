//! The frames of a run: one folder of images of one size, checked before anything is tracked.

use super::gaps::{FrameFile, with_gaps};
use crate::error::{Result, bail};
use crate::images::{ImageFileError, list_images, load_rgb, size_by_header};
use crate::reading_again::read_again;
use image::RgbImage;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// An image that is missing or could not be read; the frame has no measurement.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SkippedImage {
    /// Number of the frame, from 0.
    pub frame: usize,
    /// File name.
    pub file: String,
    /// Why.
    pub reason: String,
}

/// A folder of frames of one size, at least one of which can be read. A number that is missing
/// between those of two pictures is a frame whose picture cannot be read.
#[derive(Debug, Clone)]
pub struct FrameFolder {
    files: Vec<PathBuf>,
    /// Frames whose picture is missing.
    missing: BTreeSet<usize>,
    size_px: (u32, u32),
    first: (usize, RgbImage),
}

impl FrameFolder {
    /// Lists the images of `folder` and reads the size of each; `strict` decodes them all.
    ///
    /// # Errors
    /// The folder is missing or holds no image, no image can be read, or two differ in size (the
    /// first odd one is named). With `strict`, one is missing or cannot be read.
    pub fn open(folder: &Path, strict: bool) -> Result<Self> {
        let frames = with_gaps(list_images(folder)?);
        let is_missing = |frame: &usize| matches!(frames[*frame], FrameFile::Missing(_));
        let missing: BTreeSet<usize> = (0..frames.len()).filter(is_missing).collect();
        let files: Vec<PathBuf> = frames.iter().map(|frame| frame.path().to_path_buf()).collect();
        if let Some(first) = missing.first().filter(|_| strict) {
            bail!(
                "`{}` is missing; {} frame numbers have no picture, and --strict was given (without it they are frames \
                 without a measurement)",
                files[*first].display(),
                missing.len()
            );
        }
        let sizes: Vec<Option<(u32, u32)>> = files.par_iter().map(|file| size_by_header(file)).collect();
        check_sizes(&files, &sizes)?;
        if strict {
            let unreadable: Vec<ImageFileError> = files.par_iter().filter_map(|file| load_rgb(file).err()).collect();
            if let Some(first) = unreadable.first() {
                bail!(
                    "{first}; {} of {} images are unreadable, and --strict was given (without it they are skipped)",
                    unreadable.len(),
                    files.len()
                );
            }
        }
        let mut reason = None;
        for (index, file) in files.iter().enumerate().filter(|(index, _)| !missing.contains(index)) {
            match load_rgb(file) {
                Ok(image) => return Ok(Self { files, missing, size_px: image.dimensions(), first: (index, image) }),
                Err(error) => reason = reason.or(Some(error)),
            }
        }
        let reason = reason.map_or_else(String::new, |error| error.to_string());
        bail!(
            "no image in `{}` can be read; of the first one, {reason}; give a folder of intact images",
            folder.display()
        )
    }

    /// The files of all frames, in natural order; where a picture is missing, the name that it
    /// would have.
    #[must_use]
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// File name of one frame.
    #[must_use]
    pub fn name(&self, frame: usize) -> String {
        let name = self.files.get(frame).and_then(|file| file.file_name());
        name.unwrap_or_default().to_string_lossy().into_owned()
    }

    /// Whether the picture of one frame is missing between others.
    #[must_use]
    pub fn is_missing(&self, frame: usize) -> bool {
        self.missing.contains(&frame)
    }

    /// Width and height of every frame, pixels.
    #[must_use]
    pub fn size_px(&self) -> (u32, u32) {
        self.size_px
    }

    /// Number and picture of the first frame that can be read.
    #[must_use]
    pub fn first(&self) -> (usize, &RgbImage) {
        (self.first.0, &self.first.1)
    }

    /// Reads one frame, or says why it is no picture.
    ///
    /// # Errors
    /// The operating system refuses the file.
    pub fn load(&self, frame: usize) -> Result<Result<RgbImage, SkippedImage>> {
        let skipped = |reason: String| SkippedImage { frame, file: self.name(frame), reason };
        if self.is_missing(frame) {
            return Ok(Err(skipped("it is missing: names before and after it are there".to_owned())));
        }
        let image = match read_again(|| load_rgb(&self.files[frame]), ImageFileError::is_io)? {
            Ok(image) => image,
            Err(error) => return Ok(Err(skipped(error.reason))),
        };
        // Sizes were checked before the run; a file that was exchanged since then is not part of
        // it.
        if image.dimensions() != self.size_px {
            return Ok(Err(skipped("its size changed after the run began".to_owned())));
        }
        Ok(Ok(image))
    }
}

fn check_sizes(files: &[PathBuf], sizes: &[Option<(u32, u32)>]) -> Result<()> {
    let mut known = files.iter().zip(sizes).filter_map(|(file, size)| size.map(|size| (file, size)));
    let Some((first, size)) = known.next() else { return Ok(()) };
    if let Some((odd, other)) = known.find(|(_, other)| *other != size) {
        bail!(
            "`{}` has {}x{} pixels, but `{}` has {}x{}; all frames of a folder must have one size: take odd ones out",
            odd.display(),
            other.0,
            other.1,
            first.display(),
            size.0,
            size.1
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_picture_is_a_frame_without_one() {
        let folder = tempfile::tempdir().unwrap();
        for number in (0..6).chain(8..13) {
            RgbImage::new(4, 3).save(folder.path().join(format!("f_{number:02}.png"))).unwrap();
        }
        let frames = FrameFolder::open(folder.path(), false).unwrap();
        assert_eq!((frames.files().len(), frames.name(12).as_str()), (13, "f_12.png"));
        let skipped = frames.load(7).unwrap().unwrap_err();
        assert_eq!((skipped.frame, skipped.file.as_str()), (7, "f_07.png"));
        assert!(frames.load(8).unwrap().is_ok());
        let message = FrameFolder::open(folder.path(), true).unwrap_err().to_string();
        assert!(message.contains("f_06.png` is missing; 2 frame numbers have no picture"), "{message}");
    }
}
