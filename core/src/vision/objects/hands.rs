//! Both hands of a person whose face was found, frame by frame.

use super::belief::{HandsBelief, MAX_PLACES};
use super::evidence::{Evidence, Liveliness, evidence};
use super::find::{Maps, places};
use super::grid::CellGrid;
use super::head::HeadBox;
use super::place::HandPlace;
use crate::math::max;
use crate::skeleton::Side;
use heapless::Vec;

/// A hand with less probability is not sure.
pub const SURE: f32 = 0.7;

/// Where a hand is.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FoundHand {
    /// Its middle, pixels.
    pub centre_px: [f32; 2],
    /// Probability that it is there, 0 to 1.
    pub probability: f32,
    /// Whether it is seen there: probable, and not inferred from an arm that reaches into the face.
    pub is_sure: bool,
}

/// Finds both hands of one person.
#[derive(Debug, Clone)]
pub struct HandFinder {
    pub(super) grid: CellGrid,
    maps: Maps,
    pub(super) head: Option<HeadBox>,
    pub(super) liveliness: Liveliness,
    pub(super) belief: HandsBelief,
    places: Vec<HandPlace, MAX_PLACES>,
}

impl HandFinder {
    /// A finder for the pictures of `grid` that knows no head yet.
    #[must_use]
    pub fn new(grid: CellGrid) -> Self {
        Self {
            grid,
            maps: Maps::EMPTY,
            head: None,
            liveliness: Liveliness::default(),
            belief: HandsBelief::default(),
            places: Vec::new(),
        }
    }

    /// Takes a face that was found: the head is the mean of the old and the new box.
    pub fn add_face(&mut self, face: HeadBox) {
        self.head = Some(self.head.map_or(face, |old| HeadBox {
            centre_px: core::array::from_fn(|axis| 0.5 * (old.centre_px[axis] + face.centre_px[axis])),
            width_px: 0.5 * (old.width_px + face.width_px),
        }));
    }

    /// The grid, for the lines of a frame.
    pub fn grid_mut(&mut self) -> &mut CellGrid {
        &mut self.grid
    }

    /// The head.
    #[must_use]
    pub fn head(&self) -> Option<HeadBox> {
        self.head
    }

    /// The places of the last frame.
    #[must_use]
    pub fn places(&self) -> &[HandPlace] {
        &self.places
    }

    /// Answers the frame that the grid holds: left and right hand.
    pub fn step(&mut self) -> [Option<FoundHand>; 2] {
        let Some(head) = self.head else { return [None; 2] };
        let found = places(&self.grid, head, &mut self.maps);
        self.liveliness.add(&found);
        let (places, evidence) = likeliest(&found, &self.liveliness);
        self.belief.step(&places, &evidence);
        self.places = places;
        self.belief.hands().map(|hand| {
            let hand = hand?;
            let place = self.places.get(hand.place)?;
            let is_inferred = place.end.is_some_and(|end| end.is_in_face);
            Some(FoundHand {
                centre_px: head.place_px(place.position),
                probability: hand.probability,
                is_sure: hand.probability > SURE && !is_inferred,
            })
        })
    }
}

type Chosen = (Vec<HandPlace, MAX_PLACES>, Vec<[Evidence; 2], MAX_PLACES>);

/// The places for which most speaks, with their evidence for left and right.
fn likeliest(found: &[HandPlace], liveliness: &Liveliness) -> Chosen {
    let of = |place: &HandPlace| [Side::Left, Side::Right].map(|side| evidence(place, side, liveliness.of(place)));
    let score =
        |[left, right]: &[Evidence; 2]| max(max(left.alone, right.alone), max(left.shared, right.shared) - 1.0);
    let (mut places, mut all): Chosen = (Vec::new(), Vec::new());
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
    (places, all)
}
