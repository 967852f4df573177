//! Images one after the other, each taken alone: what `segment` and `blobs` share.

use super::console::Console;
use super::data_error;
use super::skin_args::SkinArgs;
use crate::error::Error;
use crate::images::{ImageFileError, ImageInput, VideoError, VideoFacts, VideoFrames, load_rgb};
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
    broken: Option<VideoError>,
}

impl Skipped {
    /// None so far; `strict` makes the first one an error.
    #[must_use]
    pub fn new(strict: bool, console: Console) -> Self {
        Self { strict, console, reasons: Vec::new(), broken: None }
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

    /// After what was read is written: why a video ended before its end.
    ///
    /// # Errors
    /// It did.
    pub fn whole(self) -> Result<()> {
        let kept = "what came before is written".to_owned();
        self.broken.map_or(Ok(()), |broken| Err(Error::Unfinished { error: Box::new(broken.into()), kept }.into()))
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
/// Whatever `take` refuses; an image that is none if strict or if all are; a file that the
/// operating system refuses; a bad calibration; no ffmpeg for a video.
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
                skipped.broken = Some(broken);
                break;
            }
        };
        if let (0, Some(rectangle)) = (index, skin.calibrate) {
            *model = model.calibrated(&image, rectangle)?;
        }
        take(model, index, &image)?;
    }
    bar.finish_and_clear();
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
    for (index, file) in files.iter().enumerate() {
        bar.set_position(index as u64);
        let image = match read_again(|| load_rgb(file), ImageFileError::is_io)? {
            Ok(image) => image,
            Err(error) if files.len() == 1 => return Err(error.into()),
            Err(error) if index == 0 && skin.calibrate.is_some() => {
                return Err(data_error(format!("{error}; --calibrate needs the first image")));
            }
            Err(error) => {
                bar.suspend(|| skipped.add(error.to_string()))?;
                continue;
            }
        };
        if let (0, Some(rectangle)) = (index, skin.calibrate) {
            *model = model.calibrated(&image, rectangle)?;
        }
        take(model, index, &image)?;
    }
    bar.finish_and_clear();
    if skipped.count() == files.len() {
        return Err(data_error(format!("none of the {} images can be read", files.len())));
    }
    if skipped.count() > 0 {
        skipped.console.note(format!("{} of {} images were skipped", skipped.count(), files.len()));
    }
    Ok(())
}
