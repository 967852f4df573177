//! What all particles of one frame share.

use super::frame::MAX_CANDIDATES;
use super::model::ArmModel;
use crate::camera::{Pixel, Ray};
use crate::correction::hand::{HandSpread, ReachableShell};
use crate::math::{Vec3, length, max, sqrt};
use crate::pik::goal::LinearExtrapolation;
use crate::vision::candidate::HandCandidate;
use heapless::Vec;

/// A square that exceeds another one this many times has the greater root, however both are
/// rounded. Chosen: several roundings of `f32`.
const CLEARLY_MORE: f32 = 1.0 + 1.0e-6;

/// What all particles of one frame share.
pub(super) struct FrameContext<'a> {
    pub model: &'a ArmModel,
    pub shoulder_m: Vec3,
    pub reachable: ReachableShell,
    pub dt_s: f32,
    /// Time since a blob last carried the estimate.
    pub unseen_s: f32,
    pub hand_velocity_m_per_s: Vec3,
    pub elbow_velocity_m_per_s: Vec3,
    pub candidates: Vec<HandCandidate, MAX_CANDIDATES>,
    pub rays: Vec<Ray, MAX_CANDIDATES>,
    /// Within which a hand is at each candidate.
    pub radii_px: [f32; MAX_CANDIDATES],
    /// Each candidate's likelihood, less where it was not the hand before.
    pub beliefs: [f32; MAX_CANDIDATES],
    /// Particles that each candidate got.
    pub counts: [u16; MAX_CANDIDATES],
    /// Particles that ignore the candidates.
    pub free: usize,
    /// Greatest of the candidates' chances to be the hand, after belief and nearness.
    pub best_chance: f32,
}

impl FrameContext<'_> {
    /// The hand's goal process.
    pub fn hand_process(&self) -> LinearExtrapolation {
        let options = self.model.options();
        LinearExtrapolation {
            persistence: options.velocity_persistence,
            std_m_per_sqrt_s: options.hand_std_m_per_sqrt_s,
        }
    }

    /// H1 with its spread: the extrapolated hand on the ray of candidate `index`. Its depth is
    /// drawn towards what the blob's area gives where that is wanted. `forearm` is where the
    /// forearm is thought to point, a unit vector.
    pub fn corrected_hand(
        &self,
        extrapolated_m: &Vec3,
        forearm: &Vec3,
        index: usize,
    ) -> Option<(Vec3, Ray, HandSpread)> {
        let (ray, candidate) = (self.rays.get(index)?, self.candidates.get(index)?);
        let options = self.model.options();
        let mut depth_m = max((extrapolated_m - ray.origin).dot(&ray.direction), 0.0);
        let drift_m = options.ray_std_m_per_sqrt_s * sqrt(self.dt_s + self.unseen_s);
        let turn_m = options.ray_std_per_path * length(&self.hand_velocity_m_per_s) * self.dt_s;
        let mut along_std_m = sqrt(drift_m * drift_m + turn_m * turn_m);
        if let Some(cue) = options.area_cue.filter(|_| options.depth_from_area) {
            let area_m2 = cue.expected_area_m2(forearm.dot(&ray.direction));
            let area_px = candidate.length_weighted_area_px(cue.length_share);
            let told_m = self.model.camera().focal_px() * sqrt(area_m2 / area_px) / max(ray.direction.z, 0.1);
            let told_std_m = 0.5 * cue.log_std * told_m;
            let (ours, theirs) = (1.0 / (along_std_m * along_std_m), 1.0 / (told_std_m * told_std_m));
            depth_m = (depth_m * ours + told_m * theirs) / (ours + theirs);
            along_std_m = 1.0 / sqrt(ours + theirs);
        }
        let across_std_m = options.centre_std_per_focal * max(depth_m, 0.1);
        Some((ray.origin + ray.direction * depth_m, *ray, HandSpread { along_std_m, across_std_m }))
    }

    /// The candidate whose centre lies nearest to `hand`, if within the cluster radius.
    pub fn candidate_at(&self, hand: Option<Pixel>) -> Option<usize> {
        let hand = hand?;
        let mut best = (None, f32::INFINITY);
        for (index, (candidate, &radius_px)) in self.candidates.iter().zip(&self.radii_px).enumerate() {
            let (du, dv) = (candidate.centre.u_px - hand.u_px, candidate.centre.v_px - hand.v_px);
            // Most blobs are so far off that no root has to be taken to see it.
            if du * du + dv * dv > CLEARLY_MORE * (radius_px * radius_px) {
                continue;
            }
            let distance = candidate.centre.distance_px(hand);
            if distance < best.1 && distance < radius_px {
                best = (Some(index), distance);
            }
        }
        best.0
    }
}
