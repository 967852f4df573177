//! What goes into a step.

use crate::math::{Vec3, abs};
use crate::ranges::{MAX_PX, is_pixel};
use crate::vision::candidate::HandCandidate;
use crate::vision::edges::EdgePixel;
use heapless::Vec;

/// Most blobs that a step considers.
pub const MAX_CANDIDATES: usize = 8;

/// A blob less likely than this is no hand: a speck of noise must not carry an estimate.
/// Chosen: specks lie below it, hands far above.
pub const MIN_LIKELIHOOD: f32 = 0.05;

/// What was found in one image.
///
/// ```
/// use sinew_core::tracker::arm::example::{SHOULDERS_M, hand_blob, left_arm};
/// use sinew_core::tracker::arm::{ArmFrame, ArmImage, ArmTracker, MAX_CANDIDATES};
///
/// let (model, hand, shoulder_m) = (left_arm()?, hand_blob(), SHOULDERS_M[0]);
/// // More blobs than a step considers: the most likely are kept, the others counted.
/// let candidates = [hand; MAX_CANDIDATES + 2];
/// let image = ArmImage { candidates: &candidates, edges: &[] };
/// let mut tracker = ArmTracker::<50>::new(&model, shoulder_m, 1)?;
/// let estimate = tracker.step(&model, &ArmFrame { timestamp_us: 0, image: Some(image), shoulder_m });
/// assert_eq!(estimate.dropped_candidates, 2);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, Default)]
pub struct ArmImage<'a> {
    /// Blobs that may be a hand; over [`MAX_CANDIDATES`] the most likely are kept.
    pub candidates: &'a [HandCandidate],
    /// Temporal edge pixels.
    pub edges: &'a [EdgePixel],
}

/// One frame of one arm.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::tracker::arm::example::{SHOULDERS_M, hand_blob, left_arm};
/// use sinew_core::tracker::arm::{ArmFrame, ArmImage, ArmTracker};
///
/// let (model, hand, shoulder_m) = (left_arm()?, hand_blob(), SHOULDERS_M[0]);
/// // Frames of a camera that drops every other one: what is dropped is not given, the timestamp shows it.
/// let mut tracker = ArmTracker::<50>::new(&model, shoulder_m, 1)?;
/// for frame in 0..10 {
///     let image = Some(ArmImage { candidates: &[hand], edges: &[] });
///     let estimate = tracker.step(&model, &ArmFrame { timestamp_us: frame * 133_333, image, shoulder_m });
///     let seen = model.camera().project(&estimate.joints.hand_m).expect("in front of the camera");
///     assert!(seen.distance_px(hand.centre) < 25.0);
/// }
/// // The shoulder belongs to each frame: the arm moves along with the person.
/// let shoulder_m = shoulder_m + Vec3::new(0.05, 0.0, 0.0);
/// let estimate = tracker.step(&model, &ArmFrame { timestamp_us: 1_333_330, image: None, shoulder_m });
/// assert_eq!(estimate.joints.shoulder_m, shoulder_m);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct ArmFrame<'a> {
    /// When the frame was taken, microseconds since any start. Dropped frames are simply not given.
    pub timestamp_us: u64,
    /// What the image showed; `None` where the image is missing.
    pub image: Option<ArmImage<'a>>,
    /// Where the shoulder is, metres in camera axes. One that is
    /// [no place](crate::ranges::is_place) counts as missing: the shoulder stays where it was.
    pub shoulder_m: Vec3,
}

/// The most likely candidates, in descending order of likelihood, and the count of those that found
/// no room.
///
/// Candidates whose numbers are out of range ([`crate::ranges`]), or that are less likely than
/// [`MIN_LIKELIHOOD`], are dropped as well.
#[must_use]
pub fn most_likely(candidates: &[HandCandidate]) -> (Vec<HandCandidate, MAX_CANDIDATES>, usize) {
    let mut kept: Vec<HandCandidate, MAX_CANDIDATES> = Vec::new();
    for candidate in candidates {
        let usable = is_pixel(candidate.centre.u_px)
            && is_pixel(candidate.centre.v_px)
            && candidate.area_px > 0.0
            && candidate.area_px <= MAX_PX * MAX_PX
            && candidate.moments_px2.iter().all(|moment| abs(*moment) <= MAX_PX * MAX_PX)
            && candidate.likelihood >= MIN_LIKELIHOOD
            && candidate.likelihood <= 1.0;
        if !usable {
            continue;
        }
        if kept.is_full() {
            if kept.last().is_some_and(|last| last.likelihood >= candidate.likelihood) {
                continue;
            }
            kept.pop();
        }
        // There is room now, so this cannot fail.
        let _ = kept.push(*candidate);
        let mut len = kept.len();
        while let Some([.., before, this]) = kept.get_mut(..len)
            && before.likelihood < candidate.likelihood
        {
            core::mem::swap(before, this);
            len -= 1;
        }
    }
    let dropped = candidates.len() - kept.len();
    (kept, dropped)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn over_capacity_the_most_likely_are_kept_in_order() {
        let list: std::vec::Vec<_> = (0..20_u8)
            .map(|i| HandCandidate {
                area_px: 500.0,
                likelihood: f32::from((i * 7) % 20 + 1) / 20.0,
                ..HandCandidate::default()
            })
            .collect();
        let (kept, dropped) = most_likely(&list);
        let likelihoods: std::vec::Vec<_> = kept.iter().map(|c| (c.likelihood * 20.0).round() as u8).collect();
        assert_eq!(likelihoods, [20, 19, 18, 17, 16, 15, 14, 13]);
        assert_eq!(dropped, 12);
    }

    #[test]
    fn a_candidate_that_is_not_a_number_is_dropped() {
        let whole = HandCandidate { area_px: 9.0, likelihood: 0.5, ..HandCandidate::default() };
        let no_area = HandCandidate { area_px: f32::NAN, ..whole };
        let no_moments = HandCandidate { moments_px2: [1.0, f32::INFINITY, 1.0], ..whole };
        let (kept, dropped) = most_likely(&[no_area, no_moments, whole]);
        assert_eq!((kept.len(), dropped), (1, 2));
    }
}
