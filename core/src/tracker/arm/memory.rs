//! Which blobs were there before and were not the hand.
//!
//! A face has nearly the likelihood of a hand, frame after frame. While the hand is seen elsewhere, a blob that stays
//! where it is loses belief; when the hand is hidden or fast, that blob no longer takes its particles. A blob that is new, or that
//! moved on, has full belief again, so a returning hand is not held back.

use super::frame::MAX_CANDIDATES;
use crate::camera::Pixel;
use crate::math::{exp, max};
use crate::observation::candidate::HandCandidate;
use heapless::Vec;

/// A blob of the last frame and how far it may still be the hand.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Remembered {
    centre: Pixel,
    belief: f32,
}

/// Beliefs in the blobs of the last frame, in [floor, 1].
#[derive(Debug, Clone, Default)]
pub(super) struct BlobMemory {
    blobs: Vec<Remembered, MAX_CANDIDATES>,
}

impl BlobMemory {
    /// Belief in a blob at `centre`: that of the remembered blob nearest to it within `radius_px`, or 1.
    pub fn belief(&self, centre: Pixel, radius_px: f32) -> f32 {
        let mut best = (1.0, radius_px);
        for blob in &self.blobs {
            let distance = blob.centre.distance_px(centre);
            if distance < best.1 {
                best = (blob.belief, distance);
            }
        }
        best.0
    }

    /// Remembers this frame's blobs: each belief moves towards the posterior mass of the particles at the blob, within
    /// about `time_s`, and not below `floor`. Without a hand at any blob nothing is learned.
    pub fn learn(
        &mut self,
        candidates: &[HandCandidate],
        masses: &[f32],
        radius_px: f32,
        (dt_s, time_s, floor): (f32, f32, f32),
    ) {
        let keep = exp(-dt_s / time_s);
        let greatest = masses.iter().take(candidates.len()).fold(0.0, |a, &b| max(a, b));
        let mut next = Vec::new();
        for (candidate, &mass) in candidates.iter().zip(masses) {
            let before = self.belief(candidate.centre, radius_px);
            let target = if greatest > 0.0 { mass / greatest } else { before };
            let belief = max(keep * before + (1.0 - keep) * target, floor);
            // One entry a candidate, of which there are not more than fit.
            let _ = next.push(Remembered { centre: candidate.centre, belief });
        }
        self.blobs = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIMES: (f32, f32, f32) = (0.1, 0.4, 0.05);

    fn at(u_px: f32) -> HandCandidate {
        HandCandidate { centre: Pixel::new(u_px, 0.0), ..HandCandidate::default() }
    }

    #[test]
    fn a_resting_blob_that_is_not_the_hand_loses_belief_down_to_the_floor() {
        let mut memory = BlobMemory::default();
        for frame in 0..100_u8 {
            memory.learn(&[at(100.0), at(300.0 + 30.0 * f32::from(frame))], &[0.0, 0.9], 25.0, TIMES);
        }
        assert!((memory.belief(Pixel::new(103.0, 0.0), 25.0) - 0.05).abs() < 1.0e-6);
        assert_eq!(memory.belief(Pixel::new(200.0, 0.0), 25.0), 1.0);
    }

    #[test]
    fn the_hand_s_own_blob_keeps_its_belief_and_a_moving_blob_is_new() {
        let mut memory = BlobMemory::default();
        for frame in 0..50_u8 {
            memory.learn(&[at(100.0), at(200.0 + 30.0 * f32::from(frame))], &[0.9, 0.0], 25.0, TIMES);
        }
        assert_eq!(memory.belief(Pixel::new(100.0, 0.0), 25.0), 1.0);
        assert!(memory.belief(Pixel::new(200.0 + 30.0 * 49.0, 0.0), 25.0) > 0.7);
    }

    #[test]
    fn without_a_hand_nothing_is_learned() {
        let mut memory = BlobMemory::default();
        memory.learn(&[at(100.0)], &[0.0], 25.0, TIMES);
        assert_eq!(memory.belief(Pixel::new(100.0, 0.0), 25.0), 1.0);
    }
}
