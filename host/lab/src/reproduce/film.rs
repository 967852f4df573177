//! A filmed clip with reference boxes of hands, for the arm paper's figures.

use super::arm_figures::Panel;
use crate::hands::{ReferenceBox, load_frames, read_boxes};
use crate::observed::{Footage, FrontEnd, Reading};
use anyhow::{Context, Result, ensure};
use sinew::config::Config;
use sinew::frames::FrameView;
use sinew::skin::SkinModel;
use sinew::track::SideChoice;
use std::path::Path;

/// Frames in a second. Chosen: a webcam's; the clip does not say.
const RATE_HZ: f64 = 30.0;

/// A clip after the front end.
#[derive(Debug)]
pub struct Film {
    config: Config,
    size_px: (u32, u32),
    views: Vec<FrameView>,
    boxes: Vec<ReferenceBox>,
}

impl Film {
    /// Reads the pictures of `folder`, with blobs ranked as the paper prints it, and the boxes of
    /// `boxes`.
    ///
    /// # Errors
    /// Pictures or boxes that cannot be read, by name.
    pub fn read(folder: &Path, boxes: &Path, skin: &SkinModel) -> Result<Self> {
        let (frames, config) = (load_frames(folder)?, crate::experiments::printed_base());
        let frames: Option<Vec<_>> = frames.into_iter().collect();
        let frames = frames.with_context(|| format!("`{}` lacks pictures between others", folder.display()))?;
        let size_px = frames.first().map_or((0, 0), |first| first.dimensions());
        ensure!(!frames.is_empty(), "`{}` holds no picture; give a folder of a clip's frames", folder.display());
        let front_end = FrontEnd { config: &config, skin, reading: Reading::Alone };
        let views = front_end.views(frames.iter(), &config, (RATE_HZ as f32, size_px))?;
        Ok(Self { config, size_px, views, boxes: read_boxes(boxes)? })
    }

    /// What a tracker of the right arm needs.
    #[must_use]
    pub fn footage(&self) -> Footage<'_> {
        let Self { config, size_px, views, .. } = self;
        let frame_us = (1.0e6 / RATE_HZ) as u64;
        Footage { config, size_px: *size_px, side: SideChoice::Right, seed: 1, frame_us, views }
    }

    /// The last frame in which each hand has a box of its own; the last one where none has.
    #[must_use]
    pub fn last_with_both_hands(&self) -> usize {
        let boxes = |frame: usize| self.boxes.iter().filter(|b| b.frame == frame).count();
        (0..self.views.len()).rev().find(|&frame| boxes(frame) == 2).unwrap_or(self.views.len() - 1)
    }

    /// What is drawn of a frame: its blobs, and crosses at the boxes' centres.
    #[must_use]
    pub fn panel(&self, frame: usize) -> Panel<'_> {
        let hands_px = self.boxes.iter().filter(|b| b.frame == frame).map(ReferenceBox::centre).collect();
        Panel { size_px: self.size_px, view: &self.views[frame], hands_px }
    }
}
