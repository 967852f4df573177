//! Whether the blob that carries the estimate is confirmed by motion.
//!
//! A face, or wood, has the colour and the shape of a hand. Without a face box only motion tells a
//! hand from them. So a track is tentative, and its status uncertain, until its blob has moved:
//! confirmation of tracks, as in Blackman and Popoli, "Design and analysis of modern tracking
//! systems", 1999. A blob that rests while another one of nearly its likelihood moves is uncertain,
//! too.

use super::memory::BlobMemory;
use crate::camera::Pixel;
use crate::vision::candidate::HandCandidate;

/// A new blob within so many cluster radii of a confirmed hand is this hand. Chosen on seeds 100 to
/// 260 of `sinew demo`: with 2 to 4 the share of wrong frames is the same, and 4 leaves fewer right
/// ones uncertain.
const SAME_HAND_RADII: f32 = 4.0;
/// Another blob is a rival from this share of the likelihood on. Chosen: 0.2 to 0.8 give the same.
const RIVAL_SHARE: f32 = 0.5;
/// A rival is livelier if it moved so much later, seconds. Chosen: 0 to 0.5 give nearly the same.
const LIVELIER_S: f32 = 0.2;
/// A blob that rests so long and has no rival is the hand, seconds. Chosen: the time in which a
/// blob wins back its belief (`rise_time_s`).
const ALONE_S: f32 = 2.0;

impl BlobMemory {
    /// Confirms the blob at index `carrier` of this frame's `candidates`: if it moved, if it is new
    /// where the hand was, or if it is alone. `before` is where the hand was, and whether its blob
    /// was confirmed; none before the first one. Whether the blob is confirmed, and whether no
    /// rival is livelier either. To be called after [`learn`](Self::learn), with its `dt_s`.
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    pub fn confirm(
        &mut self,
        carrier: usize,
        candidates: &[HandCandidate],
        before: Option<(Pixel, bool)>,
        radius_px: f32,
        dt_s: f32,
    ) -> [bool; 2] {
        let (Some(&blob), Some(own)) = (self.blobs.get(carrier), candidates.get(carrier)) else { return [false; 2] };
        let (mut has_rival, mut is_livelier) = (false, false);
        for (index, (other, candidate)) in self.blobs.iter().zip(candidates).enumerate() {
            if index != carrier && candidate.likelihood >= RIVAL_SHARE * own.likelihood {
                has_rival = true;
                is_livelier |= other.is_confirmed && other.still_s + LIVELIER_S < blob.still_s;
            }
        }
        // One that never moved has rested for a frame more in each frame.
        let is_new = blob.still_s <= dt_s;
        let is_hand = match before {
            Some((hand, was_confirmed)) if is_new => {
                was_confirmed && hand.distance_px(blob.centre) <= SAME_HAND_RADII * radius_px
            }
            Some(_) => !has_rival && blob.still_s > ALONE_S,
            None => !has_rival,
        };
        let is_confirmed = blob.is_confirmed || is_hand;
        if let Some(blob) = self.blobs.get_mut(carrier) {
            blob.is_confirmed = is_confirmed;
        }
        [is_confirmed, is_confirmed && !is_livelier]
    }
}

#[cfg(test)]
mod tests {
    use super::super::options::DEFAULT_BLOB_MEMORY as OPTIONS;
    use super::*;

    const RADIUS_PX: f32 = 25.0;
    const DT_S: f32 = 0.07;

    fn at(u_px: f32) -> HandCandidate {
        HandCandidate { centre: Pixel::new(u_px, 0.0), likelihood: 0.9, ..HandCandidate::default() }
    }

    /// Frames in which the first of the blobs carries the estimate; whether the last one is sure.
    fn show(memory: &mut BlobMemory, before: &mut Option<(Pixel, bool)>, frames: &[&[f32]]) -> bool {
        let mut is_sure = false;
        for places in frames {
            let candidates: Vec<_> = places.iter().map(|u_px| at(*u_px)).collect();
            memory.learn(&candidates, &[1.0], |_| RADIUS_PX, DT_S, &OPTIONS);
            let is_confirmed;
            [is_confirmed, is_sure] = memory.confirm(0, &candidates, *before, RADIUS_PX, DT_S);
            *before = candidates.first().map(|candidate| (candidate.centre, is_confirmed));
        }
        is_sure
    }

    #[test]
    fn the_first_blob_is_the_hand_where_it_is_alone_and_else_once_it_moved() {
        assert!(show(&mut BlobMemory::default(), &mut None, &[&[100.0]]));
        let (mut memory, mut before) = (BlobMemory::default(), None);
        assert!(!show(&mut memory, &mut before, &[&[100.0, 400.0], &[103.0, 400.0], &[101.0, 400.0]]));
        assert!(show(&mut memory, &mut before, &[&[110.0, 400.0]]), "it moved");
    }

    #[test]
    fn what_appears_far_from_the_hand_is_tentative_and_near_it_is_the_hand() {
        let (mut memory, mut before) = (BlobMemory::default(), None);
        assert!(show(&mut memory, &mut before, &[&[100.0], &[110.0], &[180.0]]), "a fast hand");
        assert!(!show(&mut memory, &mut before, &[&[400.0], &[400.0], &[401.0]]), "a face that appears");
        assert!(show(&mut memory.clone(), &mut before, &[&[410.0]]), "it moved");
        let rests: [&[f32]; 20] = [&[400.0]; 20];
        assert!(!show(&mut memory, &mut before, &rests), "one second and a half");
        assert!(show(&mut memory, &mut before, &rests), "nothing else is there");
    }

    #[test]
    fn a_blob_that_rests_while_a_rival_moves_is_not_sure() {
        let (mut memory, mut before) = (BlobMemory::default(), None);
        assert!(show(&mut memory, &mut before, &[&[100.0], &[110.0], &[120.0]]));
        let rival: Vec<[f32; 2]> = (0..6_u8).map(|i| [120.0, 400.0 + 10.0 * f32::from(i)]).collect();
        let frames: Vec<&[f32]> = rival.iter().map(<[f32; 2]>::as_slice).collect();
        assert!(show(&mut memory, &mut before, &frames[..2]), "just now it moved");
        assert!(!show(&mut memory, &mut before, &frames[2..]));
        assert!(show(&mut memory, &mut before, &[&[120.0]]), "alone it is the hand that it was");
    }
}
