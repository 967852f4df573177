//! How much speaks for a place to be a hand, in one frame alone.
//!
//! The numbers were chosen on fourteen clips of three people before one camera (`video/asl`), the
//! parts by six clips of two others (`docs/hands_over_time.md`). Lengths are in widths of the
//! face's box.

use super::head::{distance, shoulder, sign};
use super::place::{ArmEnd, HandPlace};
use crate::math::{abs, clamp, exp, max, min};
use crate::skeleton::Side;

/// Share of motion below which nothing is lively.
pub(super) const MIN_LIVELINESS: f32 = 0.12;
/// What is left of the liveliest after a frame.
const FADING: f32 = 0.95;
/// Longest upper arm.
const UPPER_ARM: f32 = 2.3;
/// Furthest to the side of the face that a resting hand is.
const ASIDE: f32 = 2.3;
/// Longest arm to the middle of its hand.
const ARM: f32 = 4.7;
/// What rests where no hand hangs. Chosen: 1 to 4 tried on the clips, also cut below the elbows,
/// where forearms go on beyond the picture; 3 and 4 do as well.
const STALE: f32 = 3.0;

/// Log-evidence of a place for one side.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Evidence {
    /// If no other hand lies in the same object.
    pub alone: f32,
    /// If both hands lie in the object.
    pub shared: f32,
}

/// How lively the liveliest places of the last frames were, to which all others are compared. A
/// person at rest moves little, and noise moves everything a little.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Liveliness {
    pub(super) most: f32,
}

impl Liveliness {
    /// Before the first frame.
    pub const EMPTY: Self = Self { most: 0.0 };

    /// Takes the places of a frame.
    pub fn add(&mut self, places: &[HandPlace]) {
        let now = places.iter().fold(0.0, |most, place| max(most, place.moving));
        self.most = max(max(now, FADING * self.most), MIN_LIVELINESS);
    }

    /// Motion of a place relative to the liveliest, 0 to 1.
    #[must_use]
    pub fn of(&self, place: &HandPlace) -> f32 {
        min(1.0, place.moving / max(self.most, MIN_LIVELINESS))
    }
}

/// The evidence for `place` to be the hand of `side`; `liveliness` is that of the place.
#[must_use]
#[inline(never)]
pub(super) fn evidence(place: &HandPlace, side: Side, liveliness: f32) -> Evidence {
    let fresh = max(place.new, liveliness);
    let common = shape(place) + where_it_is(place, side, fresh) + 2.5 * liveliness + 1.2 * place.new;
    // From one and a half widths on an object is longer than a hand.
    let (alone, shared) = place.end.map_or((0.0, 0.0), |end| {
        let length = clamp((end.length - 1.8) / 0.8, 0.0, 1.0);
        (2.5 * length * far_from_elbow(place, &end, side), -1.5 * length)
    });
    Evidence { alone: 0.5 * (common + alone), shared: 0.5 * (common + shared) }
}

/// Filled and thick as a hand.
fn shape(place: &HandPlace) -> f32 {
    2.0 * (min(place.fill, 0.9) - 0.6) / 0.3 + 0.7 * (clamp(place.thickness, 0.1, 0.35) - 0.25) / 0.1
}

/// Hands hang beside the hips at rest, are on their own side, and within reach. What stays
/// elsewhere is less likely a hand, far to the side of the person least.
fn where_it_is(place: &HandPlace, side: Side, fresh: f32) -> f32 {
    let reached = from(shoulder(side), place.position);
    let distance = length(reached);
    let (beside, below) = ((sign(side) * reached[0] - 0.35) / 0.5, (distance - 4.0) / 0.7);
    let across = max(0.0, -sign(side) * place.position[0]);
    let rest = exp(-(beside * beside) - below * below);
    let stale = if fresh < 0.3 && rest < 0.2 { STALE } else { 0.0 };
    let aside = if abs(place.position[0]) > ASIDE { 2.5 * (1.0 - fresh) } else { 0.0 };
    1.5 * rest - 2.0 * across - 4.0 * max(0.0, distance - ARM) - stale - aside
}

/// Whether an end is the hand's (1) or the elbow's (-1). The elbow is within an upper arm of the
/// shoulder. Where both ends are, it is lower and further out.
fn far_from_elbow(place: &HandPlace, end: &ArmEnd, side: Side) -> f32 {
    let (here, other) = (from(shoulder(side), place.position), from(shoulder(side), end.other));
    let (distance, of_other) = (length(here), length(other));
    if of_other > UPPER_ARM && distance <= of_other {
        -1.0
    } else if distance > UPPER_ARM && of_other <= UPPER_ARM {
        1.0
    } else {
        clamp((other[1] - here[1]) + sign(side) * (other[0] - here[0]), -1.0, 1.0)
    }
}

fn from(origin: [f32; 2], place: [f32; 2]) -> [f32; 2] {
    [place[0] - origin[0], place[1] - origin[1]]
}

fn length(way: [f32; 2]) -> f32 {
    distance(way, [0.0; 2])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(position: [f32; 2]) -> HandPlace {
        HandPlace { position, object: 0, thickness: 0.3, fill: 0.9, moving: 0.6, new: 0.8, end: None }
    }

    #[test]
    fn a_hand_is_likelier_on_its_own_side_and_within_reach() {
        let at = |x: f32, y: f32| evidence(&place([x, y]), Side::Left, 1.0).alone;
        assert!(at(1.5, 2.0) > at(-1.5, 2.0) + 1.0);
        assert!(at(1.5, 2.0) > at(1.5, 6.5) + 1.5);
        assert_eq!(at(1.5, 2.0), evidence(&place([-1.5, 2.0]), Side::Right, 1.0).alone);
    }

    #[test]
    fn what_moves_and_is_new_is_likelier_a_hand() {
        let still = HandPlace { moving: 0.0, new: 0.0, ..place([1.3, 2.0]) };
        let here = evidence(&place([1.3, 2.0]), Side::Left, 1.0).alone;
        assert!(here > evidence(&still, Side::Left, 0.0).alone + 1.5);
    }

    #[test]
    fn what_rests_far_to_the_side_is_no_hand() {
        let still = |x: f32| HandPlace { moving: 0.0, new: 0.0, ..place([x, 2.0]) };
        let at = |x: f32| evidence(&still(x), Side::Left, 0.0).alone;
        assert!(at(2.4) < at(2.2) - 1.0);
    }

    #[test]
    fn the_hand_is_the_end_away_from_the_shoulder() {
        let end = |position: [f32; 2], other: [f32; 2]| {
            let end = ArmEnd { length: 3.0, other };
            evidence(&HandPlace { end: Some(end), ..place(position) }, Side::Left, 1.0).alone
        };
        // A forearm that points to the side, and one that is raised.
        assert!(end([4.3, 2.0], [2.2, 2.4]) > end([2.2, 2.4], [4.3, 2.0]) + 1.0);
        assert!(end([1.4, 0.5], [1.8, 2.8]) > end([1.8, 2.8], [1.4, 0.5]) + 1.0);
    }

    #[test]
    fn motion_counts_relative_to_the_liveliest_and_fades() {
        let mut liveliness = Liveliness::EMPTY;
        let moving = |moving| HandPlace { moving, ..place([1.0, 1.0]) };
        liveliness.add(&[moving(0.8), moving(0.2)]);
        assert_eq!((liveliness.of(&moving(0.8)), liveliness.of(&moving(0.2))), (1.0, 0.25));
        for _ in 0..100 {
            liveliness.add(&[]);
        }
        assert_eq!(liveliness.of(&moving(0.12)), 1.0);
    }
}
