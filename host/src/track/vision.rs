//! What reads the pictures of a run: whole pictures on a computer, or lines as firmware does.

use super::last_picture::LastPicture;
use super::options::{FrontEnd, StreamOptions};
use crate::camera_lines::block_of;
use crate::error::{Error, Result};
use crate::frames::{FrameReader, FrameView};
use crate::person::{LinesFinder, PersonFinder, PersonView};
use crate::pixels::{Picture, Pixels};
use crate::skin::{Background, MovingSkin, SkinModel};
use image::RgbImage;
use serde::{Deserialize, Serialize};
use sinew_core::camera::Camera;
use sinew_core::math::Vec3;
use sinew_core::vision::objects::head::HeadBox;

/// Reads pictures, and finds the person in them.
#[derive(Debug)]
pub(super) enum RunVision {
    Pictures(Box<PictureVision>),
    Lines(Box<LinesFinder>),
}

#[derive(Debug)]
pub(super) struct PictureVision {
    reader: FrameReader,
    skin: SkinModel,
    /// Of a run that looks for a face.
    person: Option<PersonFinder>,
    /// Of a run that knows no face.
    background: Background,
    /// As `background`.
    moving: MovingSkin,
    width_px: u32,
}

/// The state of what reads pictures.
#[derive(Debug, Serialize, Deserialize)]
struct PictureState {
    person: Option<String>,
    background: String,
    moving: [u64; 6],
}

impl RunVision {
    /// For pictures of a size that `camera` took, and in whose light skin is as in `skin`.
    pub fn new(options: &StreamOptions, size_px: (u32, u32), camera: Camera, skin: &SkinModel) -> Result<Self> {
        let faces = options.face.looks(options.rate_hz, Self::block(options.front_end, size_px))?;
        Ok(match options.front_end {
            FrontEnd::Lines => Self::Lines(Box::new(LinesFinder::new(size_px, camera, skin, faces)?)),
            FrontEnd::Pictures => Self::Pictures(Box::new(PictureVision {
                reader: FrameReader::new(options.config.likelihood.build()?, options.config.edges.build()?)?,
                skin: skin.clone(),
                background: Background::new(options.rate_hz),
                moving: MovingSkin::new(options.rate_hz),
                width_px: size_px.0,
                person: faces.map(|faces| PersonFinder::new(size_px, camera, faces)),
            })),
        })
    }

    /// Side of the blocks that are its pixels.
    pub fn block(front_end: FrontEnd, size_px: (u32, u32)) -> u32 {
        if front_end == FrontEnd::Lines { block_of(size_px) } else { 1 }
    }

    /// What an image shows, by the person's own skin once a face is known, and the person, whose
    /// face is at `head` if that is given.
    pub fn see(
        &mut self,
        frame: usize,
        image: &Picture<impl Pixels>,
        head: Option<HeadBox>,
    ) -> Result<(FrameView, Option<PersonView>)> {
        match self {
            Self::Pictures(vision) => vision.see(frame, image, head),
            Self::Lines(finder) => Ok(finder.see(frame, image, head)),
        }
    }

    /// The picture that it sees.
    pub fn seen(&self, image: RgbImage) -> RgbImage {
        match self {
            Self::Pictures(_) => image,
            Self::Lines(finder) => finder.seen(&image),
        }
    }

    /// Forgets the last frame: the next one has no temporal edges, as after a missing image.
    pub fn forget_last_frame(&mut self) {
        match self {
            Self::Pictures(vision) => vision.reader.forget_last_frame(),
            Self::Lines(finder) => finder.forget_last_frame(),
        }
    }

    /// What the next frame is compared with.
    pub fn last(&mut self) -> Option<LastPicture> {
        match self {
            Self::Pictures(vision) => vision.reader.last_luminance().as_ref().map(LastPicture::grey),
            Self::Lines(finder) => finder.last().map(LastPicture::coloured),
        }
    }

    /// The state after the last frame as text, which [`RunVision::restore`] takes.
    pub fn saved(&mut self) -> Result<Option<String>> {
        match self {
            Self::Pictures(vision) => vision.saved().map(Some),
            Self::Lines(finder) => finder.saved().map(Some),
        }
    }

    /// Goes on from what was saved after a frame which it saw as `last`.
    pub fn restore(&mut self, last: Option<RgbImage>, saved: Option<&str>) -> Result<()> {
        match (self, saved) {
            (Self::Pictures(vision), Some(saved)) => vision.restore(last.as_ref(), saved),
            (Self::Lines(finder), Some(saved)) => finder.restore(last, saved),
            (_, None) => Err(Error::Invalid("the state of the front end is missing".to_owned())),
        }
    }

    /// Left and right shoulder, by the face, metres in camera axes; none while no person is known.
    pub fn shoulders_m(&self) -> Option<[Vec3; 2]> {
        match self {
            Self::Pictures(vision) => vision.person.as_ref()?.shoulders_m(),
            Self::Lines(finder) => finder.shoulders_m(),
        }
    }
}

impl PictureVision {
    fn see(
        &mut self,
        frame: usize,
        image: &Picture<impl Pixels>,
        head: Option<HeadBox>,
    ) -> Result<(FrameView, Option<PersonView>)> {
        if let Some(person) = &mut self.person {
            person.look(frame, image, head);
        }
        let view = match self.person.as_ref().and_then(PersonFinder::skin) {
            Some(skin) => {
                self.background.forget();
                self.moving.forget();
                self.reader.read(image, skin)?
            }
            None => {
                self.background.see(image, &self.skin);
                let own = self.moving.see(image, &self.background, &self.skin)?;
                self.reader.read(image, &self.background.without(&own))?
            }
        };
        let person = self.person.as_mut().and_then(|person| person.see(&mut self.reader));
        Ok((view, person))
    }

    fn saved(&mut self) -> Result<String> {
        let person = self.person.as_mut().map(PersonFinder::saved).transpose()?;
        let (background, moving) = (self.background.saved(), self.moving.saved());
        Ok(serde_json::to_string(&PictureState { person, background, moving })?)
    }

    fn restore(&mut self, last: Option<&RgbImage>, saved: &str) -> Result<()> {
        let state: PictureState = serde_json::from_str(saved)?;
        if let Some(last) = last {
            // The next frame has the edges that it would have had.
            self.reader.read(last, &self.skin)?;
        }
        self.background.restore(&state.background, self.width_px)?;
        self.moving.restore(state.moving);
        match (&mut self.person, &state.person) {
            (Some(person), Some(saved)) => person.restore(saved),
            _ => Ok(()),
        }
    }
}
