//! The person by the face: skin, shoulders and both hands over time, as `sinew track arm` has them.

use sinew_core::skeleton::Side;
use sinew_core::vision::candidate::HandCandidate;
use sinew_core::vision::mask::Mask;
use sinew_core::vision::objects::grid::CellGrid;
use sinew_core::vision::objects::hands::HandFinder;
use sinew_core::vision::objects::head::HeadBox;
use sinew_face::{COLUMNS, FaceDetector, FoundFace, LATENCY, PersonSkin, ROWS, is_time_to_look};

/// Frames between two looks: a second of the thirty frames that the page asks a camera for.
const INTERVAL: usize = 30;

/// Looks for a face in the first frame and once a second, until one was found more often, and
/// follows the hands of whose it is.
#[derive(Debug)]
pub struct Person {
    detector: Option<FaceDetector>,
    hands: Box<HandFinder<COLUMNS, ROWS>>,
    skin: Option<PersonSkin>,
    /// Number of the next frame.
    frame: usize,
    /// The last look's frame, and its face.
    look: Option<(usize, Option<FoundFace>)>,
}

impl Person {
    /// Before the first frame.
    #[must_use]
    pub fn new(size_px: (usize, usize)) -> Self {
        // The model is shipped, so it can be read.
        let detector = FaceDetector::new().ok();
        let hands = Box::new(HandFinder::new(CellGrid::empty()));
        let mut person = Self { detector, hands, skin: None, frame: 0, look: None };
        person.begin_again(size_px);
        person
    }

    /// Forgets the person; pictures have this size from now on.
    pub fn begin_again(&mut self, size_px: (usize, usize)) {
        // A picture without a cell is too small for a face.
        let _ = self.hands.resize(size_px.0, size_px.1);
        (self.skin, self.frame, self.look) = (None, 0, None);
    }

    /// Looks at the next picture, interleaved RGB, if it is time.
    pub fn look(&mut self, rgb: &[u8], (width, height): (usize, usize)) {
        let frame = self.frame;
        self.frame += 1;
        let answer = self.look.take_if(|(begun, _)| *begun + LATENCY <= frame);
        self.take(answer.and_then(|(_, face)| face));
        if self.look.is_none() && is_time_to_look(frame, INTERVAL, self.skin.is_some()) {
            let find = |detector: &FaceDetector| detector.find(rgb, (width as u32, height as u32));
            let found = self.detector.as_ref().and_then(find);
            if frame == 0 {
                self.take(found);
            } else {
                self.look = Some((frame, found));
            }
        }
    }

    fn take(&mut self, face: Option<FoundFace>) {
        let Some(face) = face else { return };
        PersonSkin::learn(&mut self.skin, &face);
        if self.skin.is_some() {
            self.hands.add_face(face.head);
        }
    }

    /// The person's skin, once a face was found.
    #[must_use]
    pub fn skin(&self) -> Option<&PersonSkin> {
        self.skin.as_ref()
    }

    /// The head, by the faces that were found.
    #[must_use]
    pub fn head(&self) -> Option<HeadBox> {
        self.hands.head()
    }

    /// Finds where the hand of a `side` may be in a frame's mask and its luminance, the likeliest
    /// place first; `None` without a face.
    pub fn find_hand(&mut self, mask: &Mask<'_>, luminance: &[u8], side: Side) -> Option<&[HandCandidate]> {
        self.head()?;
        let grid = self.hands.grid_mut();
        grid.begin();
        for (v, (bits, levels)) in mask.rows().zip(luminance.chunks(mask.width().max(1))).enumerate() {
            grid.line(v, bits, levels, 1);
        }
        let [left, right] = self.hands.step();
        Some(if side == Side::Left { left } else { right })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_core::camera::Pixel;
    use sinew_core::vision::frame::{mask_words, segment};
    use sinew_core::vision::mask::MaskMut;

    const SIZE_PX: (usize, usize) = (320, 240);
    const SKIN: [u8; 3] = [200, 150, 125];
    const WALL: [u8; 3] = [70, 90, 110];
    const HEAD: HeadBox = HeadBox { centre_px: [160.0, 50.0], width_px: 36.0 };

    /// A face, and a hand that goes up on the person's left.
    fn picture(frame: usize) -> Vec<u8> {
        let top = 200 - 3 * frame;
        let is_hand = |u, v| (210..234).contains(&u) && (top..top + 26).contains(&v);
        let is_face = |u, v| (142..178).contains(&u) && (32..72).contains(&v);
        let places = (0..SIZE_PX.1).flat_map(|v| (0..SIZE_PX.0).map(move |u| (u, v)));
        places.flat_map(|(u, v)| if is_hand(u, v) || is_face(u, v) { SKIN } else { WALL }).collect()
    }

    fn show(person: &mut Person, frame: usize, side: Side) -> Vec<HandCandidate> {
        let rgb = picture(frame);
        person.look(&rgb, SIZE_PX);
        let mut words = vec![0; mask_words(SIZE_PX.0, SIZE_PX.1)];
        let mut mask = MaskMut::new(&mut words, SIZE_PX.0, SIZE_PX.1).unwrap();
        person.skin().into_iter().for_each(|skin| segment(&rgb, skin, &mut mask));
        let luminance: Vec<u8> = rgb.as_chunks::<3>().0.iter().map(|pixel| pixel[1]).collect();
        person.find_hand(&mask.view(), &luminance, side).unwrap_or_default().to_vec()
    }

    #[test]
    fn a_face_counts_from_its_frame_on_and_gives_the_hand() {
        let mut person = Person::new(SIZE_PX);
        // What is drawn is no face to the detector.
        assert!(show(&mut person, 0, Side::Left).is_empty() && person.head().is_none());
        person.look = Some((0, Some(FoundFace::at(&picture(0), (320, 240), HEAD))));
        let mut last = None;
        for frame in 1..40 {
            let hands = show(&mut person, frame, Side::Left);
            assert_eq!(person.head().is_some(), frame >= LATENCY, "frame {frame}");
            last = hands.first().copied();
        }
        let (left, hand) = (last.unwrap(), Pixel::new(222.0, 200.0 - 3.0 * 39.0 + 13.0));
        assert!(left.likelihood > 0.7 && left.centre.distance_px(hand) < 8.0, "{left:?} not at {hand:?}");
        person.begin_again(SIZE_PX);
        assert!(person.head().is_none() && person.skin().is_none());
    }

    #[test]
    fn pictures_too_small_for_a_face_are_looked_at() {
        for size in [(1, 1), (8, 3), (640, 2)] {
            let mut person = Person::new(size);
            (0..40).for_each(|_| person.look(&vec![90; 3 * size.0 * size.1], size));
            assert!(person.head().is_none());
        }
    }
}
