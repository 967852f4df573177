//! Where a run's faces come from: a detector beside the tracker, or a table.

use super::given::FaceTable;
use crate::error::Result;
use crate::pixels::{Picture, Pixels};
use crate::resume::optional;
use image::RgbImage;
use sinew_core::saved_state::{SavedState, StateVisitor};
use sinew_core::vision::objects::head::HeadBox;
use sinew_core::vision::objects::person_colour::PersonColour;
use sinew_face::{FaceDetector, FoundFace, LATENCY, is_time_to_look};
use std::thread::JoinHandle;

/// Most frames between two looks.
const MAX_INTERVAL: f64 = 600.0;

/// Looks for a face in the first frame and once a second, beside the tracker; until one was found
/// as often as answers come. What is found counts a fixed number of frames later, so that no result
/// depends on threads.
#[derive(Debug)]
pub struct FaceLooks {
    faces: Faces,
    interval: usize,
    /// Side of the blocks that are the pixels of the pictures that are shown; tables have those of
    /// whole pictures.
    block: u32,
    look: Option<Look>,
    /// Whether a face and its colour were found.
    is_known: bool,
}

#[derive(Debug)]
enum Faces {
    Detector(FaceDetector),
    Given(FaceTable),
}

/// A look for a face.
#[derive(Debug)]
struct Look {
    /// Frame from which its answer counts.
    due: usize,
    answer: Answer,
}

#[derive(Debug)]
enum Answer {
    Awaited(JoinHandle<Option<FoundFace>>),
    Known(Option<FoundFace>),
}

impl FaceLooks {
    /// Looks in pictures of so many a second whose pixels are means of blocks, or takes the faces
    /// that are `given`.
    ///
    /// # Errors
    /// None with the shipped model.
    pub fn new(rate_hz: f64, block: u32, given: Option<FaceTable>) -> Result<Self> {
        let faces = match given {
            Some(faces) => Faces::Given(faces),
            None => Faces::Detector(FaceDetector::new()?),
        };
        Ok(Self {
            faces,
            interval: rate_hz.round().clamp(1.0, MAX_INTERVAL) as usize,
            block,
            look: None,
            is_known: false,
        })
    }

    /// The face that counts from this frame on, if there is one, and begins the next look. A `head`
    /// is taken in place of whatever is found.
    pub fn look(&mut self, frame: usize, image: &Picture<impl Pixels>, head: Option<HeadBox>) -> Option<FoundFace> {
        let found = self.found(frame, image, head);
        self.is_known |= has_colour(found.as_ref());
        found
    }

    fn found(&mut self, frame: usize, image: &Picture<impl Pixels>, head: Option<HeadBox>) -> Option<FoundFace> {
        let given = |head| FoundFace::at(image.as_raw(), image.dimensions(), of_blocks(head, self.block));
        if let Some(head) = head {
            self.look = None;
            return Some(given(head));
        }
        let answered = self.look.take_if(|look| look.due <= frame);
        let found = answered.and_then(|look| look.answer.wait());
        let is_known = self.is_known || has_colour(found.as_ref());
        let is_time = self.look.is_none() && is_time_to_look(frame, self.interval, is_known);
        match &self.faces {
            Faces::Given(faces) => faces.at(frame).map(given),
            Faces::Detector(detector) if is_time && frame == 0 => detector.find(image.as_raw(), image.dimensions()),
            Faces::Detector(detector) => {
                if is_time {
                    let (detector, image) = (detector.clone(), owned(image));
                    let answer =
                        Answer::Awaited(std::thread::spawn(move || detector.find(image.as_raw(), image.dimensions())));
                    self.look = Some(Look { due: frame + LATENCY, answer });
                }
                found
            }
        }
    }
}

fn has_colour(face: Option<&FoundFace>) -> bool {
    face.is_some_and(|face| face.colour.is_some())
}

/// The same image for another thread.
fn owned(image: &Picture<impl Pixels>) -> RgbImage {
    // As many bytes as the image has.
    RgbImage::from_raw(image.width(), image.height(), image.as_raw().to_vec()).unwrap_or_default()
}

/// A box in the picture whose pixels are blocks.
fn of_blocks(head: HeadBox, block: u32) -> HeadBox {
    let scale = 1.0 / block as f32;
    HeadBox { centre_px: head.centre_px.map(|at| (at + 0.5) * scale - 0.5), width_px: head.width_px * scale }
}

/// Waits for a look.
impl SavedState for FaceLooks {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        let mut look = self.look.take().map(|look| (look.due as u64, look.answer.wait()));
        optional(&mut look, (0, None), visitor, |(due, face), visitor| {
            visitor.long(due);
            optional(face, NO_FACE, visitor, |face, visitor| {
                face.head.visit(visitor);
                optional(&mut face.colour, PersonColour::default(), visitor, PersonColour::visit);
            });
        });
        self.look = look.map(|(due, face)| Look { due: due as usize, answer: Answer::Known(face) });
        visitor.flag(&mut self.is_known);
    }
}

/// What a face is before it is read.
const NO_FACE: FoundFace = FoundFace { head: HeadBox { centre_px: [0.0; 2], width_px: 1.0 }, colour: None };

impl Answer {
    /// The answer; none of a look that failed.
    fn wait(self) -> Option<FoundFace> {
        match self {
            Self::Awaited(thread) => thread.join().ok().flatten(),
            Self::Known(face) => face,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_face_counts_from_its_frame_on() {
        let face = FoundFace { head: HeadBox { centre_px: [160.0, 50.0], width_px: 36.0 }, ..NO_FACE };
        let mut looks = FaceLooks::new(15.0, 1, None).unwrap();
        looks.look = Some(Look { due: 10, answer: Answer::Known(Some(face)) });
        let image = RgbImage::new(64, 48);
        assert_eq!(looks.look(9, &image, None), None);
        assert_eq!(looks.look(10, &image, None), Some(face));
        assert_eq!(looks.look(11, &image, None), None);
    }

    #[test]
    fn a_given_face_counts_from_its_frame_on() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("head.csv");
        std::fs::write(&path, "frame,u_px,v_px,size_px\n2,222,213,26\n").unwrap();
        let mut looks = FaceLooks::new(15.0, 2, Some(FaceTable::read(&path).unwrap())).unwrap();
        let image = RgbImage::from_pixel(320, 240, image::Rgb([200, 150, 125]));
        assert_eq!(looks.look(1, &image, None), None);
        let found = looks.look(2, &image, None).unwrap();
        assert_eq!(found.head, HeadBox { centre_px: [110.75, 106.25], width_px: 13.0 });
        assert!(found.colour.is_some_and(|colour| colour.is_skin([200, 150, 125])));
        let head = HeadBox { centre_px: [222.0, 213.0], width_px: 26.0 };
        assert_eq!(looks.look(3, &image, Some(head)), Some(found), "one that comes with the frame");
    }
}
