//! All of a camera's vision: lines in; edges, blobs and both hands of a person out.

use super::calibration::SkinSample;
use super::edge_lines::{EDGE_CELL_PX, EdgeSteps};
use super::frame_lines::FrameLines;
use super::line_front_end::QvgaFrontEnd;
use super::pixel_format::PixelFormat;
use super::skin_table::{SkinTable, TABLE_WORDS};
use crate::error::ParameterError;
use crate::saved_state::{SavedState, StateVisitor};
use crate::slot::Slot;
use crate::vision::hand_likelihood::HandLikelihood;
use crate::vision::objects::grid::CellGrid;
use crate::vision::objects::hands::{Candidates, HandFinder};
use crate::vision::objects::head::HeadBox;
use crate::vision::objects::person_colour::PersonColour;
use crate::vision::skin::SkinClassifier;

/// Columns and rows of cells: 8 x 8 pixels each. Chosen: a hand two metres away is two cells wide;
/// smaller cells do not fit beside the rest.
const COLUMNS: usize = 40;
const ROWS: usize = 30;
/// Pixels of a face that are looked at.
const FACE_PIXELS: usize = 128;
/// Words of the skin table that a frame learns of a new colour at most. `JUDGED_COLOURS` limits
/// the colours of them that have to be judged one by one. Chosen: most faces are learned in a third
/// of a second.
const LEARNED_WORDS: usize = 256;
const JUDGED_COLOURS: usize = 1280;
/// Bytes of luminance of a line.
const LINE_LEVELS: usize = 160;

/// Bytes that all of vision may take for 320 x 240 pixels, tables and maps included.
const PERSON_BYTES: usize = 28 * 1024;
const _: () = assert!(size_of::<PersonLines<super::pixel_format::Rgb565>>() <= PERSON_BYTES);

/// Reads the lines of a camera of at most 320 x 240 pixels, and follows the hands of one person.
/// The caller gives the person's face now and then, from any detector.
///
/// The middle of the face is looked at in the frame after. A part of the skin table is learned of
/// it at the end of each frame after that. So no frame costs much more than another. Hands are
/// found from the frame on in which all was learned, about ten after the first face, and none in
/// between.
///
/// ```
/// use sinew_core::vision::front_end::{PersonLines, pixel_format::Rgb565};
/// use sinew_core::vision::objects::head::HeadBox;
/// use sinew_core::vision::skin::GaussianSkin;
///
/// // A face, and a left hand that goes up beside it.
/// const SKIN: u16 = 200 >> 3 << 11 | 140 >> 2 << 5 | 110 >> 3;
/// let pixel = |frame: usize, u: usize, v: usize| {
///     let top = 190 - 3 * frame;
///     let is_face = (142..178).contains(&u) && (32..72).contains(&v);
///     let is_hand = (210..234).contains(&u) && (top..top + 26).contains(&v);
///     if is_face || is_hand { SKIN } else { 0x5aeb }
/// };
/// let mut vision = PersonLines::<Rgb565>::empty();
/// vision.begin((320, 240), &GaussianSkin::new(0.44, 0.31, [0.0030, -0.0008, 0.0010], 2.0, 60)?)?;
/// vision.add_face(HeadBox { centre_px: [160.0, 52.0], width_px: 36.0 });
/// for frame in 0..45 {
///     vision.begin_frame();
///     for v in 0..240 {
///         let line: [u16; 320] = core::array::from_fn(|u| pixel(frame, u, v));
///         vision.line(v, &line);
///     }
///     let seen = vision.end_frame().expect("it was begun");
///     assert!(seen.person.is_some() || frame < 15, "frame {frame}");
///     if frame == 44 {
///         let left = &seen.person.expect("the face is known").hands[0][0];
///         assert!(left.likelihood > 0.7 && (left.centre.v_px - 71.0).abs() < 10.0, "{left:?}");
///     }
/// }
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug)]
pub struct PersonLines<F> {
    front_end: Slot<QvgaFrontEnd>,
    size_px: [u16; 2],
    skin: SkinTable<F>,
    hands: HandFinder<COLUMNS, ROWS>,
    face: Option<HeadBox>,
    sample: Option<SkinSample<F, FACE_PIXELS>>,
    colour: Option<PersonColour>,
    /// Words of the table that have this colour.
    learned: usize,
    /// Whether all of the table is of the person.
    is_of_person: bool,
}

/// What a frame showed.
///
/// ```
/// use sinew_core::vision::front_end::{PersonLines, pixel_format::Rgb565};
/// use sinew_core::vision::skin::GaussianSkin;
///
/// let mut vision = PersonLines::<Rgb565>::empty();
/// vision.begin((64, 48), &GaussianSkin::new(0.44, 0.31, [0.0030, -0.0008, 0.0010], 2.0, 60)?)?;
/// // No line came, and no face was given.
/// vision.begin_frame();
/// let seen = vision.end_frame().expect("it was begun");
/// assert_eq!((seen.lines.losses.missing_lines, seen.person.is_none()), (48, true));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug)]
pub struct PersonFrame<'a> {
    /// Blobs, edges and losses.
    pub lines: FrameLines<'a>,
    /// The person; `None` while none is known.
    pub person: Option<PersonHands<'a>>,
}

/// The person before a camera.
///
/// ```
/// use sinew_core::vision::front_end::PersonHands;
/// use sinew_core::vision::objects::{hands::Candidates, head::HeadBox};
///
/// let hands = [Candidates::new(), Candidates::new()];
/// let head = HeadBox { centre_px: [160.0, 52.0], width_px: 36.0 };
/// let person = PersonHands { head, hands: &hands };
/// assert!(person.hands.iter().all(|hand| hand.is_empty()), "both hands are hidden");
/// ```
#[derive(Debug, Clone, Copy)]
pub struct PersonHands<'a> {
    /// The head, by the faces that were given.
    pub head: HeadBox,
    /// Candidates for the left and the right hand, the likeliest first.
    pub hands: &'a [Candidates; 2],
}

impl<F: PixelFormat> PersonLines<F> {
    /// Before [`PersonLines::begin`]: it sees nothing. All zero, so that a static of it takes no
    /// room in flash.
    #[must_use]
    pub const fn empty() -> Self {
        Self {
            front_end: Slot::Empty,
            size_px: [0; 2],
            skin: SkinTable::new(),
            hands: HandFinder::new(CellGrid::empty()),
            face: None,
            sample: None,
            colour: None,
            learned: 0,
            is_of_person: false,
        }
    }

    /// Begins with frames of `width` x `height` pixels, in which anyone's skin has the colours of
    /// `skin` until a face is known.
    ///
    /// # Errors
    /// A size out of its range, as [`QvgaFrontEnd::new`].
    pub fn begin(&mut self, size: (usize, usize), skin: &impl SkinClassifier) -> Result<(), ParameterError> {
        let front_end = QvgaFrontEnd::new(size, HandLikelihood::default(), EdgeSteps::default())?;
        self.front_end = Slot::Full(front_end);
        self.size_px = [size.0 as u16, size.1 as u16];
        self.skin.learn(skin);
        // A picture that is smaller than a cell has no hands.
        let _ = self.hands.resize(size.0, size.1);
        (self.face, self.sample, self.colour) = (None, None, None);
        (self.learned, self.is_of_person) = (0, false);
        Ok(())
    }

    /// Whether it was begun, so that it sees.
    #[must_use]
    pub const fn has_begun(&self) -> bool {
        self.front_end.get().is_some()
    }

    /// Gives a face, found in any of the last frames; it is looked at in the next one.
    pub fn add_face(&mut self, mut face: HeadBox) {
        if face.is_finite() {
            self.face = Some(face);
        }
    }

    /// The head; `None` before the first face.
    #[must_use]
    pub fn head(&self) -> Option<HeadBox> {
        self.hands.head()
    }

    /// Whether this person's skin was learned, so that hands are found.
    #[must_use]
    pub fn knows_person(&self) -> bool {
        self.is_of_person
    }

    /// Forgets the last frame: the next one has no temporal edges, as after a missing image.
    pub fn forget_last_frame(&mut self) {
        if let Some(front_end) = self.front_end.get_mut() {
            front_end.forget_last_frame();
        }
    }

    /// Begins a frame; drops an unfinished one.
    pub fn begin_frame(&mut self) {
        if let Some(front_end) = self.front_end.get_mut() {
            front_end.begin_frame();
        }
        self.hands.grid_mut().begin();
        self.sample = self.face.map(|face| SkinSample::new(face.middle(self.size_px)));
    }

    /// Reads line `v`, as [`QvgaFrontEnd::line`].
    pub fn line(&mut self, v: usize, line: &[u16]) {
        let Some(front_end) = self.front_end.get_mut() else { return };
        let is_new = v >= front_end.next_line();
        front_end.line(v, line, &self.skin);
        if !is_new || v >= usize::from(self.size_px[1]) {
            return;
        }
        if let Some(sample) = &mut self.sample {
            sample.line(v, line);
        }
        if v.is_multiple_of(EDGE_CELL_PX) {
            // Of a camera's levels from 0 to 127.
            let levels = || front_end.last_luminances().map(|four| four << 1);
            let grid = self.hands.grid_mut();
            if !grid.line_of_words(v, front_end.last_skin(), levels()) {
                let mut bytes = [0; LINE_LEVELS];
                bytes.as_chunks_mut().0.iter_mut().zip(levels()).for_each(|(four, word)| *four = word.to_le_bytes());
                grid.line(v, front_end.last_skin(), &bytes, EDGE_CELL_PX);
            }
        }
    }

    /// Ends the frame; `None` before [`PersonLines::begin`].
    pub fn end_frame(&mut self) -> Option<PersonFrame<'_>> {
        if !self.take_face() {
            self.learn();
        }
        let head = self.hands.head().filter(|_| self.is_of_person);
        let person = head.map(|head| PersonHands { head, hands: self.hands.step() });
        let mut lines = self.front_end.get_mut()?.end_frame();
        if self.colour.is_some() && person.is_none() {
            // Of half a person's skin nothing is said.
            lines.candidates = &[];
        }
        Some(PersonFrame { lines, person })
    }

    /// Takes the colour of the face that the frame showed; whether there was one.
    #[inline(never)]
    fn take_face(&mut self) -> bool {
        let (Some(face), Some(sample)) = (self.face, self.sample.take()) else { return false };
        self.face = None;
        let Some(seen) = sample.person_colour() else { return true };
        let colour = self.colour.map_or(Some(seen), |old| old.moved_to(&seen));
        if colour.is_some() {
            (self.colour, self.learned) = (colour, 0);
            self.hands.add_face(face);
        }
        true
    }

    /// Learns a part of the table.
    fn learn(&mut self) {
        let Some(colour) = self.colour.filter(|_| self.learned < TABLE_WORDS) else { return };
        let words = self.learned..self.learned + LEARNED_WORDS;
        self.learned = self.skin.learn_some(&colour, words, JUDGED_COLOURS);
        self.is_of_person |= self.learned == TABLE_WORDS;
    }
}

/// What the next frame needs of the last ones, its edges apart.
impl<F: PixelFormat> SavedState for PersonLines<F> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        self.skin.words_mut().iter_mut().for_each(|word| visitor.word(word));
        self.hands.visit(visitor);
        visitor.index(&mut self.learned, TABLE_WORDS);
        visitor.flag(&mut self.is_of_person);
        let mut has_face = self.face.is_some();
        visitor.flag(&mut has_face);
        let mut face = self.face.unwrap_or(HeadBox { centre_px: [0.0; 2], width_px: 1.0 });
        face.visit(visitor);
        self.face = has_face.then_some(face);
        let mut has_colour = self.colour.is_some();
        visitor.flag(&mut has_colour);
        let mut colour = self.colour.unwrap_or_default();
        colour.visit(visitor);
        self.colour = has_colour.then_some(colour);
    }
}
#[cfg(test)]
mod tests {
    use super::super::pixel_format::Rgb565;
    use super::*;
    use crate::camera::Pixel;
    use crate::vision::skin::GaussianSkin;
    use std::boxed::Box;

    const SKIN: u16 = 200 >> 3 << 11 | 140 >> 2 << 5 | 110 >> 3;
    const WALL: u16 = 0x5aeb;
    const FACE: HeadBox = HeadBox { centre_px: [160.0, 52.0], width_px: 36.0 };

    fn begun(size: (usize, usize)) -> Box<PersonLines<Rgb565>> {
        let mut vision = Box::new(PersonLines::empty());
        let anyone = GaussianSkin::new(0.44, 0.31, [0.0030, -0.0008, 0.0010], 2.0, 60).unwrap();
        vision.begin(size, &anyone).unwrap();
        vision
    }

    /// A face, and a left hand that goes up beside it.
    fn pixel(frame: usize, u: usize, v: usize) -> u16 {
        let top = 190 - 3 * frame.min(50);
        let is_face = (142..178).contains(&u) && (32..72).contains(&v);
        let is_hand = (210..234).contains(&u) && (top..top + 26).contains(&v);
        if is_face || is_hand { SKIN } else { WALL }
    }

    fn show(
        vision: &mut PersonLines<Rgb565>,
        frame: usize,
        lines: impl Iterator<Item = usize>,
    ) -> Option<(Pixel, f32)> {
        vision.begin_frame();
        for v in lines {
            let line: [u16; 320] = core::array::from_fn(|u| pixel(frame, u, v));
            vision.line(v, &line);
        }
        let person = vision.end_frame().unwrap().person?;
        person.hands[0].first().map(|hand| (hand.centre, hand.likelihood))
    }

    #[test]
    fn lines_that_come_twice_or_not_at_all_do_no_harm() {
        let mut vision = begun((320, 240));
        vision.add_face(FACE);
        for frame in 0..40 {
            // Of three frames one has each line twice, one every fifth not.
            let lines = (0..480).map(|line| line / 2).filter(|v| frame % 3 != 1 || v % 5 != 0);
            let hand = show(&mut vision, frame, lines);
            assert!(frame < 20 || vision.knows_person(), "frame {frame} {}", vision.learned);
            if frame >= 30 {
                let (centre, likelihood) = hand.unwrap();
                let distance = centre.distance_px(Pixel::new(221.5, 202.5 - 3.0 * frame as f32));
                assert!(likelihood > 0.7 && distance < 10.0, "frame {frame}: {centre:?} {likelihood}");
            }
        }
    }

    #[test]
    fn a_face_of_another_colour_is_learned_part_by_part() {
        let mut vision = begun((320, 240));
        assert!(vision.skin.is_skin(SKIN) && !vision.skin.is_skin(0x07e0));
        vision.add_face(HeadBox { centre_px: [20.0, 20.0], width_px: 30.0 });
        // If every word is judged.
        let most = TABLE_WORDS.div_ceil(JUDGED_COLOURS / 32) + 1;
        for frame in 0..most {
            assert!(frame > 4 || !vision.knows_person(), "frame {frame}");
            show(&mut vision, frame, 0..240);
        }
        // The box showed the wall.
        assert!(vision.knows_person() && vision.skin.is_skin(WALL) && !vision.skin.is_skin(SKIN));
        assert_eq!(vision.head().map(|head| head.width_px), Some(30.0));
    }

    #[test]
    fn a_face_that_shows_nothing_or_is_out_of_range_changes_nothing() {
        let mut vision = begun((320, 240));
        vision.add_face(HeadBox { centre_px: [f32::NAN, 20.0], width_px: 30.0 });
        assert!(vision.face.is_none());
        vision.add_face(FACE);
        vision.begin_frame();
        assert!(vision.end_frame().unwrap().person.is_none() && vision.head().is_none(), "no line came");
    }

    #[test]
    fn a_state_goes_on_alike() {
        use crate::saved_state::{StateKind, restore, save};
        let mut vision = begun((320, 240));
        vision.add_face(FACE);
        (0..4).for_each(|frame| assert!(show(&mut vision, frame, 0..240).is_none()));
        let mut bytes = std::vec![0; 40_000];
        let length = save(StateKind::Hands, 1, vision.as_mut(), &mut bytes).unwrap();
        let mut again = begun((320, 240));
        restore(StateKind::Hands, 1, again.as_mut(), &bytes[..length]).unwrap();
        for frame in 4..40 {
            assert_eq!(show(&mut vision, frame, 0..240), show(&mut again, frame, 0..240), "frame {frame}");
        }
    }

    #[test]
    fn pictures_without_a_cell_have_no_hands() {
        assert!(PersonLines::<Rgb565>::empty().end_frame().is_none());
        let mut vision = begun((3, 1));
        vision.add_face(HeadBox { centre_px: [1.0, 0.0], width_px: 2.0 });
        for _ in 0..30 {
            vision.begin_frame();
            vision.line(0, &[SKIN; 3]);
            assert!(vision.end_frame().is_some_and(|seen| seen.person.is_none_or(|person| person.hands[0].is_empty())));
        }
    }
}
