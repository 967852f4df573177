//! Images one after the other, each taken alone: what `segment` and `blobs` share.

use super::console::Console;
use super::skin_args::SkinArgs;
use crate::images::load_rgb;
use crate::skin::SkinModel;
use anyhow::{Result, bail};
use image::RgbImage;
use std::path::PathBuf;

/// The images that could not be read so far.
#[derive(Debug)]
pub struct Skipped {
    strict: bool,
    console: Console,
    reasons: Vec<String>,
}

impl Skipped {
    /// None so far; `strict` makes the first one an error.
    #[must_use]
    pub fn new(strict: bool, console: Console) -> Self {
        Self { strict, console, reasons: Vec::new() }
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

    fn add(&mut self, reason: String) -> Result<()> {
        if self.strict {
            bail!("{reason}; --strict was given");
        }
        self.console.note(format!("skipped: {reason}"));
        self.reasons.push(reason);
        Ok(())
    }
}

/// Calls `take` with the model, the index and the image of each file that can be read.
///
/// The model is calibrated on the first file, if that was asked for; the file then has to be readable.
///
/// # Errors
/// Whatever `take` refuses; an unreadable image if strict or if no image can be read; a bad calibration.
pub fn load_each(
    files: &[PathBuf],
    skin: &SkinArgs,
    model: &mut SkinModel,
    skipped: &mut Skipped,
    mut take: impl FnMut(&SkinModel, usize, &RgbImage) -> Result<()>,
) -> Result<()> {
    for (index, file) in files.iter().enumerate() {
        let image = match load_rgb(file) {
            Ok(image) => image,
            Err(error) if files.len() == 1 => return Err(error.into()),
            Err(error) if index == 0 && skin.calibrate.is_some() => bail!("{error}; --calibrate needs the first image"),
            Err(error) => {
                skipped.add(error.to_string())?;
                continue;
            }
        };
        if let (0, Some(rectangle)) = (index, skin.calibrate) {
            *model = model.calibrated(&image, rectangle)?;
        }
        take(model, index, &image)?;
    }
    if skipped.count() == files.len() {
        bail!("none of the {} images can be read", files.len());
    }
    if skipped.count() > 0 {
        skipped.console.note(format!("{} of {} images were skipped", skipped.count(), files.len()));
    }
    Ok(())
}
