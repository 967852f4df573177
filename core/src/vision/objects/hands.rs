//! Both hands of a person whose face was found, frame by frame.

use super::belief::{HandBelief, HandsBelief, MAX_PLACES};
use super::evidence::{Evidence, Liveliness, evidence};
use super::find::{HAND_RADIUS, Maps, places};
use super::grid::CellGrid;
use super::head::HeadBox;
use super::place::HandPlace;
use crate::camera::Pixel;
use crate::math::max;
use crate::saved_state::SavedState;
use crate::skeleton::Side;
use crate::vision::candidate::HandCandidate;
use core::f32::consts::PI;
use heapless::Vec;

/// Least part of a hand's disc that counts as filled, so that an area is never zero.
const MIN_FILL: f32 = 0.1;

/// Candidates of one hand, the likeliest first.
///
/// ```
/// use sinew_core::vision::candidate::HandCandidate;
/// use sinew_core::vision::objects::hands::Candidates;
///
/// let mut hand = Candidates::new();
/// let likely = HandCandidate { likelihood: 0.9, ..HandCandidate::default() };
/// hand.push(likely).expect("there is room for twelve");
/// assert_eq!(hand.first().map(|candidate| candidate.likelihood), Some(0.9));
/// ```
pub type Candidates = Vec<HandCandidate, MAX_PLACES>;

/// Finds both hands of one person, in a grid of at most `COLUMNS` x `ROWS` cells.
///
/// ```
/// use sinew_core::vision::objects::grid::CellGrid;
/// use sinew_core::vision::objects::hands::{Candidates, HandFinder};
/// use sinew_core::vision::objects::head::HeadBox;
///
/// let mut finder = HandFinder::<80, 60>::new(CellGrid::new(320, 240).expect("it has a size"));
/// // Without a face nothing is said; the page of `objects` shows it with one.
/// let nothing: &[Candidates; 2] = finder.step();
/// assert!(nothing.iter().all(|hand| hand.is_empty()) && finder.head().is_none());
/// finder.add_face(HeadBox { centre_px: [160.0, 60.0], width_px: 40.0 });
/// finder.add_face(HeadBox { centre_px: [164.0, 60.0], width_px: 44.0 });
/// assert_eq!(finder.head(), Some(HeadBox { centre_px: [162.0, 60.0], width_px: 42.0 }));
/// ```
#[derive(Debug, Clone)]
pub struct HandFinder<const COLUMNS: usize, const ROWS: usize> {
    pub(super) grid: CellGrid<COLUMNS, ROWS>,
    maps: Maps<COLUMNS, ROWS>,
    pub(super) head: Option<HeadBox>,
    pub(super) liveliness: Liveliness,
    pub(super) belief: HandsBelief,
    /// Those of the last frame, left and right.
    candidates: [Candidates; 2],
}

/// Places of a frame.
type Places = Vec<HandPlace, MAX_PLACES>;

impl<const COLUMNS: usize, const ROWS: usize> HandFinder<COLUMNS, ROWS> {
    /// A finder for the pictures of `grid` that knows no head yet.
    #[must_use]
    pub const fn new(grid: CellGrid<COLUMNS, ROWS>) -> Self {
        Self {
            grid,
            maps: Maps::EMPTY,
            head: None,
            liveliness: Liveliness::EMPTY,
            belief: HandsBelief::EMPTY,
            candidates: [Vec::new(), Vec::new()],
        }
    }

    /// Forgets all, and takes pictures of another size from now on; whether the grid has a cell.
    pub fn resize(&mut self, width_px: usize, height_px: usize) -> bool {
        self.head = None;
        (self.liveliness, self.belief) = (Liveliness::EMPTY, HandsBelief::EMPTY);
        self.grid.resize(width_px, height_px)
    }

    /// Takes a face that was found: the head is the mean of the old and the new box. A box that is
    /// out of range is left out.
    pub fn add_face(&mut self, mut face: HeadBox) {
        if !face.is_finite() {
            return;
        }
        self.head = Some(self.head.map_or(face, |old| HeadBox {
            centre_px: core::array::from_fn(|axis| 0.5 * (old.centre_px[axis] + face.centre_px[axis])),
            width_px: 0.5 * (old.width_px + face.width_px),
        }));
    }

    /// The grid, for the lines of a frame.
    pub fn grid_mut(&mut self) -> &mut CellGrid<COLUMNS, ROWS> {
        &mut self.grid
    }

    /// The head.
    #[must_use]
    pub fn head(&self) -> Option<HeadBox> {
        self.head
    }

    /// Answers the frame that the grid holds: candidates for the left and for the right hand. Their
    /// likelihood is the probability that the hand is there, by all frames so far.
    #[inline(never)]
    pub fn step(&mut self) -> &[Candidates; 2] {
        self.grid.end();
        self.candidates.iter_mut().for_each(Vec::clear);
        let Some(head) = self.head else { return &self.candidates };
        let mut places = Vec::new();
        let evidence = self.find(head, &mut places);
        self.belief.step(&places, &evidence);
        for (side, candidates) in [Side::Left, Side::Right].into_iter().zip(&mut self.candidates) {
            let candidate = |hand: &HandBelief| Some(candidate(hand, places.get(hand.place)?.fill, &head));
            candidates.extend(self.belief.hand(side).iter().filter_map(candidate));
        }
        &self.candidates
    }

    /// Finds the frame's places, and gives their evidence.
    // Not inlined, as all that works here for a while: each needs its stack after the other, not
    // at once.
    #[inline(never)]
    fn find(&mut self, head: HeadBox, chosen: &mut Places) -> Vec<[Evidence; 2], MAX_PLACES> {
        let mut found = Vec::new();
        places(&self.grid, head, &mut self.maps, &mut found);
        self.liveliness.add(&found);
        likeliest(&found, &self.liveliness, chosen)
    }
}

/// A hand as the trackers see it: a disc of the area that skin fills within a hand's radius.
fn candidate(hand: &HandBelief, fill: f32, head: &HeadBox) -> HandCandidate {
    let [u_px, v_px] = head.place_px(hand.position);
    let radius_px = HAND_RADIUS * head.width_px;
    let area_px = max(fill, MIN_FILL) * PI * radius_px * radius_px;
    let variance_px2 = area_px / (4.0 * PI);
    HandCandidate {
        centre: Pixel::new(u_px, v_px),
        moments_px2: [variance_px2, 0.0, variance_px2],
        area_px,
        likelihood: hand.probability,
    }
}

/// Chooses the places for which most speaks, and gives their evidence for left and right.
#[inline(never)]
fn likeliest(found: &[HandPlace], liveliness: &Liveliness, places: &mut Places) -> Vec<[Evidence; 2], MAX_PLACES> {
    let of = |place: &HandPlace| [Side::Left, Side::Right].map(|side| evidence(place, side, liveliness.of(place)));
    let score = |[left, right]: &[Evidence; 2]| max(max(left.alone, right.alone), max(left.shared, right.shared) - 1.0);
    let mut all: Vec<[Evidence; 2], MAX_PLACES> = Vec::new();
    places.clear();
    for place in found {
        let evidence = of(place);
        if places.is_full() {
            let mut worst = 0;
            for (index, other) in all.iter().enumerate() {
                if all.get(worst).is_some_and(|least| score(other) < score(least)) {
                    worst = index;
                }
            }
            if all.get(worst).is_none_or(|least| score(least) >= score(&evidence)) {
                continue;
            }
            places.remove(worst);
            all.remove(worst);
        }
        // There is room now.
        let _ = places.push(*place);
        let _ = all.push(evidence);
    }
    all
}
