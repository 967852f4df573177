//! In the place of `pictures` where the feature `plots` is off: a run that is to be drawn is
//! refused.

use super::arms::{ArmSet, ArmView};
use super::source::FrameSource;
use crate::error::{Result, bail};
use crate::frames::FrameView;
use crate::output::OutputDir;
use image::RgbImage;

/// What one frame's overlay would show.
#[derive(Debug)]
#[expect(dead_code, reason = "nothing draws it")]
pub struct Shot {
    pub frame: usize,
    pub name: String,
    pub image: RgbImage,
    pub view: FrameView,
    pub arms: Vec<ArmView>,
}

/// There is none.
#[derive(Debug)]
pub enum Pictures {}

impl Pictures {
    pub(super) fn new(_: &FrameSource, _: OutputDir) -> Result<Self> {
        bail!("overlays are not part of this build; build the library with the feature `plots`")
    }

    pub fn draw(&mut self, _: &[Shot], _: &ArmSet) -> Result<()> {
        match *self {}
    }

    pub fn take_up(&mut self, _: impl Iterator<Item = (usize, String)>) -> Result<()> {
        match *self {}
    }

    pub fn contact_sheet(self) -> RgbImage {
        match self {}
    }
}
