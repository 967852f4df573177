//! One frame of one arm.

use super::estimate::{ArmEstimate, ArmJoints, Cluster, Status};
use super::frame::{ArmFrame, MAX_CANDIDATES, most_likely};
use super::limbs::{self, LimbDensities, LimbRoom};
use super::memory::BlobMemory;
use super::model::ArmModel;
use super::propose::FrameContext;
use crate::camera::Ray;
use crate::correction::allocation::allot;
use crate::error::ParameterError;
use crate::math::{Vec3, clamp, exp, length, max, unit};
use crate::observation::orientation::OrientationDensity;
use crate::particle::Weights;
use crate::particle::resampling::{permute, systematic};
use crate::random::Stream;
use crate::skeleton::arm::ArmAngles;
use crate::vision::candidate::HandCandidate;
use heapless::Vec;

/// Spread of the angles around the waiting pose before anything was seen, radians.
const INITIAL_STD_RAD: f32 = 0.5;
/// Time that the hand counts as unseen before the first frame, seconds: it may be anywhere.
const UNSEEN_AT_START_S: f32 = 2.0;
/// Time that is taken to have passed before the first frame, seconds.
const FIRST_DT_S: f32 = 1.0 / 15.0;
/// Shortest and longest time between two frames that the motion model is asked for, seconds.
const DT_RANGE_S: (f32, f32) = (1.0e-3, 1.0);
/// Fastest hand, metres per second: a sprinter's punch stays below.
const MAX_SPEED_M_PER_S: f32 = 6.0;
/// How far a hand that is not known to be anywhere may be from that of the waiting pose, metres.
const WAITING_STD_M: f32 = 0.25;
/// What a blob at any distance keeps of its chance.
const FAR_SHARE: f32 = 0.1;
/// The camera's centre, and no speed.
const ORIGIN_M: Vec3 = Vec3::new(0.0, 0.0, 0.0);
/// Index of the stream that the frame as a whole draws from.
const FRAME_STREAM: u32 = u32::MAX;
/// First of the streams that the Hough transforms draw from.
const LIMB_STREAMS: u32 = u32::MAX - 64;

/// One weighted arm.
///
/// ```
/// use sinew_core::tracker::arm::{ArmFrame, ArmImage, ArmModel, ArmOptions, ArmTracker};
/// # use sinew_core::camera::{Camera, Pixel};
/// # use sinew_core::math::Vec3;
/// # use sinew_core::vision::candidate::HandCandidate;
/// # use sinew_core::skeleton::{ArmGeometry, Side};
/// # let camera = Camera::from_field_of_view(640, 480, 1.05)?;
/// # let arm = ArmGeometry::new(Side::Left, 0.30, 0.35)?;
/// # let model = ArmModel::new(camera, (640, 480), arm, ArmOptions::default())?;
/// # let shoulder_m = Vec3::new(0.2, -0.1, 1.2);
/// # let centre = Pixel::new(400.0, 250.0);
/// # let hand = HandCandidate { centre, moments_px2: [400.0, 0.0, 400.0], area_px: 4700.0, likelihood: 0.8 };
///
/// let mut tracker = ArmTracker::<50>::new(&model, shoulder_m, 1)?;
/// let image = Some(ArmImage { candidates: &[hand], edges: &[] });
/// let _ = tracker.step(&model, &ArmFrame { timestamp_us: 0, image, shoulder_m });
/// // The only blob drove most particles; the free share went on as if there were none.
/// let driven = tracker.particles().iter().filter(|particle| particle.driver == Some(0)).count();
/// assert!((25..50).contains(&driven), "{driven} of 50");
/// // Every particle is a whole pose, with the lengths of the arm.
/// let particle = &tracker.particles()[0];
/// assert!(((particle.hand_m - particle.elbow_m).norm() - 0.35).abs() < 1e-4);
/// assert!((particle.forearm().norm() - 1.0).abs() < 1e-5);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Particle {
    /// Pose, inside the limits.
    pub angles_rad: ArmAngles,
    /// Elbow of that pose, metres.
    pub elbow_m: Vec3,
    /// Hand of that pose, metres: what was reached, not the goal.
    pub hand_m: Vec3,
    /// The considered candidate that drove the particle in this frame.
    pub driver: Option<u8>,
}

impl Particle {
    /// Where the forearm points, a unit vector.
    #[must_use]
    pub fn forearm(&self) -> Vec3 {
        unit(self.hand_m - self.elbow_m).unwrap_or(Vec3::zeros())
    }
}

/// State of one arm's tracker with room for `CAPACITY` particles.
///
/// ```
/// use sinew_core::tracker::arm::{ArmFrame, ArmImage, ArmModel, ArmOptions, ArmTracker, Status};
/// # use sinew_core::camera::{Camera, Pixel};
/// # use sinew_core::math::Vec3;
/// # use sinew_core::vision::candidate::HandCandidate;
/// # use sinew_core::skeleton::{ArmGeometry, Side};
/// # let camera = Camera::from_field_of_view(640, 480, 1.05)?;
/// # let arm = ArmGeometry::new(Side::Left, 0.30, 0.35)?;
/// # let model = ArmModel::new(camera, (640, 480), arm, ArmOptions::default())?;
/// # let shoulder_m = Vec3::new(0.2, -0.1, 1.2);
/// # let centre = Pixel::new(400.0, 250.0);
/// # let hand = HandCandidate { centre, moments_px2: [400.0, 0.0, 400.0], area_px: 4700.0, likelihood: 0.8 };
///
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
    pub(super) generations: [Vec<Particle, CAPACITY>; 2],
    pub(super) current: usize,
    pub(super) weights: Weights<CAPACITY>,
    pub(super) limbs: LimbDensities,
    limb_room: LimbRoom,
    pub(super) memory: BlobMemory,
    pub(super) estimate: ArmJoints,
    pub(super) hand_velocity_m_per_s: Vec3,
    pub(super) elbow_velocity_m_per_s: Vec3,
}

impl<const CAPACITY: usize> ArmTracker<CAPACITY> {
    /// A tracker that has seen nothing yet: particles around the waiting pose.
    ///
    /// # Errors
    /// The model's particle count has to be from 1 to `CAPACITY`.
    pub fn new(model: &ArmModel, shoulder_m: Vec3, seed: u64) -> Result<Self, ParameterError> {
        let mut tracker = Self::empty();
        tracker.begin(model, shoulder_m, seed)?;
        Ok(tracker)
    }

    /// A tracker without particles, so that one in static memory can begin there; it takes no stack. Its answers mean nothing.
    #[must_use]
    pub const fn empty() -> Self {
        let nowhere = ArmJoints { shoulder_m: ORIGIN_M, elbow_m: ORIGIN_M, hand_m: ORIGIN_M };
        Self {
            seed: 0,
            frame: 0,
            timestamp_us: None,
            unseen_s: UNSEEN_AT_START_S,
            ever_seen: false,
            generations: [Vec::new(), Vec::new()],
            current: 0,
            weights: Weights::none(),
            limbs: LimbDensities::flat(),
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
        let uniform = OrientationDensity::uniform(model.options().hough.bins)?;
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
        self.limbs = LimbDensities { upper: uniform, fore: uniform };
        self.memory = BlobMemory::empty();
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

    /// Where the hand is expected at `timestamp_us`, metres, and how far off that may be (standard deviation, metres).
    #[must_use]
    pub fn predicted_hand(&self, model: &ArmModel, timestamp_us: u64) -> (Vec3, f32) {
        let dt_s = self.elapsed_s(timestamp_us);
        let options = model.options();
        if !self.knows_hand(model) {
            return (model.elbow_and_hand(&self.estimate.shoulder_m, &model.waiting_pose()).1, WAITING_STD_M);
        }
        let std_m = options.hand_std_m_per_sqrt_s * crate::math::sqrt(dt_s + self.unseen_s);
        (self.extrapolated_hand_m(model, dt_s), std_m)
    }

    /// Whether a blob carried the estimate so recently that it still says where the hand is.
    fn knows_hand(&self, model: &ArmModel) -> bool {
        self.ever_seen && self.unseen_s <= model.options().lost_after_s
    }

    /// The last estimate's hand, moved on by its velocity.
    fn extrapolated_hand_m(&self, model: &ArmModel, dt_s: f32) -> Vec3 {
        self.estimate.hand_m + self.hand_velocity_m_per_s * (model.options().velocity_persistence * dt_s)
    }

    /// Answers one frame: the algorithm box of the arm paper, joined with PIK.
    ///
    /// A timestamp that does not lie after the last one counts as the shortest step. Every frame gets an answer; where
    /// nothing was seen it is a prediction and says so.
    pub fn step(&mut self, model: &ArmModel, frame: &ArmFrame<'_>) -> ArmEstimate {
        let dt_s = self.elapsed_s(frame.timestamp_us);
        let image = frame.image.unwrap_or_default();
        let (candidates, dropped) = most_likely(image.candidates);
        let context = self.context(model, frame, candidates, dt_s);
        self.fade_limbs(&context);
        let (seed, number) = (self.seed, self.frame);
        let stream_of = |index| Stream::new(seed, number, LIMB_STREAMS + index);
        limbs::observe(&context, &self.estimate, &image, stream_of, &mut self.limb_room);
        let ancestors = self.select_ancestors();
        self.predict_and_weigh(&context, &ancestors, frame.image.is_some());
        let (log_evidence, degenerate) = match self.weights.normalise() {
            Ok(log_evidence) => (log_evidence, false),
            Err(_) => (0.0, true),
        };
        let cluster = context.heaviest_cluster(self.particles(), self.weights.normalised());
        let status = self.remember(&context, &cluster, dt_s);
        self.frame += 1;
        self.timestamp_us = Some(frame.timestamp_us);
        let carrier = cluster.candidate.and_then(|index| context.candidates.get(index));
        ArmEstimate {
            side: model.side(),
            status,
            joints: cluster.joints,
            angles_rad: cluster.angles_rad,
            hand_std_m: cluster.hand_std_m,
            effective_sample_size: self.weights.effective_sample_size(),
            log_evidence,
            degenerate,
            hand_likelihood: carrier.map_or(0.0, |candidate| candidate.likelihood),
            candidate: carrier.and_then(|kept| image.candidates.iter().position(|given| given == kept)),
            dropped_candidates: dropped,
        }
    }

    fn elapsed_s(&self, timestamp_us: u64) -> f32 {
        let Some(before) = self.timestamp_us else { return FIRST_DT_S };
        let elapsed = timestamp_us.saturating_sub(before) as f32 * 1.0e-6;
        clamp(elapsed, DT_RANGE_S.0, DT_RANGE_S.1)
    }

    /// Orientation densities for the last estimate, faded as where nothing moves.
    fn fade_limbs(&mut self, context: &FrameContext<'_>) {
        let keep = exp(-context.dt_s / context.model.options().orientation_memory_s);
        self.limbs.upper.fade(keep);
        self.limbs.fore.fade(keep);
        self.limb_room.hypotheses.estimate = self.limbs;
    }

    /// Gathers what all particles share: rays of the blobs and how many particles each blob gets.
    fn context<'a>(
        &self,
        model: &'a ArmModel,
        frame: &ArmFrame<'_>,
        candidates: Vec<HandCandidate, MAX_CANDIDATES>,
        dt_s: f32,
    ) -> FrameContext<'a> {
        let mut rays: Vec<Ray, MAX_CANDIDATES> = Vec::new();
        for candidate in &candidates {
            // One ray a candidate, so it always fits.
            let _ = rays.push(model.camera().back_project(candidate.centre));
        }
        let mut radii_px = [0.0; MAX_CANDIDATES];
        for (radius_px, candidate) in radii_px.iter_mut().zip(&candidates) {
            *radius_px = model.cluster_radius_px(candidate);
        }
        let mut counts = [0; MAX_CANDIDATES];
        let mut free = self.weights.len();
        let mut beliefs = [0.0; MAX_CANDIDATES];
        for (belief, candidate) in beliefs.iter_mut().zip(&candidates) {
            *belief = self.belief(model, candidate);
        }
        let mut chances = beliefs;
        if model.options().variant.is_blob_driven() {
            for (chance, ray) in chances.iter_mut().zip(&rays) {
                *chance *= self.nearness(model, ray, dt_s);
            }
            free = allot(self.weights.len(), &chances, &mut counts);
        }
        FrameContext {
            model,
            shoulder_m: frame.shoulder_m,
            reachable: model.reachable(&frame.shoulder_m),
            dt_s,
            unseen_s: self.unseen_s,
            hand_velocity_m_per_s: self.hand_velocity_m_per_s,
            elbow_velocity_m_per_s: self.elbow_velocity_m_per_s,
            rays,
            radii_px,
            beliefs,
            candidates,
            counts,
            free,
            best_chance: chances.iter().fold(0.0, |a, &b| max(a, b)),
        }
    }

    /// Likelihood of a candidate, less where it was not the hand before.
    fn belief(&self, model: &ArmModel, candidate: &HandCandidate) -> f32 {
        let Some(memory) = &model.options().blob_memory else { return candidate.likelihood };
        candidate.likelihood * self.memory.share(candidate.centre, model.cluster_radius_px(candidate), memory)
    }

    /// What a candidate on `ray` keeps of its chance, less where it is far from what the last estimate lets expect.
    fn nearness(&self, model: &ArmModel, ray: &Ray, dt_s: f32) -> f32 {
        let Some(gate) = model.options().gate.filter(|_| self.knows_hand(model)) else { return 1.0 };
        let hand_m = self.extrapolated_hand_m(model, dt_s);
        let miss_m = length(&(ray.project(&hand_m) - hand_m));
        let reach_m = gate.allotment_reach * (gate.std_m + gate.growth_m_per_s * self.unseen_s);
        exp(-0.5 * miss_m * miss_m / (reach_m * reach_m)) * (1.0 - FAR_SHARE) + FAR_SHARE
    }

    /// Systematic resampling, then a permutation, so that the order of the ancestors does not decide who drives them.
    fn select_ancestors(&self) -> Vec<u16, CAPACITY> {
        let mut stream = Stream::new(self.seed, self.frame, FRAME_STREAM);
        let mut ancestors: Vec<u16, CAPACITY> = Vec::new();
        // As many as there are particles, so it always fits.
        let _ = ancestors.resize(self.weights.len(), 0);
        systematic(self.weights.normalised(), stream.uniform(), &mut ancestors);
        permute(&mut ancestors, &mut stream);
        ancestors
    }

    /// Moves every ancestor on and weighs the result. Without an image all weights are equal.
    fn predict_and_weigh(&mut self, context: &FrameContext<'_>, ancestors: &[u16], is_seen: bool) {
        let limbs = is_seen.then_some(&self.limb_room.hypotheses);
        let [even, odd] = &mut self.generations;
        let (before, after) = if self.current == 0 { (even, odd) } else { (odd, even) };
        after.clear();
        let drivers: Vec<Option<usize>, CAPACITY> =
            context.assign_drivers(ancestors.iter().map(|&ancestor| before.get(usize::from(ancestor))));
        for (index, &ancestor) in ancestors.iter().enumerate() {
            let Some(parent) = before.get(usize::from(ancestor)) else { continue };
            // Frame 0 is the scatter of the first generation.
            let mut stream = Stream::new(self.seed, self.frame + 1, index as u32);
            let proposed = context.propose(parent, drivers.get(index).copied().flatten(), &mut stream);
            let log_weight = limbs.map_or(0.0, |limbs| context.log_weight(&proposed, limbs));
            self.weights.set_log(index, log_weight);
            // The generation has the capacity of the one before.
            let _ = after.push(proposed.particle);
        }
        self.current ^= 1;
    }

    /// Keeps what the next frame needs of the estimate: its place, its velocity, when a blob last carried it.
    fn remember(&mut self, context: &FrameContext<'_>, cluster: &Cluster, dt_s: f32) -> Status {
        self.limbs = *self.limb_room.hypotheses.at(cluster.candidate);
        if let Some(memory) = &context.model.options().blob_memory {
            let radius_of = |blob: &HandCandidate| context.model.cluster_radius_px(blob);
            self.memory.learn(&context.candidates, &cluster.masses, radius_of, dt_s, memory);
        }
        let was_seen = self.ever_seen && self.unseen_s == 0.0;
        let carried = cluster.candidate.is_some();
        let options = context.model.options();
        self.unseen_s = if carried { 0.0 } else { clamp(self.unseen_s + dt_s, 0.0, 60.0) };
        self.ever_seen |= carried;
        if was_seen && carried {
            let gain = options.velocity_gain;
            let blend = |old: Vec3, change: Vec3| {
                let new = old * (1.0 - gain) + change * (gain / dt_s);
                let speed = length(&new);
                if speed > MAX_SPEED_M_PER_S { new * (MAX_SPEED_M_PER_S / speed) } else { new }
            };
            self.hand_velocity_m_per_s =
                blend(self.hand_velocity_m_per_s, cluster.joints.hand_m - self.estimate.hand_m);
            self.elbow_velocity_m_per_s =
                blend(self.elbow_velocity_m_per_s, cluster.joints.elbow_m - self.estimate.elbow_m);
        } else {
            // A prediction confirms itself; its velocity fades. A return is no motion.
            let keep = if carried { 0.0 } else { options.velocity_persistence };
            self.hand_velocity_m_per_s *= keep;
            self.elbow_velocity_m_per_s *= keep;
        }
        self.estimate = cluster.joints;
        if carried {
            Status::Tracking
        } else if self.ever_seen && self.unseen_s <= options.lost_after_s {
            Status::Predicted
        } else {
            Status::Lost
        }
    }
}

// An arm's whole state with 50 particles fits a small device.
const _: () = assert!(size_of::<ArmTracker<50>>() <= 16 * 1024);
