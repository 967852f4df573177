//! Both hands of a person as firmware finds them: the camera's lines, without a picture in memory.

use super::PersonView;
use super::faces::FaceLooks;
use crate::camera_lines::{block_of, lines, of_blocks};
use crate::error::Result;
use crate::frames::FrameView;
use crate::pixels::{Picture, Pixels};
use crate::resume::{from_text, to_text};
use image::RgbImage;
use sinew_core::camera::Camera;
use sinew_core::math::Vec3;
use sinew_core::saved_state::{SavedState, StateKind, StateVisitor};
use sinew_core::vision::front_end::PersonLines;
use sinew_core::vision::front_end::pixel_format::Rgb565;
use sinew_core::vision::objects::head::HeadBox;
use sinew_core::vision::skin::SkinClassifier;

/// Firmware's chain for pictures of any size.
#[derive(Debug)]
pub struct LinesFinder {
    lines: Box<PersonLines<Rgb565>>,
    /// None of a run that looks for no face.
    faces: Option<FaceLooks>,
    block: u32,
    /// The camera of the pixels that are blocks.
    camera: Camera,
    /// What the camera saw last, if the next frame is compared with it.
    last: Option<RgbImage>,
}

impl LinesFinder {
    /// A finder for pictures of a size that `camera` took, in which anyone's skin has the colours
    /// of `skin` until a face is known.
    ///
    /// # Errors
    /// A picture without a pixel.
    pub fn new(
        size_px: (u32, u32),
        camera: Camera,
        skin: &impl SkinClassifier,
        faces: Option<FaceLooks>,
    ) -> Result<Self> {
        let block = block_of(size_px);
        let mut lines = Box::new(PersonLines::empty());
        lines.begin(((size_px.0 / block) as usize, (size_px.1 / block) as usize), skin)?;
        Ok(Self { lines, faces, block, camera: camera.of_blocks(block), last: None })
    }

    /// The picture that the camera sees.
    #[must_use]
    pub fn seen(&self, image: &Picture<impl Pixels>) -> RgbImage {
        of_blocks(image, self.block)
    }

    /// Answers a frame, whose face is at `head` if that is given. Pixels of the answer are those
    /// that the camera sees.
    pub fn see(
        &mut self,
        frame: usize,
        image: &Picture<impl Pixels>,
        head: Option<HeadBox>,
    ) -> (FrameView, Option<PersonView>) {
        let image = self.seen(image);
        let face = self.faces.as_mut().and_then(|faces| faces.look(frame, &image, head));
        face.into_iter().for_each(|face| self.lines.add_face(face.head));
        let answer = self.read(&image);
        self.last = Some(image);
        answer
    }

    /// What the camera saw last; none if the next frame is not compared with it.
    #[must_use]
    pub fn last(&self) -> Option<&RgbImage> {
        self.last.as_ref()
    }

    fn read(&mut self, image: &RgbImage) -> (FrameView, Option<PersonView>) {
        self.lines.begin_frame();
        for (v, line) in lines(image).enumerate() {
            self.lines.line(v, &line.collect::<Vec<u16>>());
        }
        let Some(frame) = self.lines.end_frame() else { return (FrameView::default(), None) };
        let losses = frame.lines.losses;
        let view = FrameView {
            line_blobs: frame.lines.blobs.to_vec(),
            candidates: frame.lines.candidates.to_vec(),
            edges: frame.lines.edges.to_vec(),
            dropped_blobs: losses.dropped_blobs + losses.dropped_components,
            ..FrameView::default()
        };
        let person = frame.person.map(|person| PersonView {
            shoulders_m: person.head.shoulders_m(&self.camera),
            hands: person.hands.each_ref().map(|hand| hand.to_vec()),
        });
        (view, person)
    }

    /// Forgets the last frame: the next one has no temporal edges, as after a missing image.
    pub fn forget_last_frame(&mut self) {
        self.lines.forget_last_frame();
        self.last = None;
    }

    /// The state after the last frame as text, which [`LinesFinder::restore`] takes. Waits for a
    /// look.
    ///
    /// # Errors
    /// None that a user can bring about.
    pub fn saved(&mut self) -> Result<String> {
        to_text(StateKind::Hands, self)
    }

    /// Goes on from a state that was saved with the same size and rate; `last` is what the camera
    /// [saw](Self::seen) before.
    ///
    /// # Errors
    /// The state is not whole, or of another run.
    pub fn restore(&mut self, last: Option<RgbImage>, saved: &str) -> Result<()> {
        // The edges of the last frame are in no state.
        last.iter().for_each(|image| drop(self.read(image)));
        self.last = last;
        from_text(StateKind::Hands, saved, self)
    }

    /// Left and right shoulder, by the face, metres in camera axes; none while no person is known.
    #[must_use]
    pub fn shoulders_m(&self) -> Option<[Vec3; 2]> {
        Some(self.lines.head().filter(|_| self.lines.knows_person())?.shoulders_m(&self.camera))
    }
}

impl SavedState for LinesFinder {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        self.lines.visit(visitor);
        if let Some(faces) = &mut self.faces {
            faces.visit(visitor);
        }
    }
}
