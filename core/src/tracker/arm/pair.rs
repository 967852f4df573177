//! Two arms that share one list of blobs: a blob serves one hand, unless hands touch. Beyond the
//! arm paper, which tracks one arm.
//!
//! ```
//! use sinew_core::camera::{Camera, Pixel};
//! use sinew_core::math::Vec3;
//! use sinew_core::vision::candidate::HandCandidate;
//! use sinew_core::skeleton::{ArmGeometry, Side};
//! use sinew_core::tracker::arm::{ArmImage, ArmModel, ArmOptions, ArmPair, PairFrame, Status};
//!
//! let camera = Camera::from_field_of_view(640, 480, 1.05)?;
//! let model = |side| {
//!     ArmGeometry::new(side, 0.30, 0.35).and_then(|arm| ArmModel::new(camera, (640, 480), arm, ArmOptions::default()))
//! };
//! let (left, right) = (model(Side::Left)?, model(Side::Right)?);
//! let shoulders_m = [Vec3::new(0.2, -0.1, 1.2), Vec3::new(-0.2, -0.1, 1.2)];
//! let mut pair = ArmPair::<50>::new([&left, &right], shoulders_m, 1)?;
//!
//! // Two hands in one list; a person who faces the camera has the left one on the right of the picture.
//! let hand = |u_px| HandCandidate {
//!     centre: Pixel::new(u_px, 260.0),
//!     moments_px2: [400.0, 0.0, 400.0],
//!     area_px: 4700.0,
//!     likelihood: 0.8,
//! };
//! let candidates = [hand(230.0), hand(410.0)];
//! for frame in 0..15 {
//!     let image = Some(ArmImage { candidates: &candidates, edges: &[] });
//!     let estimates = pair.step([&left, &right], &PairFrame { timestamp_us: frame * 66_667, image, shoulders_m });
//!     for (estimate, u_px) in estimates.iter().zip([410.0, 230.0]) {
//!         assert_eq!(estimate.status, Status::Tracking);
//!         let seen = camera.project(&estimate.joints.hand_m).expect("in front of the camera");
//!         assert!((seen.u_px - u_px).abs() < 30.0);
//!     }
//! }
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

use super::estimate::ArmEstimate;
use super::frame::{ArmFrame, ArmImage, MAX_CANDIDATES, most_likely};
use super::model::ArmModel;
use super::state::ArmTracker;
use crate::camera::Pixel;
use crate::error::ParameterError;
use crate::math::{Vec3, abs, atan2, exp, ln, max, min, sin_cos, sqrt};
use crate::vision::candidate::HandCandidate;
use heapless::Vec;

/// What a hand without any blob is as likely as; compared with a blob's odds times its nearness.
/// Chosen: a blob of likelihood 0.1 at the prediction is about as likely.
const NO_BLOB: f32 = 0.1;
/// ln of how likely hands are crossed over how likely they are not: odds of 1 to 20. Chosen: in
/// seven recorded motions they are in 1 % of the frames; who folds the arms crosses them longer.
const LOG_CROSSED_ODDS: f32 = -3.0;
/// What a blob at any distance from the prediction keeps of its nearness.
/// Chosen: small, but a hand that jumps is not excluded.
const FAR_FLOOR: f32 = 0.05;
/// No blob is more surely a hand than this when the sides are shared out.
/// Chosen: bounds the odds to 19.
const MAX_LIKELIHOOD: f32 = 0.95;
/// Share of its likelihood that a blob keeps for a side that has a likelier one of its own.
/// Chosen: such a blob remains a second choice.
const STRAY_SHARE: f32 = 0.25;
/// Least standard deviation of where a hand is expected, metres: hands start and stop.
/// Chosen: a floor for the prediction's spread.
const MIN_STD_M: f32 = 0.15;
/// A blob is split where both predictions lie within this many of its standard deviations.
/// Chosen: 99 % of the blob's pixels.
const SPLIT_REACH: f32 = 3.0;

/// One frame of both arms.
///
/// ```
/// use sinew_core::tracker::arm::example::{SHOULDERS_M, hand_blob, left_arm, right_arm};
/// use sinew_core::tracker::arm::{ArmImage, ArmPair, PairFrame, Status};
///
/// let (model, right, hand, shoulders_m) = (left_arm()?, right_arm()?, hand_blob(), SHOULDERS_M);
/// // One list of blobs for both arms; this one holds the left hand only.
/// let mut pair = ArmPair::<50>::new([&model, &right], shoulders_m, 1)?;
/// let mut statuses = [Status::Lost; 2];
/// for frame in 0..5 {
///     let image = Some(ArmImage { candidates: &[hand], edges: &[] });
///     let frame = PairFrame { timestamp_us: frame * 66_667, image, shoulders_m };
///     statuses = pair.step([&model, &right], &frame).map(|estimate| estimate.status);
/// }
/// assert_eq!(statuses, [Status::Tracking, Status::Lost], "one blob serves one hand");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct PairFrame<'a> {
    /// When the frame was taken, microseconds since any start.
    pub timestamp_us: u64,
    /// What the image showed; `None` where the image is missing.
    pub image: Option<ArmImage<'a>>,
    /// Left and right shoulder, metres in camera axes; see [`ArmFrame::shoulder_m`].
    pub shoulders_m: [Vec3; 2],
}

/// State of both arms' trackers, left and right.
///
/// ```
/// use sinew_core::camera::Pixel;
/// use sinew_core::tracker::arm::example::{SHOULDERS_M, hand_blob, left_arm, right_arm};
/// use sinew_core::tracker::arm::{ArmImage, ArmPair, PairFrame};
/// use sinew_core::vision::candidate::HandCandidate;
///
/// let (model, right, hand, shoulders_m) = (left_arm()?, right_arm()?, hand_blob(), SHOULDERS_M);
/// let models = [&model, &right];
/// // Two hands, the right one on the left of the picture; each side finds its own.
/// let mut pair = ArmPair::<50>::new(models, shoulders_m, 1)?;
/// let candidates = [HandCandidate { centre: Pixel::new(240.0, 250.0), ..hand }, hand];
/// let image = Some(ArmImage { candidates: &candidates, edges: &[] });
/// let mut carriers = [None; 2];
/// for frame in 0..5 {
///     let estimates = pair.step(models, &PairFrame { timestamp_us: frame * 66_667, image, shoulders_m });
///     carriers = estimates.map(|estimate| estimate.candidate);
/// }
/// assert_eq!(carriers, [Some(1), Some(0)]);
/// assert!(pair.trackers().iter().all(|tracker| tracker.has_seen_the_hand()));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
pub struct ArmPair<const CAPACITY: usize> {
    pub(super) trackers: [ArmTracker<CAPACITY>; 2],
}

/// Blobs of one side: its own first.
type SideCandidates = Vec<HandCandidate, MAX_CANDIDATES>;

/// Where a side expects its hand in the image.
#[derive(Debug, Clone, Copy)]
struct Expected {
    hand: Pixel,
    std_px: f32,
}

impl<const CAPACITY: usize> ArmPair<CAPACITY> {
    /// Trackers of a left and a right arm that have seen nothing yet. `models` and `shoulders_m`
    /// are left, right.
    ///
    /// # Errors
    /// As [`ArmTracker::new`].
    pub fn new(models: [&ArmModel; 2], shoulders_m: [Vec3; 2], seed: u64) -> Result<Self, ParameterError> {
        let mut pair = Self::empty();
        pair.begin(models, shoulders_m, seed)?;
        Ok(pair)
    }

    /// Trackers without particles, so that those in static memory can begin there; see
    /// [`ArmTracker::empty`].
    #[must_use]
    pub const fn empty() -> Self {
        Self { trackers: [ArmTracker::empty(), ArmTracker::empty()] }
    }

    /// Begins, or begins anew, in place: what [`Self::new`] gives.
    ///
    /// # Errors
    /// Those of [`Self::new`]; the trackers mean nothing then.
    pub fn begin(&mut self, models: [&ArmModel; 2], shoulders_m: [Vec3; 2], seed: u64) -> Result<(), ParameterError> {
        // Two sides with one seed would draw the same numbers.
        let other = seed ^ 0x5DEE_CE66_D153_2701;
        let ([left, right], [left_model, right_model]) = (&mut self.trackers, models);
        let [left_shoulder_m, right_shoulder_m] = shoulders_m;
        left.begin(left_model, left_shoulder_m, seed)?;
        right.begin(right_model, right_shoulder_m, other)
    }

    /// The trackers, left and right.
    #[must_use]
    pub fn trackers(&self) -> &[ArmTracker<CAPACITY>; 2] {
        &self.trackers
    }

    /// Answers one frame for both arms, left and right.
    pub fn step(&mut self, models: [&ArmModel; 2], frame: &PairFrame<'_>) -> [ArmEstimate; 2] {
        let image = frame.image.unwrap_or_default();
        let (candidates, dropped) = most_likely(image.candidates);
        let [left, right] = &mut self.trackers;
        let [left_model, right_model] = models;
        let expected = [(&*left, left_model), (&*right, right_model)]
            .map(|(tracker, model)| expected(tracker, model, frame.timestamp_us));
        let shoulders = [left_model, right_model].map(ArmModel::camera);
        let shoulders = [0, 1].map(|side| shoulders[side].project(&frame.shoulders_m[side]));
        let lists = share_out(&candidates, &expected, &shoulders);
        let image = (frame, image.candidates, dropped);
        let ([of_left, of_right], [left_m, right_m]) = (&lists, frame.shoulders_m);
        [answer(left, left_model, of_left, image, left_m), answer(right, right_model, of_right, image, right_m)]
    }
}

impl<const CAPACITY: usize> ArmPair<CAPACITY> {
    /// Answers one frame for both arms of which each has candidates of its own, as
    /// [`HandFinder`](crate::vision::objects::hands::HandFinder) finds them: left and right.
    pub fn step_each(&mut self, models: [&ArmModel; 2], frames: [&ArmFrame<'_>; 2]) -> [ArmEstimate; 2] {
        let ([left, right], [left_model, right_model], [of_left, of_right]) = (&mut self.trackers, models, frames);
        [left.step(left_model, of_left), right.step(right_model, of_right)]
    }
}

/// One side's answer by its `list` of the candidates that the frame has; how many were dropped.
#[inline(never)]
fn answer<const CAPACITY: usize>(
    tracker: &mut ArmTracker<CAPACITY>,
    model: &ArmModel,
    list: &SideCandidates,
    (frame, candidates, dropped): (&PairFrame<'_>, &[HandCandidate], usize),
    shoulder_m: Vec3,
) -> ArmEstimate {
    let arm_frame = ArmFrame {
        timestamp_us: frame.timestamp_us,
        image: frame.image.map(|image| ArmImage { candidates: list, edges: image.edges }),
        shoulder_m,
    };
    let mut estimate = tracker.step(model, &arm_frame);
    let carrier = estimate.candidate.and_then(|index| list.get(index));
    estimate.candidate = carrier.and_then(|carrier| nearest_index(candidates, carrier.centre));
    estimate.dropped_candidates = dropped;
    estimate
}

/// Where a side expects its hand.
fn expected<const CAPACITY: usize>(
    tracker: &ArmTracker<CAPACITY>,
    model: &ArmModel,
    timestamp_us: u64,
) -> Option<Expected> {
    let (hand_m, std_m) = tracker.predicted_hand(model, timestamp_us);
    let hand = model.camera().project(&hand_m)?;
    let std_px = max(std_m, MIN_STD_M) * model.camera().focal_px() / max(hand_m.z, 0.1);
    Some(Expected { hand, std_px })
}

/// Index of the candidate whose centre is nearest to `centre`.
fn nearest_index(candidates: &[HandCandidate], centre: Pixel) -> Option<usize> {
    let mut best = (None, f32::INFINITY);
    for (index, candidate) in candidates.iter().enumerate() {
        let distance = candidate.centre.distance_px(centre);
        if distance < best.1 {
            best = (Some(index), distance);
        }
    }
    best.0
}

/// ln of odds times nearness; a side without expectation finds every place alike.
///
/// Odds, since a blob that is given to no hand has to be explained as something else, with
/// probability 1 - likelihood.
fn log_fit(candidate: &HandCandidate, expected: Option<&Expected>) -> f32 {
    let nearness = expected.map_or(1.0, |e| {
        let miss = candidate.centre.distance_px(e.hand) / e.std_px;
        exp(-0.5 * miss * miss) + FAR_FLOOR
    });
    let likelihood = min(candidate.likelihood, MAX_LIKELIHOOD);
    ln(likelihood / (1.0 - likelihood) * nearness)
}

/// ln of how likely hands at two places are the left and the right one, and not the other way
/// round. Where continuity does not decide, as after a hand was hidden, hands are not crossed.
fn log_side(hands: [Pixel; 2], shoulders: &[Option<Pixel>; 2]) -> f32 {
    let [Some(left), Some(right)] = shoulders else { return 0.0 };
    let across_px2 = (hands[0].u_px - hands[1].u_px) * (left.u_px - right.u_px)
        + (hands[0].v_px - hands[1].v_px) * (left.v_px - right.v_px);
    if across_px2 < 0.0 { LOG_CROSSED_ODDS } else { 0.0 }
}

/// Gives each side its blob of the likeliest pair, and to both the blobs of neither.
#[inline(never)]
fn share_out(
    candidates: &[HandCandidate],
    expected: &[Option<Expected>; 2],
    shoulders: &[Option<Pixel>; 2],
) -> [SideCandidates; 2] {
    let blob = |index: usize| candidates.get(index);
    let fit = |expected: &Option<Expected>, choice: Option<usize>| {
        choice.and_then(blob).map_or(ln(NO_BLOB), |candidate| log_fit(candidate, expected.as_ref()))
    };
    let [expected_left, expected_right] = expected;
    let choices = || core::iter::once(None).chain((0..candidates.len()).map(Some));
    let mut best = ([None, None], f32::NEG_INFINITY);
    for left in choices() {
        for right in choices() {
            let mut both = fit(expected_left, left) + fit(expected_right, right);
            if let (Some(left), Some(right)) = (left.and_then(blob), right.and_then(blob)) {
                both += log_side([left.centre, right.centre], shoulders);
            }
            if (left.is_none() || left != right) && both > best.1 {
                best = ([left, right], both);
            }
        }
    }
    let [left, right] = best.0;
    let mut lists = [own_and_free(candidates, left, right), own_and_free(candidates, right, left)];
    if let Some((index, halves)) = touching(candidates, expected, &best.0) {
        lists = halves.map(|half| {
            let mut list = own_and_free(candidates, Some(index), None);
            if !list.is_empty() {
                list.swap_remove(0);
            }
            if list.is_full() {
                list.pop();
            }
            let _ = list.push(half);
            list
        });
    }
    lists
}

/// A side's own blob and those that the other side does not have.
fn own_and_free(candidates: &[HandCandidate], own: Option<usize>, others: Option<usize>) -> SideCandidates {
    let free = (0..candidates.len()).filter(|&index| Some(index) != own && Some(index) != others);
    let share = if own.is_some() { STRAY_SHARE } else { 1.0 };
    let stray = free.filter_map(|index| candidates.get(index));
    let stray = stray.map(|blob| HandCandidate { likelihood: share * blob.likelihood, ..*blob });
    let mut list = SideCandidates::new();
    for blob in own.and_then(|index| candidates.get(index).copied()).into_iter().chain(stray) {
        // No more than the candidates, which fit.
        let _ = list.push(blob);
    }
    list
}

/// The blob in which both hands lie, and its halves for left and right. One side has it, the other
/// has none, and both expect their hand inside.
fn touching(
    candidates: &[HandCandidate],
    expected: &[Option<Expected>; 2],
    chosen: &[Option<usize>; 2],
) -> Option<(usize, [HandCandidate; 2])> {
    let index = match chosen {
        [Some(index), None] | [None, Some(index)] => *index,
        _ => return None,
    };
    let (blob, [Some(left), Some(right)]) = (candidates.get(index)?, expected) else { return None };
    let [uu, uv, vv] = blob.moments_px2;
    let direction_rad = 0.5 * atan2(2.0 * uv, uu - vv);
    let (s, c) = sin_cos(direction_rad);
    let half_sum = 0.5 * (uu + vv);
    let half_difference = sqrt(0.25 * (uu - vv) * (uu - vv) + uv * uv);
    let (long_std, short_std) = (sqrt(half_sum + half_difference), sqrt(max(half_sum - half_difference, 0.25)));
    let inside = |e: &Expected| {
        let (du, dv) = (e.hand.u_px - blob.centre.u_px, e.hand.v_px - blob.centre.v_px);
        let (along, across) = ((du * c + dv * s) / long_std, (dv * c - du * s) / short_std);
        (along * along + across * across <= SPLIT_REACH * SPLIT_REACH).then_some(along)
    };
    let (left_along, right_along) = (inside(left)?, inside(right)?);
    // Two means of a long blob lie sqrt(3)/2 standard deviations on either side of its centre.
    let offset = 0.866 * long_std;
    let sign = if left_along >= right_along { 1.0 } else { -1.0 };
    if abs(left_along - right_along) < 0.2 || long_std < 1.3 * short_std {
        return None;
    }
    let half = |sign: f32| HandCandidate {
        centre: Pixel::new(blob.centre.u_px + sign * offset * c, blob.centre.v_px + sign * offset * s),
        moments_px2: blob.moments_px2.map(|moment| 0.25 * moment),
        area_px: 0.5 * blob.area_px,
        likelihood: blob.likelihood,
    };
    Some((index, [half(sign), half(-sign)]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blob(u_px: f32, v_px: f32, likelihood: f32) -> HandCandidate {
        let moments_px2 = [400.0, 0.0, 400.0];
        HandCandidate { centre: Pixel::new(u_px, v_px), moments_px2, area_px: 4000.0, likelihood }
    }

    /// Shoulders of somebody who faces the camera.
    const FACING: [Option<Pixel>; 2] = [Some(Pixel::new(260.0, 50.0)), Some(Pixel::new(140.0, 50.0))];

    fn expect(u_px: f32, v_px: f32) -> Option<Expected> {
        Some(Expected { hand: Pixel::new(u_px, v_px), std_px: 40.0 })
    }

    #[test]
    fn a_blob_serves_one_hand_and_stray_blobs_serve_both() {
        let blobs = [blob(100.0, 100.0, 0.8), blob(300.0, 100.0, 0.8), blob(200.0, 300.0, 0.1)];
        let [left, right] = share_out(&blobs, &[expect(290.0, 110.0), expect(110.0, 90.0)], &FACING);
        let stray = HandCandidate { likelihood: STRAY_SHARE * 0.1, ..blobs[2] };
        assert_eq!(left.as_slice(), &[blobs[1], stray]);
        assert_eq!(right.as_slice(), &[blobs[0], stray]);
    }

    #[test]
    fn hands_are_crossed_only_where_continuity_says_so() {
        let blobs = [blob(100.0, 100.0, 0.8), blob(300.0, 100.0, 0.8)];
        let own = |expected: &[Option<Expected>; 2]| share_out(&blobs, expected, &FACING).map(|list| list[0]);
        assert_eq!(own(&[expect(110.0, 100.0), expect(290.0, 100.0)]), blobs, "crossed hands stay crossed");
        // Both were last seen in the middle.
        let middle = [expect(190.0, 100.0), expect(210.0, 100.0)];
        assert_eq!(own(&middle), [blobs[1], blobs[0]]);
        let unknown = share_out(&blobs, &middle, &[None, None]).map(|list| list[0]);
        assert_eq!(unknown, blobs, "without shoulders the nearer ones are taken");
    }

    #[test]
    fn a_single_blob_goes_to_the_nearer_hand() {
        let blobs = [blob(100.0, 100.0, 0.8)];
        let [left, right] = share_out(&blobs, &[expect(400.0, 100.0), expect(120.0, 100.0)], &FACING);
        assert!(left.is_empty());
        assert_eq!(right.as_slice(), &blobs);
    }

    #[test]
    fn hands_that_touch_share_a_wide_blob_by_halves() {
        let mut wide = blob(200.0, 100.0, 0.8);
        wide.moments_px2 = [3600.0, 0.0, 400.0];
        let [left, right] = share_out(&[wide], &[expect(260.0, 100.0), expect(150.0, 105.0)], &FACING);
        assert_eq!((left.len(), right.len()), (1, 1));
        assert!((left[0].centre.u_px - 251.96).abs() < 0.1 && (right[0].centre.u_px - 148.04).abs() < 0.1);
        assert_eq!(left[0].area_px, 2000.0);
    }
}
