//! Proposals: where each particle's arm goes, by variant.

use super::context::FrameContext;
use super::importance;
use super::particle::Particle;
use super::variant::PoseRule;
use crate::camera::Ray;
use crate::correction::elbow::nearest_elbow;
use crate::correction::hand::draw_on_ray;
use crate::kinematics::inverse::{Goal, PoseDensity, PoseObjective, Solve};
use crate::math::{Mat3, Vec3, clamp, length, unit};
use crate::pik::goal::LinearExtrapolation;
use crate::pik::proposal::{LaplaceProposal, LimitMass};
use crate::random::Stream;
use crate::skeleton::arm::{ARM_ANGLES, FOREARM, UPPER_ARM};

/// Greatest part of a corrected weight that the importance ratio of the pose may decide. The
/// expansion's tails are thinner than those of the density, so without a bound rare draws take the
/// whole weight, more so with more particles. Chosen: a factor of twenty.
const MAX_LOG_RATIO: f32 = 3.0;

/// A particle before it is weighted.
pub(super) struct Proposed {
    pub particle: Particle,
    /// Distance from the particle's own extrapolation to where a blob sent its hand; zero where
    /// none did.
    pub jump_m: f32,
    /// Where the forearm was thought to point when the depth was drawn, a unit vector.
    pub supposed_forearm: Vec3,
    /// ln of the importance ratio of goal and pose where the weight is corrected (`pik-weighted`),
    /// else zero.
    pub log_importance: f32,
}

impl FrameContext<'_> {
    /// Moves `ancestor` on; `driver` is the candidate that its hand is sent to.
    pub fn propose(&self, ancestor: &Particle, driver: Option<usize>, stream: &mut Stream) -> Proposed {
        let traits = self.model.options().variant.traits();
        let mut proposed = match traits.pose {
            PoseRule::NearestElbow => self.propose_by_joints(ancestor, driver, stream),
            PoseRule::InverseKinematics if traits.corrects_weight => self.propose_weighted(ancestor, driver, stream),
            PoseRule::InverseKinematics => self.propose_by_goal(ancestor, driver, stream),
        };
        proposed.particle.driver = driver.map(|index| index as u8);
        proposed
    }

    /// The arm paper: elbow and hand by a first-order linear model, made reachable. A driven hand
    /// is corrected on the ray and the elbow goes to the nearest point of its circle.
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
        Proposed { particle: self.particle(angles_rad), jump_m, supposed_forearm: fore, log_importance: 0.0 }
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
            return Proposed { particle, jump_m: 0.0, supposed_forearm: ancestor.forearm(), log_importance: 0.0 };
        };
        let goal_m = self.reachable.along_ray(&draw_on_ray(&mean_m, &ray, &spread, stream), &ray);
        let (particle, _) = self.pose_for(ancestor, &self.driven_goal(goal_m, &ray), stream);
        let jump_m = length(&(particle.hand_m - extrapolated_m));
        Proposed { particle, jump_m, supposed_forearm: ancestor.forearm(), log_importance: 0.0 }
    }

    /// As [`Self::propose_by_goal`], but goals stay as drawn and the weight has their importance
    /// ratio.
    fn propose_weighted(&self, ancestor: &Particle, driver: Option<usize>, stream: &mut Stream) -> Proposed {
        let process = self.hand_process();
        let extrapolated_m = process.mean(&ancestor.hand_m, &self.hand_velocity_m_per_s, self.dt_s);
        let goal_m = match driver.and_then(|index| self.corrected_hand(&extrapolated_m, &ancestor.forearm(), index)) {
            Some((mean_m, ray, spread)) => draw_on_ray(&mean_m, &ray, &spread, stream),
            None => importance::draw_transition(self, &extrapolated_m, stream),
        };
        let log_goal = importance::log_transition(self, &extrapolated_m, &goal_m)
            - importance::log_proposal(self, &extrapolated_m, &ancestor.forearm(), &goal_m);
        let (particle, log_ratio) = self.pose_for(ancestor, &self.weighted_goal(goal_m), stream);
        let log_importance = log_goal + clamp(log_ratio, -MAX_LOG_RATIO, MAX_LOG_RATIO);
        Proposed { particle, jump_m: 0.0, supposed_forearm: ancestor.forearm(), log_importance }
    }

    /// A goal that is wanted alike in all directions.
    fn free_goal(&self, position_m: Vec3) -> Goal {
        let std_m = self.model.options().reach_std_m;
        Goal { bone: FOREARM, position_m, precision: Mat3::identity() / (std_m * std_m) }
    }

    /// A goal of a blob or of the transition alike, so that both have the same pose density. It is
    /// reached with the geometric mean of both spreads. Were it much wider than a blob's error, the
    /// blob term would let hardly any draw survive.
    fn weighted_goal(&self, position_m: Vec3) -> Goal {
        let options = self.model.options();
        let precision = Mat3::identity() / (options.reach_std_m * options.reach_across_std_m);
        Goal { bone: FOREARM, position_m, precision }
    }

    /// A goal that is wanted more closely across the ray than along it: where limits forbid its
    /// depth, the hand slides along the ray.
    fn driven_goal(&self, position_m: Vec3, ray: &Ray) -> Goal {
        let options = self.model.options();
        let axis = [ray.direction.x, ray.direction.y, ray.direction.z];
        let along = Mat3::from(axis.map(|factor| axis.map(|entry| entry * factor)));
        let precision = (Mat3::identity() - along) / (options.reach_across_std_m * options.reach_across_std_m)
            + along / (options.reach_std_m * options.reach_std_m);
        Goal { bone: FOREARM, position_m, precision }
    }

    /// Mode and Laplace draw for one goal, with the log importance ratio of the draw where the
    /// weight is corrected.
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
        let corrects_weight = options.variant.traits().corrects_weight;
        if !corrects_weight {
            // The draw spreads as far as a frame's stiffness lets it: wider, the expansion would
            // leave the goal.
            for i in 0..ARM_ANGLES {
                mode.hessian[i][i] += 1.0 / variances[i] - density.stiffness[i];
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
        if !corrects_weight {
            return (particle, 0.0);
        }
        let log_density = density.log_density(&draw.angles_rad, &there);
        (particle, proposal.log_importance_ratio(&draw, log_density, LimitMass::Neglected))
    }

    /// Poses whose hand is at the goal: with the elbow as near to the ancestor's as can be, and
    /// with a hanging elbow.
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
