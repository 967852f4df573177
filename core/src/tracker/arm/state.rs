//! State of one arm's tracker: how it begins and what it holds between frames.

use super::estimate::ArmJoints;
use super::limbs::{LimbDensities, LimbRoom};
use super::memory::BlobMemory;
use super::model::ArmModel;
use super::options::DEFAULT_GATE;
use super::particle::Particle;
use crate::error::ParameterError;
use crate::math::{Vec3, clamp, min};
use crate::observation::orientation::OrientationDensity;
use crate::particle::Weights;
use crate::random::Stream;
use heapless::Vec;

/// Spread of the angles around the waiting pose before anything was seen, radians.
/// Chosen: covers an arm that hangs or is half raised.
const INITIAL_STD_RAD: f32 = 0.5;
/// Time that the hand counts as unseen before the first frame, seconds: it may be anywhere.
/// Chosen: long against the growth of the gate.
const UNSEEN_AT_START_S: f32 = 2.0;
/// Time that is taken to have passed before the first frame, seconds.
/// Chosen: that of a camera with 15 Hz.
const FIRST_DT_S: f32 = 1.0 / 15.0;
/// Shortest and longest time between two frames that the motion model is asked for, seconds.
/// Chosen: a camera of 1000 Hz, and a second without frames.
const DT_RANGE_S: (f32, f32) = (1.0e-3, 1.0);
/// How far a hand that is not known to be anywhere may be from that of the waiting pose, metres.
/// Chosen: about the length of a forearm.
const WAITING_STD_M: f32 = 0.25;
/// The camera's centre, and no speed.
const ORIGIN_M: Vec3 = Vec3::new(0.0, 0.0, 0.0);

/// State of one arm's tracker with room for `CAPACITY` particles.
///
/// ```
/// use sinew_core::tracker::arm::example::{SHOULDERS_M, hand_blob, left_arm};
/// use sinew_core::tracker::arm::{ArmFrame, ArmImage, ArmTracker, Status};
///
/// let (model, hand, shoulder_m) = (left_arm()?, hand_blob(), SHOULDERS_M[0]);
/// let mut tracker = ArmTracker::<50>::new(&model, shoulder_m, 1)?;
/// for frame in 0..10 {
///     let image = Some(ArmImage { candidates: &[hand], edges: &[] });
///     let estimate = tracker.step(&model, &ArmFrame { timestamp_us: frame * 66_667, image, shoulder_m });
///     assert_eq!(estimate.status, Status::Tracking);
/// }
/// // Where to look for the hand in the next picture, and how far around.
/// let (hand_m, std_m) = tracker.predicted_hand(&model, 666_670);
/// let expected = model.camera().project(&hand_m).expect("in front of the camera");
/// assert!(expected.distance_px(hand.centre) < 25.0 && std_m < 0.1);
/// // The state fits a small device, and a capacity that is too small is refused.
/// const { assert!(size_of::<ArmTracker<50>>() <= 16 * 1024) };
/// assert!(ArmTracker::<20>::new(&model, shoulder_m, 1).is_err());
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
pub struct ArmTracker<const CAPACITY: usize> {
    pub(super) seed: u64,
    pub(super) frame: u64,
    pub(super) timestamp_us: Option<u64>,
    pub(super) unseen_s: f32,
    pub(super) ever_seen: bool,
    /// Whether the blob that carried the estimate last is confirmed.
    pub(super) hand_is_confirmed: bool,
    pub(super) generations: [Vec<Particle, CAPACITY>; 2],
    pub(super) current: usize,
    pub(super) weights: Weights<CAPACITY>,
    pub(super) limbs: LimbDensities,
    pub(super) limb_room: LimbRoom,
    pub(super) memory: BlobMemory,
    pub(super) estimate: ArmJoints,
    pub(super) hand_velocity_m_per_s: Vec3,
    pub(super) elbow_velocity_m_per_s: Vec3,
}

impl<const CAPACITY: usize> ArmTracker<CAPACITY> {
    /// A tracker that has seen nothing yet: particles around the waiting pose.
    ///
    /// # Errors
    /// The model's particle count has to be from 1 to `CAPACITY`, the shoulder within
    /// [`MAX_M`](crate::ranges::MAX_M).
    pub fn new(model: &ArmModel, shoulder_m: Vec3, seed: u64) -> Result<Self, ParameterError> {
        let mut tracker = Self::empty();
        tracker.begin(model, shoulder_m, seed)?;
        Ok(tracker)
    }

    /// A tracker without particles, so that one in static memory can begin there; it takes no
    /// stack. Its answers mean nothing.
    #[must_use]
    pub const fn empty() -> Self {
        let nowhere = ArmJoints { shoulder_m: ORIGIN_M, elbow_m: ORIGIN_M, hand_m: ORIGIN_M };
        Self {
            seed: 0,
            frame: 0,
            timestamp_us: None,
            unseen_s: UNSEEN_AT_START_S,
            ever_seen: false,
            hand_is_confirmed: false,
            generations: [Vec::new(), Vec::new()],
            current: 0,
            weights: Weights::none(),
            limbs: LimbDensities::empty(),
            limb_room: LimbRoom::empty(),
            memory: BlobMemory::empty(),
            estimate: nowhere,
            hand_velocity_m_per_s: ORIGIN_M,
            elbow_velocity_m_per_s: ORIGIN_M,
        }
    }

    /// Begins, or begins anew, in place: what [`Self::new`] gives.
    ///
    /// # Errors
    /// Those of [`Self::new`]; the tracker is as before then.
    pub fn begin(&mut self, model: &ArmModel, shoulder_m: Vec3, seed: u64) -> Result<(), ParameterError> {
        crate::ranges::place("shoulder_m", &shoulder_m)?;
        let bins = model.options().hough.bins;
        OrientationDensity::check(bins)?;
        self.weights.begin(model.options().particles)?;
        let waiting = model.waiting_pose();
        let (elbow_m, hand_m) = model.elbow_and_hand(&shoulder_m, &waiting);
        let [first, second] = &mut self.generations;
        first.clear();
        second.clear();
        for index in 0..self.weights.len() as u32 {
            let mut stream = Stream::new(seed, 0, index);
            let angles_rad = model.skeleton().clamp(waiting.map(|angle| angle + INITIAL_STD_RAD * stream.normal()));
            let (elbow_m, hand_m) = model.elbow_and_hand(&shoulder_m, &angles_rad);
            // As many as weights, which have the same capacity.
            let _ = first.push(Particle { angles_rad, elbow_m, hand_m, driver: None });
        }
        self.seed = seed;
        self.frame = 0;
        self.timestamp_us = None;
        self.unseen_s = UNSEEN_AT_START_S;
        self.ever_seen = false;
        self.current = 0;
        self.limbs.upper.begin(bins);
        self.limbs.fore.begin(bins);
        self.memory.blobs.clear();
        self.hand_is_confirmed = false;
        self.estimate = ArmJoints { shoulder_m, elbow_m, hand_m };
        self.hand_velocity_m_per_s = ORIGIN_M;
        self.elbow_velocity_m_per_s = ORIGIN_M;
        Ok(())
    }

    /// The particles of the last frame.
    #[must_use]
    pub fn particles(&self) -> &[Particle] {
        &self.generations[self.current & 1]
    }

    /// Weights of [`Self::particles`], in their order; they sum to one.
    #[must_use]
    pub fn weights(&self) -> &[f32] {
        self.weights.normalised()
    }

    /// Whether a blob carried the estimate in any frame so far.
    #[must_use]
    pub fn has_seen_the_hand(&self) -> bool {
        self.ever_seen
    }

    /// Where the hand is expected at `timestamp_us`, metres, and how far off that may be (standard
    /// deviation, metres).
    #[must_use]
    pub fn predicted_hand(&self, model: &ArmModel, timestamp_us: u64) -> (Vec3, f32) {
        let dt_s = self.elapsed_s(timestamp_us);
        let options = model.options();
        if !self.knows_hand(model) {
            return (model.elbow_and_hand(&self.estimate.shoulder_m, &model.waiting_pose()).1, WAITING_STD_M);
        }
        let (drift_m, path_m) =
            (options.hand_std_m_per_sqrt_s * crate::math::sqrt(dt_s), self.unseen_path_std_m(model));
        let std_m = crate::math::sqrt(drift_m * drift_m + path_m * path_m);
        (self.extrapolated_hand_m(model, dt_s), std_m)
    }

    /// How far a hand goes while no blob carries the estimate (standard deviation, metres an axis):
    /// at the speed that the gate allows a hand that is not seen, until it may be anywhere. The
    /// particles alone spread too little, since they keep a pose.
    pub(super) fn unseen_path_std_m(&self, model: &ArmModel) -> f32 {
        min(model.options().gate.unwrap_or(DEFAULT_GATE).growth_m_per_s * self.unseen_s, WAITING_STD_M)
    }

    /// Whether a blob carried the estimate so recently that it still says where the hand is.
    pub(super) fn knows_hand(&self, model: &ArmModel) -> bool {
        self.ever_seen && self.unseen_s <= model.options().lost_after_s
    }

    /// The last estimate's hand, moved on by its velocity.
    pub(super) fn extrapolated_hand_m(&self, model: &ArmModel, dt_s: f32) -> Vec3 {
        self.estimate.hand_m + self.hand_velocity_m_per_s * (model.options().velocity_persistence * dt_s)
    }

    pub(super) fn elapsed_s(&self, timestamp_us: u64) -> f32 {
        let Some(before) = self.timestamp_us else { return FIRST_DT_S };
        let elapsed = timestamp_us.saturating_sub(before) as f32 * 1.0e-6;
        clamp(elapsed, DT_RANGE_S.0, DT_RANGE_S.1)
    }
}

// An arm's whole state with 50 particles fits a small device.
const _: () = assert!(size_of::<ArmTracker<50>>() <= 16 * 1024);
