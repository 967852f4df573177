//! Options that choose a skin model, shared by all subcommands that need one.

use crate::skin::model::DEFAULT_SKIN;
use crate::skin::{Rectangle, SkinModel};
use anyhow::Result;
use clap::Args;
use image::RgbImage;

/// Which skin model is used, and whether it is adapted to the scene.
#[derive(Debug, Clone, Args)]
pub struct SkinArgs {
    /// Skin model: gaussian or histogram (shipped), or a FILE made by `sinew train skin`.
    #[arg(long, value_name = "gaussian|histogram|FILE", default_value = DEFAULT_SKIN)]
    pub skin: String,
    /// Adapt the model to the scene: a rectangle of the first image that shows only skin, pixels.
    #[arg(long, value_name = "X,Y,W,H", allow_hyphen_values = true)]
    pub calibrate: Option<Rectangle>,
}

impl SkinArgs {
    /// The chosen model as it was trained.
    ///
    /// # Errors
    /// As [`SkinModel::from_option`].
    pub fn load(&self) -> Result<SkinModel> {
        Ok(SkinModel::from_option(&self.skin)?)
    }

    /// `model` adapted to the first image, if that was asked for.
    ///
    /// # Errors
    /// As [`SkinModel::calibrated`].
    pub fn calibrated(&self, model: SkinModel, first: &RgbImage) -> Result<SkinModel> {
        match self.calibrate {
            Some(rectangle) => Ok(model.calibrated(first, rectangle)?),
            None => Ok(model),
        }
    }
}
