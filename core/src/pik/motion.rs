//! What a motion model does for one particle.

use super::goal::{GoalMemory, GoalPast, MEMORY};
use super::root::RootProcess;
use crate::kinematics::forward::{Posture, posture};
use crate::math::Vec3;
use crate::observation::body_surface::BodySurface;
use crate::observation::limb_likelihood::{ExpectedBody, GroupLogs};
use crate::observation::point_cloud::PointBlock;
use crate::observation::point_likelihood::PointLikelihood;
use crate::observation::self_penetration::SelfPenetration;
use crate::random::Stream;
use crate::skeleton::Skeleton;
use crate::skeleton::limbs::{MAX_GROUPS, TRUNK_GROUP};
use crate::skeleton::tree::FREE_ROOT_COORDINATES;

/// One hypothesis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyParticle<const BONES: usize, const ANGLES: usize> {
    /// Coordinates of the pose: shifts of a free root in metres, angles in radians.
    pub angles_rad: [f32; ANGLES],
    /// Ends of all bones in this pose, metres.
    pub ends_m: [Vec3; BONES],
    /// What the motion model keeps.
    pub memory: GoalMemory,
    /// Log-weights by the last frame's points: of the whole pose in the trunk's place, then of each limb.
    pub log_weights: GroupLogs,
}

impl<const BONES: usize, const ANGLES: usize> BodyParticle<BONES, ANGLES> {
    /// A particle at one pose, with nothing in its memory.
    #[must_use]
    pub fn at(skeleton: &Skeleton<BONES, ANGLES>, angles_rad: [f32; ANGLES]) -> Self {
        let angles_rad = skeleton.clamp(angles_rad);
        let ends_m = posture(skeleton, &Vec3::zeros(), &angles_rad).ends;
        Self { angles_rad, ends_m, memory: [0.0; MEMORY], log_weights: [0.0; MAX_GROUPS] }
    }
}

/// What does not change from frame to frame.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyScene<const BONES: usize, const ANGLES: usize> {
    /// The body.
    pub skeleton: Skeleton<BONES, ANGLES>,
    /// Radii of the bones' capsules, metres; zero for a bone without flesh.
    pub radii_m: [f32; BONES],
    /// Camera centre, metres.
    pub camera_m: Vec3,
    /// Robust metric of the points.
    pub likelihood: PointLikelihood,
    /// What limbs in limbs cost; `None` lets them pass through one another.
    pub self_penetration: Option<SelfPenetration<BONES>>,
}

impl<const BONES: usize, const ANGLES: usize> BodyScene<BONES, ANGLES> {
    /// The posture of a pose.
    #[must_use]
    pub fn posture(&self, angles_rad: &[f32; ANGLES]) -> Posture<BONES, ANGLES> {
        posture(&self.skeleton, &Vec3::zeros(), angles_rad)
    }

    /// log weights of a pose by its surface: the points' likelihood and what limbs in limbs cost in the trunk's place, then each limb's own
    /// part of both, about the body that `expected` has.
    #[must_use]
    pub fn log_weights(
        &self,
        surface: &BodySurface<BONES>,
        blocks: &[PointBlock],
        expected: &ExpectedBody<BONES>,
    ) -> GroupLogs {
        let mut logs = [0.0; MAX_GROUPS];
        if expected.limbs().count() > 1 {
            logs = expected.log_weights(&self.likelihood, surface, blocks);
        } else {
            logs[TRUNK_GROUP] = self.likelihood.log_likelihood(surface, blocks);
        }
        if let Some(density) = &self.self_penetration {
            let apart = density.log_densities(surface, expected.limbs());
            for (log, apart) in logs.iter_mut().zip(apart) {
                *log += apart;
            }
        }
        logs
    }

    /// The surface of a posture.
    #[must_use]
    pub fn surface(&self, posture: &Posture<BONES, ANGLES>) -> BodySurface<BONES> {
        BodySurface::new(posture, &self.radii_m, self.camera_m)
    }
}

/// What all particles of a frame share.
#[derive(Debug, Clone, Copy)]
pub struct FramePast<'a, const BONES: usize, const ANGLES: usize> {
    /// The body and its camera.
    pub scene: &'a BodyScene<BONES, ANGLES>,
    /// The frame's points.
    pub blocks: &'a [PointBlock],
    /// Velocities of the coordinates by the filter's estimates, a second.
    pub angle_velocity_per_s: [f32; ANGLES],
    /// What the coordinates of a free root are expected to change by, for every particle alike.
    pub root_change: [f32; FREE_ROOT_COORDINATES],
    /// Velocities of the bones' ends by the filter's estimates, metres a second.
    pub velocity_m_per_s: &'a [Vec3; BONES],
    /// Ends of all bones in the first pose, metres.
    pub first_m: &'a [Vec3; BONES],
    /// Time since the frame before, seconds.
    pub dt_s: f32,
    /// Whether this is the first step.
    pub is_first: bool,
}

impl<'a, const BONES: usize, const ANGLES: usize> FramePast<'a, BONES, ANGLES> {
    /// How far a free root is expected to go, metres.
    #[must_use]
    pub fn root_shift_m(&self) -> Vec3 {
        let mut shift_m = Vec3::zeros();
        if let Some(root) = self.scene.skeleton.bones().first() {
            for (axis, change) in root.joint.axes().iter().zip(&self.root_change).take(root.joint.shift_count()) {
                shift_m += axis * *change;
            }
        }
        shift_m
    }

    /// What the goals of `ancestor` may follow from.
    #[must_use]
    pub fn goals_of(&self, ancestor: &'a BodyParticle<BONES, ANGLES>) -> GoalPast<'a, BONES> {
        GoalPast {
            reached_m: &ancestor.ends_m,
            velocity_m_per_s: self.velocity_m_per_s,
            first_m: self.first_m,
            root_shift_m: self.root_shift_m(),
            dt_s: self.dt_s,
            is_first: self.is_first,
        }
    }
}

/// A particle moved on, not yet weighed by the points.
#[derive(Debug, Clone, Copy)]
pub struct Proposed<const BONES: usize, const ANGLES: usize> {
    /// Its pose, inside the limits.
    pub angles_rad: [f32; ANGLES],
    /// Its posture.
    pub posture: Posture<BONES, ANGLES>,
    /// ln of transition over proposal, eq. (18).
    pub log_ratio: f32,
}

/// A motion model: how a particle moves on.
pub trait BodyMotion<const BONES: usize, const ANGLES: usize> {
    /// The root's own process.
    fn root(&self) -> &RootProcess;

    /// Moves `ancestor` on by one frame; `memory` holds the ancestor's and keeps the new particle's.
    fn propose(
        &self,
        past: &FramePast<'_, BONES, ANGLES>,
        ancestor: &BodyParticle<BONES, ANGLES>,
        memory: &mut GoalMemory,
        stream: &mut Stream,
    ) -> Proposed<BONES, ANGLES>;
}
