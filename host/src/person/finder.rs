//! Both hands of the person before the camera, frame by frame.
//!
//! A face is looked for in the first frame and once a second, beside the tracker; what is found
//! counts a fixed number of frames later, so that no result depends on threads.

use super::face::{FaceDetector, FoundFace};
use super::given::FaceTable;
use super::skin::PersonSkin;
use crate::error::Result;
use crate::frames::FrameReader;
use crate::resume::{from_text, optional, to_text};
use image::RgbImage;
use sinew_core::camera::{Camera, Pixel};
use sinew_core::math::Vec3;
use sinew_core::saved_state::{SavedState, StateKind, StateVisitor};
use sinew_core::skeleton::Side;
use sinew_core::vision::candidate::HandCandidate;
use sinew_core::vision::objects::grid::CellGrid;
use sinew_core::vision::objects::hands::HandFinder;
use sinew_core::vision::objects::head::{HeadBox, shoulder};
use sinew_core::vision::objects::person_colour::PersonColour;
use std::thread::JoinHandle;

/// Frames after which an answer counts. Chosen: a third of a second, in which any computer finds a
/// face.
const LATENCY: usize = 10;
/// Width of a face's box, metres. Chosen: a box is a little wider than the mean breadth between the
/// cheekbones, 0.14 m; arms that hang are then 0.65 m long.
const FACE_WIDTH_M: f32 = 0.15;
/// Most frames between two looks.
const MAX_INTERVAL: f64 = 600.0;

/// What one frame shows of the person.
#[derive(Debug, Clone)]
pub struct PersonView {
    /// Candidates for the left and the right hand, the likeliest first.
    pub hands: [Vec<HandCandidate>; 2],
    /// Left and right shoulder, by the face, metres in camera axes.
    pub shoulders_m: [Vec3; 2],
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

/// Where faces come from.
#[derive(Debug)]
enum Faces {
    Detector(FaceDetector),
    Given(FaceTable),
}

/// Finds the hands of one person.
#[derive(Debug)]
pub struct PersonFinder {
    faces: Faces,
    /// None for pictures that are too small.
    hands: Option<Box<HandFinder>>,
    skin: Option<PersonSkin>,
    interval: usize,
    look: Option<Look>,
    camera: Camera,
}

impl PersonFinder {
    /// A finder for pictures of a size, so many a second, that looks for faces, or takes those that
    /// are `given`.
    ///
    /// # Errors
    /// None with the shipped model.
    pub fn new(size_px: (u32, u32), rate_hz: f64, camera: Camera, given: Option<FaceTable>) -> Result<Self> {
        let grid = CellGrid::new(size_px.0 as usize, size_px.1 as usize);
        Ok(Self {
            faces: match given {
                Some(faces) => Faces::Given(faces),
                None => Faces::Detector(FaceDetector::new()?),
            },
            hands: grid.map(|grid| Box::new(HandFinder::new(grid))),
            skin: None,
            interval: rate_hz.round().clamp(1.0, MAX_INTERVAL) as usize,
            look: None,
            camera,
        })
    }

    /// The person's skin, once a face was found.
    #[must_use]
    pub fn skin(&self) -> Option<&PersonSkin> {
        self.skin.as_ref()
    }

    /// Takes what was found of a face, and begins the next look; to be called before a frame is
    /// read.
    pub fn look(&mut self, frame: usize, image: &RgbImage) {
        if self.look.as_ref().is_some_and(|look| look.due <= frame) {
            let face = self.look.take().and_then(|look| look.answer.wait());
            self.take(face);
        }
        let is_time = self.hands.is_some() && self.look.is_none() && frame.is_multiple_of(self.interval);
        match &self.faces {
            Faces::Given(faces) => {
                let face = faces.at(frame).map(|head| FoundFace::at(image, head));
                self.take(face);
            }
            Faces::Detector(detector) if is_time && frame == 0 => {
                let face = detector.find(image);
                self.take(face);
            }
            Faces::Detector(detector) if is_time => {
                let (detector, image) = (detector.clone(), image.clone());
                let answer = Answer::Awaited(std::thread::spawn(move || detector.find(&image)));
                self.look = Some(Look { due: frame + LATENCY, answer });
            }
            Faces::Detector(_) => {}
        }
    }

    fn take(&mut self, face: Option<FoundFace>) {
        let (Some(face), Some(hands)) = (face, &mut self.hands) else { return };
        let colour = match (&self.skin, face.colour) {
            (Some(skin), Some(colour)) => skin.colour().moved_to(&colour),
            (None, colour) => colour,
            (Some(_), None) => None,
        };
        if let Some(colour) = colour {
            self.skin = Some(PersonSkin::new(colour));
        }
        if self.skin.is_some() {
            hands.add_face(face.head);
        }
    }

    /// Answers the frame that `reader` has read with this person's [skin](Self::skin); `None` while
    /// no face is known.
    pub fn see(&mut self, reader: &mut FrameReader) -> Option<PersonView> {
        let hands = self.hands.as_mut()?;
        hands.head()?;
        reader.fill(hands.grid_mut());
        let [left, right] = hands.step();
        let shoulders_m = self.shoulders_m()?;
        Some(PersonView { hands: [left.to_vec(), right.to_vec()], shoulders_m })
    }

    /// Left and right shoulder, by the face, metres in camera axes; none while no face is known.
    #[must_use]
    pub fn shoulders_m(&self) -> Option<[Vec3; 2]> {
        let head = self.hands.as_ref()?.head()?;
        Some([Side::Left, Side::Right].map(|side| {
            let [u_px, v_px] = head.place_px(shoulder(side));
            self.place_m(Pixel::new(u_px, v_px), &head)
        }))
    }

    /// The place in the head's distance that is seen at a pixel.
    fn place_m(&self, pixel: Pixel, head: &HeadBox) -> Vec3 {
        let direction = self.camera.back_project(pixel).direction;
        direction * (self.camera.focal_px() * FACE_WIDTH_M / head.width_px / direction.z)
    }

    /// The state after the last frame as text, which [`PersonFinder::restore`] takes. Waits for a
    /// look.
    ///
    /// # Errors
    /// None that a user can bring about.
    pub fn saved(&mut self) -> Result<String> {
        to_text(StateKind::Hands, self)
    }

    /// Goes on from a state that was saved with the same size and rate.
    ///
    /// # Errors
    /// The state is not whole, or of another run.
    pub fn restore(&mut self, saved: &str) -> Result<()> {
        from_text(StateKind::Hands, saved, self)
    }
}

impl SavedState for PersonFinder {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        if let Some(hands) = &mut self.hands {
            hands.visit(visitor);
        }
        let mut colour = self.skin.as_ref().map(|skin| *skin.colour());
        optional(&mut colour, PersonColour::default(), visitor, PersonColour::visit);
        if colour.as_ref() != self.skin.as_ref().map(PersonSkin::colour) {
            self.skin = colour.map(PersonSkin::new);
        }
        let mut look = self.look.take().map(|look| (look.due as u64, look.answer.wait()));
        optional(&mut look, (0, None), visitor, |(due, face), visitor| {
            visitor.long(due);
            optional(face, NO_FACE, visitor, |face, visitor| {
                face.head.visit(visitor);
                optional(&mut face.colour, PersonColour::default(), visitor, PersonColour::visit);
            });
        });
        self.look = look.map(|(due, face)| Look { due: due as usize, answer: Answer::Known(face) });
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
    use crate::resume::to_text;
    use image::Rgb;
    use sinew_core::vision::edges::EdgeDetector;
    use sinew_core::vision::hand_likelihood::HandLikelihood;

    const SKIN: [u8; 3] = [200, 150, 125];

    fn finder() -> PersonFinder {
        let camera = Camera::from_field_of_view(320, 240, 1.05).unwrap();
        PersonFinder::new((320, 240), 15.0, camera, None).unwrap()
    }

    fn face() -> FoundFace {
        let head = HeadBox { centre_px: [160.0, 50.0], width_px: 36.0 };
        FoundFace { head, colour: PersonColour::of_face(&[SKIN; 100]) }
    }

    /// A picture with a hand that goes up on the person's left.
    fn picture(frame: usize) -> RgbImage {
        let top = 200 - 3 * frame as u32;
        let is_hand = |u, v| (210..234).contains(&u) && (top..top + 26).contains(&v);
        RgbImage::from_fn(320, 240, |u, v| Rgb(if is_hand(u, v) { SKIN } else { [70, 90, 110] }))
    }

    fn shown(finder: &mut PersonFinder, reader: &mut FrameReader, frame: usize) -> Option<PersonView> {
        let image = picture(frame);
        finder.look(frame, &image);
        let skin = finder.skin().cloned().unwrap();
        reader.read(&image, &skin).unwrap();
        finder.see(reader)
    }

    fn reader() -> FrameReader {
        FrameReader::new(HandLikelihood::default(), EdgeDetector::default()).unwrap()
    }

    #[test]
    fn a_hand_is_found_and_a_finder_that_was_saved_goes_on_alike() {
        let (mut finder, mut reader) = (finder(), reader());
        finder.take(Some(face()));
        (0..20).for_each(|frame| drop(shown(&mut finder, &mut reader, frame)));
        let saved = finder.saved().unwrap();
        let mut again = self::finder();
        again.restore(&saved).unwrap();
        assert_eq!(to_text(StateKind::Hands, &mut again).unwrap(), saved);
        let mut last = None;
        for frame in 20..40 {
            let views = [&mut finder, &mut again].map(|finder| shown(finder, &mut reader, frame).unwrap());
            assert_eq!(views[0].hands, views[1].hands);
            assert_eq!(views[0].shoulders_m, views[1].shoulders_m);
            last = views[0].hands[0].first().copied();
        }
        let left = last.unwrap();
        let hand = Pixel::new(222.0, 200.0 - 3.0 * 39.0 + 13.0);
        assert!(left.likelihood > 0.7 && left.centre.distance_px(hand) < 8.0, "{left:?} not at {hand:?}");
    }

    #[test]
    fn a_face_counts_from_its_frame_on() {
        let mut finder = finder();
        finder.look = Some(Look { due: 10, answer: Answer::Known(Some(face())) });
        finder.look(9, &picture(0));
        assert!(finder.skin().is_none() && finder.shoulders_m().is_none());
        finder.look(10, &picture(0));
        let [left, right] = finder.shoulders_m().unwrap();
        assert!((left.x + right.x).abs() < 0.01 && (left - right).norm() > 0.25, "{left:?} {right:?}");
    }

    #[test]
    fn a_given_face_counts_from_its_frame_on() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("head.csv");
        std::fs::write(&path, "frame,u_px,v_px,size_px\n2,222,213,26\n").unwrap();
        let mut finder = PersonFinder { faces: Faces::Given(FaceTable::read(&path).unwrap()), ..finder() };
        finder.look(1, &picture(0));
        assert!(finder.shoulders_m().is_none());
        // The place of the hand has the colour of a face, too.
        finder.look(2, &picture(0));
        assert!(finder.shoulders_m().is_some() && finder.skin().is_some_and(|skin| skin.colour().is_skin(SKIN)));
    }

    #[test]
    fn a_state_that_was_cut_is_refused() {
        let mut finder = finder();
        let saved = finder.saved().unwrap();
        assert!(finder.restore(&saved[..saved.len() / 2]).is_err());
    }
}
