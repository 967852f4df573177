//! The arms of a stream of images, step by step: what `track arm` does between reading an image and
//! writing a row, for any source of images.

use super::arms::{ArmSet, ArmView};
use super::options::{FrontEnd, StreamOptions, check_rate};
use super::vision::RunVision;
use crate::error::{Result, bail, ensure};
use crate::frames::FrameView;
use crate::person::{GivenHands, PersonView};
use crate::pixels::{Picture, Pixels};
use crate::skin::SkinModel;
use image::RgbImage;
use sinew_core::camera::Camera;
use sinew_core::vision::objects::head::HeadBox;

/// One frame of a stream.
#[derive(Debug)]
pub struct StreamFrame<'a, P: Pixels> {
    /// Its number, from 0 and rising; it says when a face is looked for.
    pub number: usize,
    /// When it was taken, microseconds from any beginning.
    pub timestamp_us: u64,
    /// What the camera saw; none where that is missing.
    pub image: Option<&'a Picture<P>>,
    /// Hands that take the place of what the image shows.
    pub hands: Option<GivenHands>,
    /// The person's face, in place of one that is looked for; taken with an image only.
    pub head: Option<HeadBox>,
}

/// What a frame gave.
#[derive(Debug, Clone)]
pub struct StreamAnswer {
    /// One view an arm, left first.
    pub arms: Vec<ArmView>,
    /// What the frame showed; none without image and hands.
    pub view: Option<FrameView>,
    /// Whether the person's face was known.
    pub knows_face: bool,
}

/// Arms that are tracked through a stream of images of one size.
///
/// ```
/// use image::RgbImage;
/// use sinew::skin::SkinModel;
/// use sinew::track::{ArmStream, StreamFrame, StreamOptions};
///
/// let mut stream = ArmStream::new(StreamOptions::default(), SkinModel::from_option("gaussian")?, (64, 48))?;
/// let image = RgbImage::new(64, 48);
/// let frame = StreamFrame { number: 0, timestamp_us: 0, image: Some(&image), hands: None, head: None };
/// assert_eq!(stream.step(frame)?.arms.len(), 1);
/// // It goes on from text, in another process too.
/// let saved = stream.saved()?;
/// let mut again = ArmStream::restored(StreamOptions::default(), (64, 48), &saved)?;
/// assert_eq!(again.state_crc32()?, stream.state_crc32()?);
/// # Ok::<(), sinew::Error>(())
/// ```
#[derive(Debug)]
pub struct ArmStream {
    pub(super) options: StreamOptions,
    pub(super) size_px: (u32, u32),
    camera: Camera,
    /// As it was given, from the first image on as it is calibrated.
    skin: SkinModel,
    /// From the first image on.
    pub(super) seeing: Option<Seeing>,
    pub(super) arms: ArmSet,
}

/// What reads the images, once there was one.
#[derive(Debug)]
pub(super) struct Seeing {
    pub vision: RunVision,
    /// Skin in the light of the first image, by which `vision` was made.
    pub skin: SkinModel,
}

impl ArmStream {
    /// Trackers before their first frame, for images of a size, width and height in pixels.
    ///
    /// # Errors
    /// Names the option that cannot be used.
    pub fn new(options: StreamOptions, skin: SkinModel, size_px: (u32, u32)) -> Result<Self> {
        check_rate(options.rate_hz)?;
        let camera = options.config.camera.build(size_px.0, size_px.1)?;
        let block = RunVision::block(options.front_end, size_px);
        let (seen_by, seen_px) = (camera.of_blocks(block), (size_px.0 / block, size_px.1 / block));
        let arms = ArmSet::of_camera(&options.config, (seen_by, seen_px), options.side, options.seed)?;
        Ok(Self { options, size_px, camera, skin, seeing: None, arms })
    }

    /// Takes the light of `first` for that of the stream; the first step with an image does so
    /// where this was not called.
    ///
    /// # Errors
    /// The rectangle of `calibrate` does not lie in the image, or shows no skin.
    pub fn begin(&mut self, first: &Picture<impl Pixels>) -> Result<()> {
        if let Some(rectangle) = self.options.calibrate {
            self.skin = self.skin.calibrated(first, rectangle)?;
        }
        let skin = self.skin.for_image(first)?.into_owned();
        self.see_by(skin)
    }

    /// Makes what reads the images.
    pub(super) fn see_by(&mut self, skin: SkinModel) -> Result<()> {
        let vision = RunVision::new(&self.options, self.size_px, self.camera, &skin)?;
        self.seeing = Some(Seeing { vision, skin });
        Ok(())
    }

    /// Answers a frame.
    ///
    /// # Errors
    /// An image of another size, or hands where lines are read.
    pub fn step(&mut self, frame: StreamFrame<'_, impl Pixels>) -> Result<StreamAnswer> {
        ensure!(
            frame.hands.is_none() || self.options.front_end != FrontEnd::Lines,
            "hands take the place of what is seen, and the front end `lines` is a way to see: leave one out"
        );
        let (view, person) = match self.see(frame.number, frame.image, frame.head)? {
            Some((view, person)) => (Some(view), person),
            None => (frame.hands.as_ref().map(|_| FrameView::default()), None),
        };
        let timestamp_us = frame.timestamp_us;
        let knows_face = person.is_some();
        let Some(mut view) = view else {
            return Ok(StreamAnswer { arms: self.arms.step(timestamp_us, None), view: None, knows_face });
        };
        if let Some(person) = &person {
            self.arms.place_shoulders(&person.shoulders_m);
        }
        if let Some(hands) = &frame.hands {
            view.blobs.clear();
            view.candidates = match hands {
                GivenHands::OfPerson(hands) => hands.clone(),
                GivenHands::OfSides(hands) => hands.concat(),
            };
        }
        // Hands that are given take the place of blobs, and of the person's.
        let arms = match (frame.hands, person) {
            (Some(GivenHands::OfPerson(hands)), _) => self.arms.step_hands(timestamp_us, &view.edges, &hands),
            (Some(GivenHands::OfSides(hands)), _) => self.arms.step_each(timestamp_us, &view.edges, &hands),
            (None, Some(person)) => self.arms.step_each(timestamp_us, &view.edges, &person.hands),
            (None, None) => self.arms.step(timestamp_us, Some(&view)),
        };
        Ok(StreamAnswer { arms, view: Some(view), knows_face })
    }

    /// What image `number` shows, and the person in it where a face is known: the part of a step
    /// that comes before the arms. None where the image is missing. `head` is the face, in place of
    /// one that is looked for.
    ///
    /// # Errors
    /// An image of another size, or without skin in the rectangle of `calibrate`.
    pub fn see(
        &mut self,
        number: usize,
        image: Option<&Picture<impl Pixels>>,
        head: Option<HeadBox>,
    ) -> Result<Option<(FrameView, Option<PersonView>)>> {
        let Some(image) = image else {
            self.seeing.iter_mut().for_each(|seeing| seeing.vision.forget_last_frame());
            return Ok(None);
        };
        self.vision(image)?.see(number, image, head).map(Some)
    }

    /// What reads the images, of which `image` is one.
    fn vision(&mut self, image: &Picture<impl Pixels>) -> Result<&mut RunVision> {
        let (width, height) = self.size_px;
        ensure!(
            image.dimensions() == self.size_px,
            "an image has {}x{} pixels, and those of this stream have {width}x{height}; give images of one size",
            image.width(),
            image.height()
        );
        if self.seeing.is_none() {
            self.begin(image)?;
        }
        match &mut self.seeing {
            Some(seeing) => Ok(&mut seeing.vision),
            None => bail!("the stream has no first image"),
        }
    }

    /// The picture that the front end sees.
    #[must_use]
    pub fn seen(&self, image: RgbImage) -> RgbImage {
        match &self.seeing {
            Some(seeing) => seeing.vision.seen(image),
            None => image,
        }
    }

    /// Width and height of the images, pixels.
    #[must_use]
    pub fn size_px(&self) -> (u32, u32) {
        self.size_px
    }

    /// The camera of whole images.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The skin model, calibrated from the first image on.
    #[must_use]
    pub fn skin(&self) -> &SkinModel {
        &self.skin
    }

    /// The trackers.
    #[must_use]
    pub fn arms(&self) -> &ArmSet {
        &self.arms
    }
}
