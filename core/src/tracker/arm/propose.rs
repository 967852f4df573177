//! Proposals: where each particle's arm goes, by variant.

use super::frame::MAX_CANDIDATES;
use super::model::ArmModel;
use super::options::Variant;
use super::payment;
use super::step::Particle;
use crate::camera::Ray;
use crate::correction::elbow::nearest_elbow;
use crate::correction::hand::{HandSpread, ReachableShell, draw_on_ray};
use crate::kinematics::inverse::{Goal, PoseDensity, PoseObjective, Solve};
use crate::math::{Mat3, Vec3, clamp, length, max, sqrt, unit};
use crate::pik::goal::LinearExtrapolation;
use crate::pik::proposal::{LaplaceProposal, LimitMass};
use crate::random::Stream;
use crate::skeleton::arm::{ARM_ANGLES, FOREARM, UPPER_ARM};
use crate::vision::candidate::HandCandidate;
use heapless::Vec;

/// Greatest part of a paid weight that the importance ratio of the pose may decide. The expansion's tails are thinner than
/// those of the density, so rare draws would otherwise take the whole weight, the more so the more particles there are.
const MAX_LOG_RATIO: f32 = 3.0;

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

/// A particle before it is weighted.
pub(super) struct Proposed {
    pub particle: Particle,
    /// Distance from the particle's own extrapolation to where a blob sent its hand; zero where none did.
    pub jump_m: f32,
    /// Where the forearm was thought to point when the depth was drawn, a unit vector.
    pub supposed_forearm: Vec3,
    /// ln of what the weight owes for the proposal (`pik-paid`), else zero.
    pub log_payment: f32,
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

    /// H1 with its spread: the extrapolated hand on the ray of candidate `index`, its depth drawn towards what the
    /// blob's area tells where that is wanted. `forearm` is where the forearm is thought to point, a unit vector.
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

    /// Which candidate drives each ancestor's hand, if any.
    ///
    /// Unpaid, an ancestor that is at a blob stays with it while that blob has particles left: sent elsewhere it would
    /// only meet the gate. The others, and all where goals are paid for, are assigned in the given (permuted) order.
    pub fn assign_drivers<'p, const CAPACITY: usize>(
        &self,
        ancestors: impl Iterator<Item = Option<&'p Particle>>,
    ) -> Vec<Option<usize>, CAPACITY> {
        let is_paid = self.model.options().variant == Variant::PikPaid;
        let mut left = self.counts;
        let mut drivers: Vec<Option<usize>, CAPACITY> = Vec::new();
        for ancestor in ancestors {
            let place = ancestor.filter(|_| !is_paid).and_then(|p| self.model.camera().project(&p.hand_m));
            let own = self.candidate_at(place).filter(|&index| left.get(index).is_some_and(|&n| n > 0));
            if let Some(count) = own.and_then(|index| left.get_mut(index)) {
                *count -= 1;
            }
            // One entry a particle, so it always fits.
            let _ = drivers.push(own);
        }
        let mut rest = left.iter().enumerate().flat_map(|(blob, &n)| (0..n).map(move |_| blob));
        for driver in drivers.iter_mut().filter(|driver| driver.is_none()) {
            *driver = rest.next();
        }
        drivers
    }

    /// Moves `ancestor` on; `driver` is the candidate that its hand is sent to.
    pub fn propose(&self, ancestor: &Particle, driver: Option<usize>, stream: &mut Stream) -> Proposed {
        let mut proposed = match self.model.options().variant {
            Variant::Standard | Variant::Corrected => self.propose_by_joints(ancestor, driver, stream),
            Variant::PikPaid => self.propose_paid(ancestor, driver, stream),
            Variant::Pik | Variant::Bootstrap => self.propose_by_goal(ancestor, driver, stream),
        };
        proposed.particle.driver = driver.map(|index| index as u8);
        proposed
    }

    /// The arm paper: elbow and hand by a first-order linear model, made reachable; a driven hand is corrected on the
    /// ray and the elbow goes to the nearest point of its circle.
    fn propose_by_joints(&self, ancestor: &Particle, driver: Option<usize>, stream: &mut Stream) -> Proposed {
        let (options, geometry) = (self.model.options(), self.model.geometry());
        let extrapolated_m = self.hand_process().mean(&ancestor.hand_m, &self.hand_velocity_m_per_s, self.dt_s);
        let elbow_process = LinearExtrapolation {
            persistence: options.velocity_persistence,
            std_m_per_sqrt_s: options.elbow_std_m_per_sqrt_s,
        };
        let elbow_drawn = elbow_process.draw(&ancestor.elbow_m, &self.elbow_velocity_m_per_s, self.dt_s, stream);
        let hand_drawn = self.hand_process().draw(&ancestor.hand_m, &self.hand_velocity_m_per_s, self.dt_s, stream);
        let down = unit(ancestor.elbow_m - self.shoulder_m).unwrap_or(Vec3::y());
        let upper = unit(elbow_drawn - self.shoulder_m).unwrap_or(down);
        let mut elbow_m = self.shoulder_m + upper * geometry.upper_arm_m;
        let fore = unit(hand_drawn - elbow_m).unwrap_or(upper);
        let mut hand_m = elbow_m + fore * geometry.forearm_m;
        let mut jump_m = 0.0;
        if let Some((mean_m, ray, spread)) = driver.and_then(|index| self.corrected_hand(&hand_m, &fore, index)) {
            hand_m = self.reachable.along_ray(&draw_on_ray(&mean_m, &ray, &spread, stream), &ray);
            elbow_m = nearest_elbow(&self.shoulder_m, &hand_m, geometry.upper_arm_m, geometry.forearm_m, &elbow_m);
            jump_m = length(&(hand_m - extrapolated_m));
        }
        let angles_rad = geometry.angles_from_joints(
            &(elbow_m - self.shoulder_m),
            &(hand_m - self.shoulder_m),
            &ancestor.angles_rad,
        );
        Proposed { particle: self.particle(angles_rad), jump_m, supposed_forearm: fore, log_payment: 0.0 }
    }

    /// PIK with the goal of a blob, or of the goal process.
    fn propose_by_goal(&self, ancestor: &Particle, driver: Option<usize>, stream: &mut Stream) -> Proposed {
        let process = self.hand_process();
        let extrapolated_m = process.mean(&ancestor.hand_m, &self.hand_velocity_m_per_s, self.dt_s);
        let Some((mean_m, ray, spread)) =
            driver.and_then(|index| self.corrected_hand(&extrapolated_m, &ancestor.forearm(), index))
        else {
            let drawn = process.draw(&ancestor.hand_m, &self.hand_velocity_m_per_s, self.dt_s, stream);
            let goal = self.free_goal(self.reachable.nearest(&drawn));
            let (particle, _) = self.pose_for(ancestor, &goal, stream);
            return Proposed { particle, jump_m: 0.0, supposed_forearm: ancestor.forearm(), log_payment: 0.0 };
        };
        let goal_m = self.reachable.along_ray(&draw_on_ray(&mean_m, &ray, &spread, stream), &ray);
        let (particle, _) = self.pose_for(ancestor, &self.driven_goal(goal_m, &ray), stream);
        let jump_m = length(&(particle.hand_m - extrapolated_m));
        Proposed { particle, jump_m, supposed_forearm: ancestor.forearm(), log_payment: 0.0 }
    }

    /// As [`Self::propose_by_goal`], but goals stay as drawn and the weight pays for them.
    fn propose_paid(&self, ancestor: &Particle, driver: Option<usize>, stream: &mut Stream) -> Proposed {
        let process = self.hand_process();
        let extrapolated_m = process.mean(&ancestor.hand_m, &self.hand_velocity_m_per_s, self.dt_s);
        let goal_m = match driver.and_then(|index| self.corrected_hand(&extrapolated_m, &ancestor.forearm(), index)) {
            Some((mean_m, ray, spread)) => draw_on_ray(&mean_m, &ray, &spread, stream),
            None => payment::draw_transition(self, &extrapolated_m, stream),
        };
        let log_goal = payment::log_transition(self, &extrapolated_m, &goal_m)
            - payment::log_proposal(self, &extrapolated_m, &ancestor.forearm(), &goal_m);
        let (particle, log_ratio) = self.pose_for(ancestor, &self.paid_goal(goal_m), stream);
        let log_payment = log_goal + clamp(log_ratio, -MAX_LOG_RATIO, MAX_LOG_RATIO);
        Proposed { particle, jump_m: 0.0, supposed_forearm: ancestor.forearm(), log_payment }
    }

    /// A goal that is wanted alike in all directions.
    fn free_goal(&self, position_m: Vec3) -> Goal {
        let std_m = self.model.options().reach_std_m;
        Goal { bone: FOREARM, position_m, precision: Mat3::identity() / (std_m * std_m) }
    }

    /// A goal of a blob or of the transition alike, so that both have the same pose density. It is reached with the
    /// geometric mean of both spreads: much wider than a blob's error, and the blob term would let hardly a draw live.
    fn paid_goal(&self, position_m: Vec3) -> Goal {
        let options = self.model.options();
        let precision = Mat3::identity() / (options.reach_std_m * options.reach_across_std_m);
        Goal { bone: FOREARM, position_m, precision }
    }

    /// A goal that is wanted more closely across the ray than along it: where limits forbid its depth, the hand slides
    /// along the ray.
    fn driven_goal(&self, position_m: Vec3, ray: &Ray) -> Goal {
        let options = self.model.options();
        let along = ray.direction * ray.direction.transpose();
        let precision = (Mat3::identity() - along) / (options.reach_across_std_m * options.reach_across_std_m)
            + along / (options.reach_std_m * options.reach_std_m);
        Goal { bone: FOREARM, position_m, precision }
    }

    /// Mode and Laplace draw for one goal, with the log importance ratio of the draw where the weight pays for it.
    fn pose_for(&self, ancestor: &Particle, goal: &Goal, stream: &mut Stream) -> (Particle, f32) {
        let options = self.model.options();
        let jump_rad = length(&(goal.position_m - ancestor.hand_m)) / self.model.geometry().reach_m();
        let variances = options.angle_std_rad_per_sqrt_s.map(|std| std * std * self.dt_s);
        let density = PoseDensity {
            skeleton: self.model.skeleton(),
            root_m: self.shoulder_m,
            goals: core::slice::from_ref(goal),
            previous_rad: ancestor.angles_rad,
            // A jump needs its angles; what it costs is the gate's business, not the stiffness's.
            stiffness: variances.map(|variance| 1.0 / (variance + jump_rad * jump_rad)),
            held: 0,
        };
        let mut mode = density.mode_from(&self.starts(ancestor, &goal.position_m), options.solver_steps);
        let pays = options.variant == Variant::PikPaid;
        if !pays {
            // The draw spreads as far as a frame's stiffness lets it: wider, the expansion would leave the goal.
            for (i, variance) in variances.iter().enumerate() {
                mode.hessian[i][i] += 1.0 / variance - density.stiffness[i];
            }
        }
        let Some(proposal) = LaplaceProposal::new(&mode) else {
            return (self.particle(mode.angles_rad), 0.0);
        };
        let draw = proposal.draw(self.model.skeleton().limits(), stream);
        let there = density.posture(&draw.angles_rad);
        let particle = Particle {
            angles_rad: draw.angles_rad,
            elbow_m: there.ends[UPPER_ARM],
            hand_m: there.ends[FOREARM],
            driver: None,
        };
        if !pays {
            return (particle, 0.0);
        }
        let log_density = density.log_density(&draw.angles_rad, &there);
        (particle, proposal.log_importance_ratio(&draw, log_density, LimitMass::Neglected))
    }

    /// Poses whose hand is at the goal: with the elbow as near to the ancestor's as can be, and with a hanging elbow.
    fn starts(&self, ancestor: &Particle, goal_m: &Vec3) -> [[f32; ARM_ANGLES]; 2] {
        let geometry = self.model.geometry();
        let hand_m = self.reachable.nearest(goal_m);
        let hanging_m = self.shoulder_m - geometry.up() * geometry.upper_arm_m;
        [ancestor.elbow_m, hanging_m].map(|wanted_m| {
            let elbow_m = nearest_elbow(&self.shoulder_m, &hand_m, geometry.upper_arm_m, geometry.forearm_m, &wanted_m);
            let (elbow, hand) = (elbow_m - self.shoulder_m, hand_m - self.shoulder_m);
            geometry.angles_from_joints(&elbow, &hand, &ancestor.angles_rad)
        })
    }

    fn particle(&self, angles_rad: [f32; ARM_ANGLES]) -> Particle {
        let (elbow_m, hand_m) = self.model.elbow_and_hand(&self.shoulder_m, &angles_rad);
        Particle { angles_rad, elbow_m, hand_m, driver: None }
    }
}
