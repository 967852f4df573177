//! Where both hands are, by the evidence of all frames so far: a filter over pairs of places.
//!
//! Each hand is at one of the frame's places, or hidden. Both are decided together, since one place
//! holds one hand. A model with hidden states in discrete time: Rabiner, "A tutorial on hidden
//! Markov models", Proceedings of the IEEE 77, 1989, equations (19) to (21).

use super::evidence::Evidence;
use super::place::HandPlace;
use crate::math::{exp, min};
use crate::numeric::rolled::rolled;
use crate::skeleton::Side;
use heapless::Vec;

/// Most places of a frame that are compared.
pub(super) const MAX_PLACES: usize = 12;
/// The places and `hidden`, which is last.
const STATES: usize = MAX_PLACES + 1;
/// Index of `hidden`.
const HIDDEN: usize = MAX_PLACES;

/// Standard deviation of a hand's way between frames, widths of the face. Chosen: a hand that
/// hurries passes half a face in a thirtieth of a second.
const STEP_STD: f32 = 0.25;
/// Weight of ways of any length: an arm that drops, a place that was missed.
const JUMP: f32 = 0.02;
/// Chance to be hidden after having been seen.
const HIDING: f32 = 0.03;
/// Chance to appear at one place after having been hidden.
const APPEARING: f32 = 0.06;
/// Distance within which two places are one hand.
pub(super) const ONE_HAND: f32 = 0.35;

/// The posterior of both hands.
#[derive(Debug, Clone)]
pub(super) struct HandsBelief {
    pub(super) positions: [[f32; 2]; MAX_PLACES],
    pub(super) count: usize,
    /// Probability of each pair: the left hand's state, then the right hand's.
    pub(super) pairs: [[f32; STATES]; STATES],
    pub(super) has_begun: bool,
}

/// The places of a frame that has so many, and `hidden`.
fn states(count: usize) -> impl Iterator<Item = usize> {
    (0..count.min(HIDDEN)).chain([HIDDEN])
}

/// What is known of one hand.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct HandBelief {
    /// Where it is: between the likeliest place and the mean of all within [`ONE_HAND`].
    pub position: [f32; 2],
    /// Index of the likeliest place.
    pub place: usize,
    /// Probability that the hand is at this place or another one within [`ONE_HAND`], 0 to 1.
    pub probability: f32,
}

impl HandsBelief {
    /// Before the first frame.
    pub const EMPTY: Self =
        Self { positions: [[0.0; 2]; MAX_PLACES], count: 0, pairs: [[0.0; STATES]; STATES], has_begun: false };

    /// Takes the places of a frame with their evidence for the left and the right hand. Of more
    /// than [`MAX_PLACES`] the first ones count.
    #[inline(never)]
    pub fn step(&mut self, places: &[HandPlace], evidence: &[[Evidence; 2]]) {
        let count = places.len().min(evidence.len()).min(MAX_PLACES);
        let mut positions = [[0.0; 2]; MAX_PLACES];
        for (position, place) in positions.iter_mut().zip(&places[..count]) {
            *position = place.position;
        }
        let next = if self.has_begun { self.predicted(&positions, count) } else { [[1.0; STATES]; STATES] };
        let mut sum = 0.0;
        let mut pairs = [[0.0; STATES]; STATES];
        for (left, right) in states(count).flat_map(|left| states(count).map(move |right| (left, right))) {
            pairs[left][right] = next[left][right] * pair_weight(places, evidence, left, right);
            sum += pairs[left][right];
        }
        if !(sum > 0.0 && sum.is_finite()) {
            *self = Self::EMPTY;
            return;
        }
        pairs.iter_mut().flatten().for_each(|pair| *pair /= sum);
        *self = Self { positions, count, pairs, has_begun: true };
    }

    /// The pairs before the new frame's evidence: T' A T with the transition T of one hand.
    #[inline(never)]
    fn predicted(&self, positions: &[[f32; 2]; MAX_PLACES], count: usize) -> [[f32; STATES]; STATES] {
        let (old_states, new_states) = (|| states(self.count), || states(count));
        let mut transition = [[0.0; STATES]; STATES];
        for (old, new) in old_states().flat_map(|old| new_states().map(move |new| (old, new))) {
            transition[old][new] = match (old == HIDDEN, new == HIDDEN) {
                (true, true) => 1.0,
                (true, false) => APPEARING,
                (false, true) => HIDING,
                (false, false) => (1.0 - HIDING) * moved(self.positions[old], positions[new]),
            };
        }
        let mut half = [[0.0; STATES]; STATES];
        for (left, right) in old_states().flat_map(|left| new_states().map(move |right| (left, right))) {
            half[left][right] = old_states().map(|old| self.pairs[left][old] * transition[old][right]).sum();
        }
        let mut pairs = [[0.0; STATES]; STATES];
        for (left, right) in new_states().flat_map(|left| new_states().map(move |right| (left, right))) {
            pairs[left][right] = old_states().map(|old| transition[old][left] * half[old][right]).sum();
        }
        pairs
    }

    /// What is known of the hand of a side: the likeliest places, none within [`ONE_HAND`] of a
    /// likelier one.
    #[must_use]
    #[inline(never)]
    pub fn hand(&self, side: Side) -> Vec<HandBelief, MAX_PLACES> {
        let mut marginal = [0.0; STATES];
        for (state, sum) in marginal.iter_mut().enumerate().take(rolled(STATES)) {
            *sum = match side {
                Side::Left => self.pairs[state].iter().sum(),
                Side::Right => self.pairs.iter().map(|row| row[state]).sum(),
            };
        }
        let mass = |place: usize| self.mass_near(self.positions[place], &marginal);
        let mut taken = [false; MAX_PLACES];
        let mut hands = Vec::new();
        while let Some(best) = (0..self.count).filter(|place| !taken[*place]).reduce(|best, place| {
            let (here, there) = (mass(place), mass(best));
            let is_better = here > there || (here == there && marginal[place] > marginal[best]);
            if is_better { place } else { best }
        }) {
            let is_near = self.is_near(self.positions[best]);
            let near = || (0..self.count).filter(|place| is_near[*place]);
            let likeliest = near().fold(best, |old, other| if marginal[other] > marginal[old] { other } else { old });
            near().for_each(|place| taken[place] = true);
            let probability = mass(best);
            let position = core::array::from_fn(|axis| {
                let there = self.positions[likeliest][axis];
                let sum: f32 = near().map(|place| marginal[place] * self.positions[place][axis]).sum();
                if probability > 0.0 { 0.5 * (there + sum / probability) } else { there }
            });
            // One for each place at most.
            let _ = hands.push(HandBelief { position, place: likeliest, probability: min(probability, 1.0) });
        }
        hands
    }

    /// Sum of the probabilities of all places within [`ONE_HAND`] of one.
    #[inline(never)]
    fn mass_near(&self, place: [f32; 2], marginal: &[f32; STATES]) -> f32 {
        let places = self.is_near(place).into_iter().zip(marginal);
        places.filter(|(is_near, _)| *is_near).map(|(_, probability)| *probability).sum()
    }

    /// Which places are within [`ONE_HAND`] of one.
    #[inline(never)]
    fn is_near(&self, place: [f32; 2]) -> [bool; MAX_PLACES] {
        let mut is_near = [false; MAX_PLACES];
        for (is_near, position) in is_near.iter_mut().zip(&self.positions).take(self.count) {
            *is_near = distance2(place, *position) < ONE_HAND * ONE_HAND;
        }
        is_near
    }
}

fn moved(old: [f32; 2], new: [f32; 2]) -> f32 {
    let squared = distance2(old, new);
    exp(-0.5 * squared / (STEP_STD * STEP_STD)) + JUMP / (1.0 + squared)
}

fn distance2(a: [f32; 2], b: [f32; 2]) -> f32 {
    (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1])
}

/// Weight of a pair in this frame.
fn pair_weight(places: &[HandPlace], evidence: &[[Evidence; 2]], left: usize, right: usize) -> f32 {
    match (left == HIDDEN, right == HIDDEN) {
        (true, true) => 1.0,
        (false, true) => exp(evidence[left][0].alone),
        (true, false) => exp(evidence[right][1].alone),
        (false, false) => {
            let (a, b) = (&places[left], &places[right]);
            let (left, right) = (&evidence[left][0], &evidence[right][1]);
            let log_weight =
                if a.object == b.object { left.shared + right.shared - 1.0 } else { left.alone + right.alone };
            // Two hands are not in one place.
            let closeness = exp(-distance2(a.position, b.position) / (ONE_HAND * ONE_HAND));
            exp(log_weight - 4.0 * closeness)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn place(position: [f32; 2], object: u8) -> HandPlace {
        HandPlace { position, object, thickness: 0.3, fill: 0.9, moving: 0.5, new: 0.5, end: None }
    }

    fn hands(belief: &HandsBelief) -> [Vec<HandBelief, MAX_PLACES>; 2] {
        [Side::Left, Side::Right].map(|side| belief.hand(side))
    }

    fn step(belief: &mut HandsBelief, places: &[([f32; 2], f32, f32)]) {
        let there: std::vec::Vec<_> = places.iter().enumerate().map(|(i, of)| place(of.0, i as u8)).collect();
        let evidence = |alone: f32| Evidence { alone, shared: alone };
        let all: std::vec::Vec<_> = places.iter().map(|of| [evidence(of.1), evidence(of.2)]).collect();
        belief.step(&there, &all);
    }

    #[test]
    fn hands_that_cross_keep_their_sides() {
        let mut belief = HandsBelief::EMPTY;
        for frame in 0..60 {
            // The left hand goes from right to left, the right one the other way, below it.
            let x = 1.5 - 0.05 * frame as f32;
            // Evidence knows the sides at the start only.
            let sides = if frame < 10 { 2.0 } else { 0.0 };
            step(&mut belief, &[([x, 2.0], 2.0 + sides, 2.0 - sides), ([-x, 2.5], 2.0 - sides, 2.0 + sides)]);
        }
        let [left, right] = hands(&belief);
        assert_eq!((left[0].place, right[0].place), (0, 1));
        assert!(left[0].probability > 0.7 && right[0].probability > 0.7, "{left:?} {right:?}");
    }

    #[test]
    fn a_place_that_vanishes_for_some_frames_is_found_again() {
        let mut belief = HandsBelief::EMPTY;
        let (hand, other, clutter) = (([1.5, 2.0], 3.0, -1.0), ([-1.5, 2.0], -1.0, 3.0), ([2.2, 0.5], 0.5, -2.0));
        (0..20).for_each(|_| step(&mut belief, &[hand, other, clutter]));
        (0..6).for_each(|_| step(&mut belief, &[other, clutter]));
        (0..6).for_each(|_| step(&mut belief, &[clutter, hand, other]));
        let [left, right] = hands(&belief);
        assert_eq!((left[0].place, right[0].place), (1, 2));
        assert!(left[0].probability > 0.8);
    }

    #[test]
    fn one_place_holds_one_hand() {
        let mut belief = HandsBelief::EMPTY;
        (0..20).for_each(|_| step(&mut belief, &[([0.2, 2.0], 3.0, 2.0)]));
        let [left, right] = hands(&belief);
        assert!(left[0].probability > 0.7 && right[0].probability < 0.3, "{left:?} {right:?}");
    }

    #[test]
    fn without_any_place_nothing_is_known() {
        let mut belief = HandsBelief::EMPTY;
        step(&mut belief, &[]);
        assert!(hands(&belief).iter().all(|hand| hand.is_empty()));
    }

    proptest! {
        #[test]
        fn pairs_stay_a_distribution(
            frames in proptest::collection::vec(
                proptest::collection::vec((any::<[i8; 2]>(), -200.0_f32..200.0, -200.0_f32..200.0), 0..20), 1..10,
            ),
        ) {
            let mut belief = HandsBelief::EMPTY;
            for frame in frames {
                let places: std::vec::Vec<_> =
                    frame.iter().map(|of| (of.0.map(|at| f32::from(at) / 8.0), of.1, of.2)).collect();
                step(&mut belief, &places);
                let sum: f32 = belief.pairs.iter().flatten().sum();
                prop_assert!(!belief.has_begun || (sum - 1.0).abs() < 1.0e-3, "{sum}");
                for hand in hands(&belief).iter().flatten() {
                    prop_assert!((0.0..=1.0).contains(&hand.probability) && hand.place < belief.count);
                }
            }
        }
    }
}
