//! Where both hands are, by the evidence of all frames so far: a filter over pairs of places.
//!
//! Each hand is at one of the frame's places, or hidden. Both are decided together, since one place
//! holds one hand. A model with hidden states in discrete time: Rabiner, "A tutorial on hidden
//! Markov models", Proceedings of the IEEE 77, 1989, equations (19) to (21).

use super::evidence::Evidence;
use super::place::HandPlace;
use crate::math::exp;

/// Most places of a frame that are compared.
pub const MAX_PLACES: usize = 12;
/// The places and `hidden`, which is last.
const STATES: usize = MAX_PLACES + 1;
/// Index of `hidden`.
const HIDDEN: usize = MAX_PLACES;

/// Standard deviation of a hand's way between frames, widths of the face. Chosen: a hand that hurries
/// passes half a face in a thirtieth of a second.
const STEP_STD: f32 = 0.25;
/// Weight of ways of any length: an arm that drops, a place that was missed.
const JUMP: f32 = 0.02;
/// Chance to be hidden after having been seen.
const HIDING: f32 = 0.03;
/// Chance to appear at one place after having been hidden.
const APPEARING: f32 = 0.06;
/// Distance within which two places are one hand.
pub const ONE_HAND: f32 = 0.35;

/// The posterior of both hands.
#[derive(Debug, Clone)]
pub struct HandsBelief {
    positions: [[f32; 2]; MAX_PLACES],
    count: usize,
    /// Probability of each pair: the left hand's state, then the right hand's.
    pairs: [[f32; STATES]; STATES],
    has_begun: bool,
}

impl Default for HandsBelief {
    fn default() -> Self {
        Self {
            positions: [[0.0; 2]; MAX_PLACES],
            count: 0,
            pairs: [[0.0; STATES]; STATES],
            has_begun: false,
        }
    }
}

/// What is known of one hand.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct HandBelief {
    /// Index of the likeliest place.
    pub place: usize,
    /// Probability that the hand is at this place or another one within [`ONE_HAND`], 0 to 1.
    pub probability: f32,
}

impl HandsBelief {
    /// Takes the places of a frame with their evidence for the left and the right hand. Of more
    /// than [`MAX_PLACES`] the first ones count.
    pub fn step(&mut self, places: &[HandPlace], evidence: &[[Evidence; 2]]) {
        let count = places.len().min(evidence.len()).min(MAX_PLACES);
        let mut positions = [[0.0; 2]; MAX_PLACES];
        for (position, place) in positions.iter_mut().zip(&places[..count]) {
            *position = place.position;
        }
        let mut next = if self.has_begun { self.predicted(&positions, count) } else { [[1.0; STATES]; STATES] };
        let mut sum = 0.0;
        for (left, row) in next.iter_mut().enumerate() {
            for (right, pair) in row.iter_mut().enumerate() {
                let is_there = |state: usize| state < count || state == HIDDEN;
                let weight = if is_there(left) && is_there(right) { pair_weight(places, evidence, left, right) } else { 0.0 };
                *pair *= weight;
                sum += *pair;
            }
        }
        if !(sum > 0.0 && sum.is_finite()) {
            *self = Self::default();
            return;
        }
        next.iter_mut().flatten().for_each(|pair| *pair /= sum);
        *self = Self { positions, count, pairs: next, has_begun: true };
    }

    /// The pairs before the new frame's evidence: T' A T with the transition T of one hand.
    fn predicted(&self, positions: &[[f32; 2]; MAX_PLACES], count: usize) -> [[f32; STATES]; STATES] {
        let mut transition = [[0.0; STATES]; STATES];
        for (old, row) in transition.iter_mut().enumerate() {
            for (new, chance) in row.iter_mut().enumerate() {
                let is_new = new < count || new == HIDDEN;
                let is_old = old < self.count || old == HIDDEN;
                *chance = match (old == HIDDEN, new == HIDDEN) {
                    _ if !is_new || !is_old => 0.0,
                    (true, true) => 1.0,
                    (true, false) => APPEARING,
                    (false, true) => HIDING,
                    (false, false) => (1.0 - HIDING) * moved(self.positions[old], positions[new]),
                };
            }
        }
        let mut half = [[0.0; STATES]; STATES];
        for (left, row) in half.iter_mut().enumerate() {
            for (right, value) in row.iter_mut().enumerate() {
                *value = (0..STATES).map(|old| self.pairs[left][old] * transition[old][right]).sum();
            }
        }
        let mut pairs = [[0.0; STATES]; STATES];
        for (left, row) in pairs.iter_mut().enumerate() {
            for (right, value) in row.iter_mut().enumerate() {
                *value = (0..STATES).map(|old| transition[old][left] * half[old][right]).sum();
            }
        }
        pairs
    }

    /// What is known of the left and the right hand; `None` where no place is left.
    #[must_use]
    pub fn hands(&self) -> [Option<HandBelief>; 2] {
        let left: [f32; STATES] = core::array::from_fn(|state| self.pairs[state].iter().sum());
        let right: [f32; STATES] = core::array::from_fn(|state| self.pairs.iter().map(|row| row[state]).sum());
        [left, right].map(|marginal| self.hand(&marginal))
    }

    fn hand(&self, marginal: &[f32; STATES]) -> Option<HandBelief> {
        let near = |place: usize| {
            (0..self.count).filter(move |&other| distance2(self.positions[place], self.positions[other]) < ONE_HAND * ONE_HAND)
        };
        let mass = |place: usize| near(place).map(|other| marginal[other]).sum::<f32>();
        let better = |best: Option<(usize, f32)>, place: usize| {
            let mass = mass(place);
            let is_better = best.is_none_or(|(old, of_old)| {
                mass > of_old || (mass == of_old && marginal[place] > marginal[old])
            });
            if is_better { Some((place, mass)) } else { best }
        };
        let (best, probability) = (0..self.count).fold(None, better)?;
        let likeliest = near(best).fold(best, |old, other| if marginal[other] > marginal[old] { other } else { old });
        Some(HandBelief { place: likeliest, probability })
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
