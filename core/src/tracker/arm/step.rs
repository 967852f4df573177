//! One frame of one arm.

use super::context::FrameContext;
use super::estimate::{ArmEstimate, Cluster, Status};
use super::frame::{ArmFrame, MAX_CANDIDATES, most_likely};
use super::limbs;
use super::model::ArmModel;
use super::resample::select_ancestors;
use super::state::ArmTracker;
use crate::camera::Ray;
use crate::correction::allocation::allot;
use crate::math::{Vec3, clamp, exp, length, max, sqrt};
use crate::random::Stream;
use crate::ranges::is_place;
use crate::vision::candidate::HandCandidate;
use heapless::Vec;

/// Fastest hand, metres per second. Chosen: a sprinter's punch stays below.
const MAX_SPEED_M_PER_S: f32 = 6.0;
/// What a blob at any distance keeps of its chance.
/// Chosen: a hand that is found far away still attracts particles.
const FAR_SHARE: f32 = 0.1;
/// Index of the stream that the frame as a whole draws from.
const FRAME_STREAM: u32 = u32::MAX;
/// First of the streams that the Hough transforms draw from.
const LIMB_STREAMS: u32 = u32::MAX - 64;

impl<const CAPACITY: usize> ArmTracker<CAPACITY> {
    /// Answers one frame: the algorithm box of the arm paper, joined with PIK.
    ///
    /// A timestamp that does not lie after the last one counts as the shortest step. Every frame
    /// gets an answer; where nothing was seen it is a prediction and says so. Blobs and a shoulder
    /// that are out of range ([`crate::ranges`]) count as missing, so that the state stays
    /// [finite](crate::saved_state::SavedState::is_finite).
    pub fn step(&mut self, model: &ArmModel, frame: &ArmFrame<'_>) -> ArmEstimate {
        let dt_s = self.elapsed_s(frame.timestamp_us);
        let image = frame.image.unwrap_or_default();
        let (candidates, dropped) = most_likely(image.candidates);
        let context = self.context(model, frame, candidates, dt_s);
        self.fade_limbs(&context);
        let (seed, number) = (self.seed, self.frame);
        let stream_of = |index| Stream::new(seed, number, LIMB_STREAMS + index);
        limbs::observe(&context, &self.estimate, &image, stream_of, &mut self.limb_room);
        let ancestors: Vec<u16, CAPACITY> =
            select_ancestors(self.weights.normalised(), Stream::new(self.seed, self.frame, FRAME_STREAM));
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
        let path_std_m = self.unseen_path_std_m(model);
        ArmEstimate {
            side: model.side(),
            status,
            joints: cluster.joints,
            angles_rad: cluster.angles_rad,
            hand_std_m: sqrt(cluster.hand_variance_m2 + path_std_m * path_std_m),
            effective_sample_size: self.weights.effective_sample_size(),
            log_evidence,
            degenerate,
            hand_likelihood: carrier.map_or(0.0, |candidate| candidate.likelihood),
            candidate: carrier.and_then(|kept| image.candidates.iter().position(|given| given == kept)),
            dropped_candidates: dropped,
        }
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
        if model.options().variant.traits().drives_hands {
            for (chance, ray) in chances.iter_mut().zip(&rays) {
                *chance *= self.nearness(model, ray, dt_s);
            }
            free = allot(self.weights.len(), &chances, &mut counts);
        }
        let shoulder_m = if is_place(&frame.shoulder_m) { frame.shoulder_m } else { self.estimate.shoulder_m };
        FrameContext {
            model,
            shoulder_m,
            reachable: model.reachable(&shoulder_m),
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

    /// What a candidate on `ray` keeps of its chance, less where it is far from what the last
    /// estimate lets expect.
    fn nearness(&self, model: &ArmModel, ray: &Ray, dt_s: f32) -> f32 {
        let Some(gate) = model.options().gate.filter(|_| self.knows_hand(model)) else { return 1.0 };
        let hand_m = self.extrapolated_hand_m(model, dt_s);
        let miss_m = length(&(ray.project(&hand_m) - hand_m));
        let reach_m = gate.allotment_reach * (gate.std_m + gate.growth_m_per_s * self.unseen_s);
        exp(-0.5 * miss_m * miss_m / (reach_m * reach_m)) * (1.0 - FAR_SHARE) + FAR_SHARE
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

    /// Keeps what the next frame needs of the estimate: its place, its velocity, when a blob last
    /// carried it.
    fn remember(&mut self, context: &FrameContext<'_>, cluster: &Cluster, dt_s: f32) -> Status {
        self.limbs = *self.limb_room.hypotheses.at(cluster.candidate);
        let is_confirmed = self.remember_blobs(context, cluster, dt_s);
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
        let carrier = cluster.candidate.and_then(|index| context.candidates.get(index));
        let is_likely = carrier.is_some_and(|candidate| candidate.likelihood >= options.sure_likelihood);
        if is_likely && is_confirmed && cluster.share() >= options.sure_share {
            Status::Tracking
        } else if carried {
            Status::Uncertain
        } else if self.ever_seen && self.unseen_s <= options.lost_after_s {
            Status::Predicted
        } else {
            Status::Lost
        }
    }

    /// Remembers the blobs. Whether motion confirms the one that carries the estimate; always
    /// without memory.
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    fn remember_blobs(&mut self, context: &FrameContext<'_>, cluster: &Cluster, dt_s: f32) -> bool {
        let model = context.model;
        let Some(memory) = &model.options().blob_memory else { return true };
        let radius_of = |blob: &HandCandidate| model.cluster_radius_px(blob);
        self.memory.learn(&context.candidates, &cluster.masses, radius_of, dt_s, memory);
        let Some(carrier) = cluster.candidate else { return false };
        let hand = if self.ever_seen { model.camera().project(&self.estimate.hand_m) } else { None };
        let before = hand.map(|hand| (hand, self.hand_is_confirmed));
        let radius_px = context.radii_px.get(carrier).copied().unwrap_or(0.0);
        let [is_confirmed, is_sure] = self.memory.confirm(carrier, &context.candidates, before, radius_px, dt_s);
        self.hand_is_confirmed = is_confirmed;
        is_sure
    }
}
