//! Both hands of the person before the camera, frame by frame.

use super::faces::FaceLooks;
use crate::error::Result;
use crate::frames::FrameReader;
use crate::pixels::{Picture, Pixels};
use crate::resume::{from_text, optional, to_text};
use sinew_core::camera::Camera;
use sinew_core::math::Vec3;
use sinew_core::saved_state::{SavedState, StateKind, StateVisitor};
use sinew_core::vision::candidate::HandCandidate;
use sinew_core::vision::objects::grid::CellGrid;
use sinew_core::vision::objects::hands::HandFinder;
use sinew_core::vision::objects::head::HeadBox;
use sinew_core::vision::objects::person_colour::PersonColour;
use sinew_face::{COLUMNS, FoundFace, PersonSkin, ROWS};

/// What one frame shows of the person.
#[derive(Debug, Clone)]
pub struct PersonView {
    /// Candidates for the left and the right hand, the likeliest first.
    pub hands: [Vec<HandCandidate>; 2],
    /// Left and right shoulder, by the face, metres in camera axes.
    pub shoulders_m: [Vec3; 2],
}

/// Finds the hands of one person.
#[derive(Debug)]
pub struct PersonFinder {
    faces: FaceLooks,
    /// None for pictures that are too small.
    hands: Option<Box<HandFinder<COLUMNS, ROWS>>>,
    skin: Option<PersonSkin>,
    camera: Camera,
}

impl PersonFinder {
    /// A finder for pictures of a size that a camera took, by these faces.
    #[must_use]
    pub fn new(size_px: (u32, u32), camera: Camera, faces: FaceLooks) -> Self {
        let grid = CellGrid::new(size_px.0 as usize, size_px.1 as usize);
        Self { faces, hands: grid.map(|grid| Box::new(HandFinder::new(grid))), skin: None, camera }
    }

    /// The person's skin, once a face was found.
    #[must_use]
    pub fn skin(&self) -> Option<&PersonSkin> {
        self.skin.as_ref()
    }

    /// Takes a face that counts from this frame on, that of `head` if it is given; to be called
    /// before the frame is read.
    pub fn look(&mut self, frame: usize, image: &Picture<impl Pixels>, head: Option<HeadBox>) {
        let face = self.faces.look(frame, image, head);
        self.take(face);
    }

    fn take(&mut self, face: Option<FoundFace>) {
        let (Some(face), Some(hands)) = (face, &mut self.hands) else { return };
        PersonSkin::learn(&mut self.skin, &face);
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
        let hands = hands.step().each_ref().map(|hand| hand.to_vec());
        let shoulders_m = self.shoulders_m()?;
        Some(PersonView { hands, shoulders_m })
    }

    /// Left and right shoulder, by the face, metres in camera axes; none while no face is known.
    #[must_use]
    pub fn shoulders_m(&self) -> Option<[Vec3; 2]> {
        Some(self.hands.as_ref()?.head()?.shoulders_m(&self.camera))
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
        self.faces.visit(visitor);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::resume::to_text;
    use image::{Rgb, RgbImage};
    use sinew_core::camera::Pixel;
    use sinew_core::vision::edges::EdgeDetector;
    use sinew_core::vision::hand_likelihood::HandLikelihood;

    const SKIN: [u8; 3] = [200, 150, 125];

    fn finder() -> PersonFinder {
        let camera = Camera::from_field_of_view(320, 240, 1.05).unwrap();
        PersonFinder::new((320, 240), camera, FaceLooks::new(15.0, 1, None).unwrap())
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
        finder.look(frame, &image, None);
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
    fn a_face_gives_shoulders_on_both_sides() {
        let mut finder = finder();
        assert!(finder.skin().is_none() && finder.shoulders_m().is_none());
        finder.take(Some(face()));
        let [left, right] = finder.shoulders_m().unwrap();
        assert!((left.x + right.x).abs() < 0.01 && (left - right).norm() > 0.25, "{left:?} {right:?}");
    }

    #[test]
    fn a_state_that_was_cut_is_refused() {
        let mut finder = finder();
        let saved = finder.saved().unwrap();
        assert!(finder.restore(&saved[..saved.len() / 2]).is_err());
    }
}
