//! What is remembered of the blobs: which were not the hand, and which have not moved for long.
//!
//! A face has nearly the likelihood of a hand, frame after frame. While the hand is seen at another
//! blob, a blob that stays where it is loses belief fast, and wins it back slowly. A blob that
//! rests is less likely a hand than one that moves. So a known face does not take the particles
//! when the hand is hidden or fast. A blob that is new, or that moved on, has full belief, so a
//! returning hand is not held back.

use super::frame::MAX_CANDIDATES;
use super::options::BlobMemoryOptions;
use crate::camera::Pixel;
use crate::math::{exp, max};
use crate::vision::candidate::HandCandidate;
use heapless::Vec;

/// A blob of the last frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Remembered {
    pub(super) centre: Pixel,
    /// How far it may still be the hand, in [floor, 1].
    pub(super) belief: f32,
    /// Where it was when it last moved.
    pub(super) anchor: Pixel,
    /// Time since it last moved, seconds.
    pub(super) still_s: f32,
    /// Whether it moved, or took the place of a hand that did; see `confirmation`.
    pub(super) is_confirmed: bool,
}

/// The blobs of the last frame.
#[derive(Debug, Clone, Default)]
pub(super) struct BlobMemory {
    pub(super) blobs: Vec<Remembered, MAX_CANDIDATES>,
}

impl BlobMemory {
    /// Of no blob.
    pub const fn empty() -> Self {
        Self { blobs: Vec::new() }
    }

    /// The remembered blob nearest to `centre` within `radius_px`.
    fn recall(&self, centre: Pixel, radius_px: f32) -> Option<&Remembered> {
        let mut best = (None, radius_px);
        for blob in &self.blobs {
            let distance = blob.centre.distance_px(centre);
            if distance < best.1 {
                best = (Some(blob), distance);
            }
        }
        best.0
    }

    /// Share of its likelihood that a blob at `centre` keeps: belief times activity; 1 for a blob
    /// that is new.
    pub fn share(&self, centre: Pixel, radius_px: f32, options: &BlobMemoryOptions) -> f32 {
        self.recall(centre, radius_px).map_or(1.0, |blob| {
            let activity = options.rest_share + (1.0 - options.rest_share) * exp(-blob.still_s / options.rest_time_s);
            blob.belief * activity
        })
    }

    /// Remembers this frame's blobs. `masses` are the shares of the particles' weights at each.
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    pub fn learn(
        &mut self,
        candidates: &[HandCandidate],
        masses: &[f32],
        radius_of_px: impl Fn(&HandCandidate) -> f32,
        dt_s: f32,
        options: &BlobMemoryOptions,
    ) {
        let elsewhere = |index: usize| {
            let others = masses.iter().take(candidates.len()).enumerate().filter(|(other, _)| *other != index);
            others.fold(0.0, |sum, (_, mass)| sum + mass)
        };
        let mut next = Vec::new();
        for (index, candidate) in candidates.iter().enumerate() {
            let centre = candidate.centre;
            let fresh = Remembered { centre, belief: 1.0, anchor: centre, still_s: 0.0, is_confirmed: false };
            let radius_px = radius_of_px(candidate);
            let before = self.recall(centre, radius_px).copied().unwrap_or(fresh);
            let away = elsewhere(index);
            let fallen = before.belief * exp(-dt_s * away / options.fall_time_s);
            let recovery = 1.0 - exp(-dt_s * (1.0 - away) / options.rise_time_s);
            let moved = before.anchor.distance_px(centre) > options.moved_per_radius * radius_px;
            // What moves may be the hand after all, also where the tracker sits on something that
            // rests.
            let belief = if moved { 1.0 } else { max(fallen + recovery * (1.0 - fallen), options.floor) };
            let (anchor, still_s) = if moved { (centre, 0.0) } else { (before.anchor, before.still_s + dt_s) };
            let is_confirmed = before.is_confirmed || moved;
            // One entry a candidate, of which there are not more than fit.
            let _ = next.push(Remembered { centre, belief, anchor, still_s, is_confirmed });
        }
        self.blobs = next;
    }
}

#[cfg(test)]
mod tests {
    use super::super::options::DEFAULT_BLOB_MEMORY as OPTIONS;
    use super::*;

    fn at(u_px: f32) -> HandCandidate {
        HandCandidate { centre: Pixel::new(u_px, 0.0), ..HandCandidate::default() }
    }

    fn learn(memory: &mut BlobMemory, places: [f32; 2], masses: [f32; 2], frames: u8) {
        for _ in 0..frames {
            memory.learn(&places.map(at), &masses, |_| 25.0, 0.1, &OPTIONS);
        }
    }

    #[test]
    fn a_resting_blob_that_is_not_the_hand_loses_belief_down_to_the_floor() {
        let mut memory = BlobMemory::default();
        for frame in 0..100_u8 {
            let places = [at(100.0), at(300.0 + 30.0 * f32::from(frame))];
            memory.learn(&places, &[0.0, 0.9], |_| 25.0, 0.1, &OPTIONS);
        }
        let face = memory.share(Pixel::new(103.0, 0.0), 25.0, &OPTIONS);
        assert!(face < 2.0 * OPTIONS.floor, "{face}");
        assert_eq!(memory.share(Pixel::new(200.0, 0.0), 25.0, &OPTIONS), 1.0);
    }

    #[test]
    fn belief_falls_fast_and_comes_back_slowly() {
        let mut memory = BlobMemory::default();
        learn(&mut memory, [100.0, 300.0], [0.0, 1.0], 5);
        let low = memory.share(Pixel::new(100.0, 0.0), 25.0, &OPTIONS);
        learn(&mut memory, [100.0, 900.0], [0.0, 0.0], 5);
        let later = memory.share(Pixel::new(100.0, 0.0), 25.0, &OPTIONS);
        assert!(low < 0.15 && later < 0.4, "{low} {later}");
    }

    #[test]
    fn a_moving_blob_keeps_its_share_and_a_resting_hand_most_of_its_belief() {
        let mut memory = BlobMemory::default();
        for frame in 0..50_u8 {
            let places = [at(100.0), at(200.0 + 10.0 * f32::from(frame))];
            memory.learn(&places, &[1.0, 0.0], |_| 25.0, 0.1, &OPTIONS);
        }
        assert!(memory.share(Pixel::new(100.0, 0.0), 25.0, &OPTIONS) >= OPTIONS.rest_share);
        assert!(memory.share(Pixel::new(690.0, 0.0), 25.0, &OPTIONS) > 0.9);
    }
}
