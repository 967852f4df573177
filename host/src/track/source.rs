//! Where the frames of a run come from: a folder of images, or a video.

use super::input::{FrameFolder, SkippedImage};
use crate::error::{Result, ensure};
use crate::images::video::frame_name;
use crate::images::{VideoError, VideoFrames, is_video};
use crate::reading_again::until_failure;
use crate::registry::{Kind, extensions};
use crate::resume::identity;
use image::RgbImage;
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// Frames of one size, the first of which can be read.
#[derive(Debug)]
pub enum FrameSource {
    /// A folder of images.
    Folder(FrameFolder),
    /// A video, whose frames come one after the other.
    Video(Box<VideoSource>),
}

/// A video that is being read.
#[derive(Debug)]
pub struct VideoSource {
    frames: VideoFrames,
    first: RgbImage,
    /// Number of the next frame.
    next: usize,
    /// What ended the video, until it is reported.
    end: Option<VideoError>,
}

impl FrameSource {
    /// Opens a folder or a video, of which `rate_hz` frames per second are taken.
    ///
    /// # Errors
    /// As [`FrameFolder::open`] and [`VideoFrames::open`].
    pub fn open(path: &Path, strict: bool, rate_hz: f64) -> Result<Self> {
        ensure!(
            is_video(path) || !path.is_file(),
            "`{}` is not a folder; give the folder that holds the images, or a video ({})",
            path.display(),
            extensions(&[Kind::Video])
        );
        if !is_video(path) {
            return Ok(Self::Folder(FrameFolder::open(path, strict)?));
        }
        let frames = VideoFrames::open(path, rate_hz)?;
        let first = frames.first().cloned().unwrap_or_default();
        Ok(Self::Video(Box::new(VideoSource { frames, first, next: 0, end: None })))
    }

    /// Number of frames: of a folder what it holds, of a video what it says.
    #[must_use]
    pub fn count(&self) -> usize {
        match self {
            Self::Folder(folder) => folder.files().len(),
            Self::Video(video) => video.frames.expected(),
        }
    }

    /// Number of frames where it is certain: a video may have fewer or more than it says.
    #[must_use]
    pub fn certain_count(&self) -> Option<usize> {
        match self {
            Self::Folder(_) => Some(self.count()),
            Self::Video(_) => None,
        }
    }

    /// The files of a folder; none of a video.
    #[must_use]
    pub fn files(&self) -> &[PathBuf] {
        match self {
            Self::Folder(folder) => folder.files(),
            Self::Video(_) => &[],
        }
    }

    /// What distinguishes these frames from others, beside the path: name, size and time of each
    /// file of a folder, or of the video.
    #[must_use]
    pub fn identity(&self) -> Vec<String> {
        match self {
            Self::Folder(folder) => folder.files().iter().map(|file| identity(file)).collect(),
            Self::Video(video) => vec![identity(video.frames.file())],
        }
    }

    /// Name of one frame.
    #[must_use]
    pub fn name(&self, frame: usize) -> String {
        match self {
            Self::Folder(folder) => folder.name(frame),
            Self::Video(video) => frame_name(video.frames.file(), frame),
        }
    }

    /// Width and height of every frame, pixels.
    #[must_use]
    pub fn size_px(&self) -> (u32, u32) {
        match self {
            Self::Folder(folder) => folder.size_px(),
            Self::Video(video) => video.first.dimensions(),
        }
    }

    /// Number and picture of the first frame that can be read.
    #[must_use]
    pub fn first(&self) -> (usize, &RgbImage) {
        match self {
            Self::Folder(folder) => folder.first(),
            Self::Video(video) => (0, &video.first),
        }
    }

    /// Reads the frames from `begin` on, `most` of them, decoded in parallel where that can be
    /// done. None is the end.
    ///
    /// # Errors
    /// A video that is broken, or a file that the operating system refuses, once all frames before
    /// it were given. Also a frame of a video that was passed already.
    pub fn load(&mut self, begin: usize, most: usize) -> Result<Vec<Result<RgbImage, SkippedImage>>> {
        match self {
            Self::Folder(folder) => {
                let end = folder.files().len().min(begin + most);
                until_failure((begin..end).into_par_iter().map(|frame| folder.load(frame)).collect())
            }
            Self::Video(video) => {
                ensure!(begin >= video.next, "a video is read forwards; frame {begin} was passed");
                while video.next < begin && video.step().is_some() {}
                let frames: Vec<_> = std::iter::from_fn(|| video.step().map(Ok)).take(most).collect();
                match video.end.take() {
                    Some(end) if frames.is_empty() => Err(end.into()),
                    end => {
                        video.end = end;
                        Ok(frames)
                    }
                }
            }
        }
    }
}

impl VideoSource {
    fn step(&mut self) -> Option<RgbImage> {
        if self.end.is_some() {
            return None;
        }
        match self.frames.next_frame() {
            Ok(image) => {
                self.next += usize::from(image.is_some());
                image
            }
            Err(error) => {
                self.end = Some(error);
                None
            }
        }
    }
}
