//! Images one after the other, each taken alone: what `segment` and `blobs` share.

use super::console::Console;
use super::data_error;
use super::skin_args::SkinArgs;
use crate::error::Error;
use crate::images::{ImageFileError, ImageInput, VideoFacts, VideoFrames, load_rgb};
use crate::pixels::{GREY, is_grey};
use crate::reading_again::read_again;
use crate::skin::SkinModel;
use anyhow::Result;
use image::RgbImage;
use std::path::{Path, PathBuf};

/// What the progress bar shows.
const BAR: &str = "{wide_bar} image {pos} of {len}, {per_sec}";

/// What could not be read so far.
#[derive(Debug)]
pub struct Skipped {
    strict: bool,
    console: Console,
    reasons: Vec<String>,
    /// The first failure after which what was read is still written.
    failure: Option<Error>,
    /// Pictures that were read, and those without colours among them.
    read: usize,
    grey: usize,
}

impl Skipped {
    /// None so far; `strict` makes the first one an error.
    #[must_use]
    pub fn new(strict: bool, console: Console) -> Self {
        Self { strict, console, reasons: Vec::new(), failure: None, read: 0, grey: 0 }
    }

    /// How many.
    #[must_use]
    pub fn count(&self) -> usize {
        self.reasons.len()
    }

    /// Why, one sentence each.
    #[must_use]
    pub fn reasons(&self) -> &[String] {
        &self.reasons
    }

    /// After what was read is written: why a video ended before its end, or which file the
    /// operating system refused.
    ///
    /// # Errors
    /// It did.
    pub fn whole(self) -> Result<()> {
        let kept = "what could be read is written".to_owned();
        self.failure.map_or(Ok(()), |failure| Err(Error::Unfinished { error: Box::new(failure), kept }.into()))
    }

    /// Counts a picture that was read.
    fn count_read(&mut self, image: &RgbImage) {
        self.read += 1;
        self.grey += usize::from(is_grey(image));
    }

    /// Says so if pictures have no colours.
    fn tell_of_grey(&self) {
        if self.grey > 0 {
            self.console.note(format!("{} of {} pictures are grey; {GREY}", self.grey, self.read));
        }
    }

    fn add(&mut self, reason: String) -> Result<()> {
        if self.strict {
            return Err(data_error(format!("{reason}; --strict was given")));
        }
        self.console.note(format!("skipped: {reason}"));
        self.reasons.push(reason);
        Ok(())
    }
}

/// Calls `take` with the model, the index and the image of each file, or frame of a video, that can
/// be read.
///
/// The model is calibrated on the first one, if that was asked for; it then has to be readable.
///
/// # Errors
/// Whatever `take` refuses; an image that cannot be read if strict, or if all cannot; a bad
/// calibration; no ffmpeg for a video.
pub fn load_each(
    input: &ImageInput,
    skin: &SkinArgs,
    model: &mut SkinModel,
    skipped: &mut Skipped,
    mut take: impl FnMut(&SkinModel, usize, &RgbImage) -> Result<()>,
) -> Result<()> {
    match input {
        ImageInput::Files(files) => load_files(files, skin, model, skipped, &mut take),
        ImageInput::Video(file) => load_video(file, skin, model, skipped, &mut take),
    }
}

/// What is done with each image.
type Take<'a> = &'a mut dyn FnMut(&SkinModel, usize, &RgbImage) -> Result<()>;

fn load_video(
    file: &Path,
    skin: &SkinArgs,
    model: &mut SkinModel,
    skipped: &mut Skipped,
    take: Take<'_>,
) -> Result<()> {
    let mut frames = VideoFrames::open(file, VideoFacts::read(file)?.rate_hz)?;
    let bar = skipped.console.bar(frames.expected() as u64, BAR)?;
    for index in 0.. {
        bar.set_position(index as u64);
        let image = match frames.next_frame() {
            Ok(Some(image)) => image,
            Ok(None) => break,
            Err(broken) => {
                skipped.failure = Some(broken.into());
                break;
            }
        };
        if let (0, Some(rectangle)) = (index, skin.calibrate) {
            *model = model.calibrated(&image, rectangle)?;
        }
        skipped.count_read(&image);
        take(model, index, &image)?;
    }
    bar.finish_and_clear();
    skipped.tell_of_grey();
    Ok(())
}

fn load_files(
    files: &[PathBuf],
    skin: &SkinArgs,
    model: &mut SkinModel,
    skipped: &mut Skipped,
    take: Take<'_>,
) -> Result<()> {
    let bar = skipped.console.bar(files.len() as u64, BAR)?;
    let mut was_refused = false;
    for (index, file) in files.iter().enumerate() {
        bar.set_position(index as u64);
        let loaded = load(file, was_refused);
        was_refused = loaded.is_err();
        let image = match loaded {
            Ok(Ok(image)) => image,
            Ok(Err(error)) if files.len() == 1 => return Err(error.into()),
            Ok(Err(error)) if index == 0 && skin.calibrate.is_some() => {
                return Err(data_error(format!("{error}; --calibrate needs the first image")));
            }
            Ok(Err(error)) => {
                bar.suspend(|| skipped.add(error.to_string()))?;
                continue;
            }
            Err(refusal) if files.len() == 1 || skipped.strict || (index == 0 && skin.calibrate.is_some()) => {
                return Err(refusal.into());
            }
            Err(refusal) => {
                bar.suspend(|| skipped.add(refusal.to_string()))?;
                skipped.failure.get_or_insert(refusal);
                continue;
            }
        };
        if let (0, Some(rectangle)) = (index, skin.calibrate) {
            *model = model.calibrated(&image, rectangle)?;
        }
        skipped.count_read(&image);
        take(model, index, &image)?;
    }
    bar.finish_and_clear();
    if skipped.count() == files.len() {
        let none = || data_error(format!("none of the {} images can be read", files.len()));
        return Err(skipped.failure.take().map_or_else(none, Into::into));
    }
    skipped.tell_of_grey();
    if skipped.count() > 0 {
        skipped.console.note(format!("{} of {} images were skipped", skipped.count(), files.len()));
    }
    Ok(())
}

/// Reads a file, again for a second where the operating system refuses it, unless the file before
/// `was_refused`, too: a folder that is gone does not take a second for each of its files.
fn load(file: &Path, was_refused: bool) -> Result<Result<RgbImage, ImageFileError>, Error> {
    match read_again(|| load_rgb(file), |error| !was_refused && error.is_io())? {
        Err(error) if error.is_io() => Err(Error::Unreadable(error.to_string())),
        loaded => Ok(loaded),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_after_a_refused_one_is_tried_once() {
        let folder = tempfile::tempdir().unwrap();
        let gone = folder.path().join("gone.png");
        let start = std::time::Instant::now();
        assert!(matches!(load(&gone, true), Err(Error::Unreadable(text)) if text.contains("gone.png")));
        assert!(start.elapsed().as_millis() < 500, "it was tried again");
        std::fs::write(&gone, "no picture").unwrap();
        assert!(load(&gone, true).unwrap().is_err(), "its content is none");
    }
}
