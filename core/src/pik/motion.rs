//! What a motion model does for one particle.

use super::goal::{GoalMemory, GoalPast, MEMORY};
use super::root::RootProcess;
use crate::kinematics::forward::{Posture, posture};
use crate::math::{Vec3, sqrt};
use crate::observation::body_surface::BodySurface;
use crate::observation::limb_likelihood::{ExpectedBody, GroupLogs};
use crate::observation::point_cloud::PointBlock;
use crate::observation::point_likelihood::PointLikelihood;
use crate::observation::self_penetration::SelfPenetration;
use crate::random::Stream;
use crate::skeleton::Skeleton;
use crate::skeleton::limbs::{MAX_GROUPS, TRUNK_GROUP};

/// One hypothesis.
///
/// ```
/// use sinew_core::pik::motion::BodyParticle;
/// use sinew_core::skeleton::arm::{FOREARM, UPPER_ARM};
/// use sinew_core::skeleton::{ArmGeometry, Side};
///
/// // An elbow does not bend backwards: the particle begins at the nearest legal pose, with the ends of its bones.
/// let arm = ArmGeometry::new(Side::Left, 0.30, 0.35)?.skeleton()?;
/// let particle = BodyParticle::at(&arm, [0.5, 0.1, 0.1, -0.4]);
/// assert_eq!(particle.angles_rad, [0.5, 0.1, 0.1, 0.0]);
/// assert!(((particle.ends_m[FOREARM] - particle.ends_m[UPPER_ARM]).norm() - 0.35).abs() < 1e-5);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyParticle<const BONES: usize, const ANGLES: usize> {
    /// Coordinates of the pose: shifts of a free root in metres, angles in radians.
    pub angles_rad: [f32; ANGLES],
    /// Ends of all bones in this pose, metres.
    pub ends_m: [Vec3; BONES],
    /// What the motion model keeps.
    pub memory: GoalMemory,
    /// Log-weights by the last frame's points: of the whole pose in the trunk's place, then of each
    /// limb.
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
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::observation::point_likelihood::PointLikelihood;
/// use sinew_core::observation::self_penetration::SelfPenetration;
/// use sinew_core::pik::motion::BodyScene;
/// use sinew_core::skeleton::BodyMeasures;
/// use sinew_core::skeleton::full_body::{BODY_ANGLES, body_radii_m, full_body};
///
/// let measures = BodyMeasures::of_height(1.75)?;
/// let (skeleton, radii_m) = (full_body(&measures)?, body_radii_m(&measures));
/// let scene = BodyScene {
///     self_penetration: Some(SelfPenetration::new(&skeleton, &radii_m, 0.02)?),
///     skeleton,
///     radii_m,
///     camera_m: Vec3::zeros(),
///     likelihood: PointLikelihood { std_m: 0.15, outlier_m: 0.25 },
/// };
/// // Three metres away; the camera sees 16 bones with flesh, the nearest skin of which is the toes'.
/// let mut pose = [0.0; BODY_ANGLES];
/// pose[2] = 3.0;
/// let surface = scene.surface(&scene.posture(&pose));
/// assert_eq!(surface.capsules.len(), 16);
/// assert!(surface.skin_distance_m(&scene.camera_m) > 2.5);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
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

    /// log weights of a pose by its surface, about the body that `expected` has. In the trunk's
    /// place stand the points' likelihood and what limbs in limbs cost. Then follows each limb's
    /// own part of both.
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
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::pik::example::arm_scene;
/// use sinew_core::pik::motion::{BodyParticle, FramePast};
///
/// let scene = arm_scene()?;
/// let ancestor = BodyParticle::at(&scene.skeleton, [0.5, 0.1, 0.1, 1.0]);
/// let past = FramePast {
///     scene: &scene,
///     blocks: &[],
///     angle_velocity_per_s: [0.0; 4],
///     shared_change: [None; 4],
///     velocity_m_per_s: &[Vec3::zeros(); 2],
///     noise_share: &[1.0; 2],
///     first_m: &ancestor.ends_m,
///     dt_s: 0.1,
///     is_first: true,
/// };
/// // What goals may follow from: the places that this particle reached.
/// assert_eq!(past.goals_of(&ancestor).reached_m, &ancestor.ends_m);
/// assert_eq!(past.root_shift_m(), Vec3::zeros(), "this root is not free");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct FramePast<'a, const BONES: usize, const ANGLES: usize> {
    /// The body and its camera.
    pub scene: &'a BodyScene<BONES, ANGLES>,
    /// The frame's points.
    pub blocks: &'a [PointBlock],
    /// Velocities of the coordinates by the filter's estimates, a second.
    pub angle_velocity_per_s: [f32; ANGLES],
    /// What a coordinate changes by for every particle alike, before its noise. It is set for the
    /// coordinates of a free root, and of the trunk where it is fitted to the points. `None` leaves
    /// it to the motion model.
    pub shared_change: [Option<f32>; ANGLES],
    /// Velocities of the bones' ends by the filter's estimates, metres a second.
    pub velocity_m_per_s: &'a [Vec3; BONES],
    /// Share of the motion model's noise that each bone has in this frame: its joint's angles, and
    /// a goal of its end. One is all of it; a limb at rest may have less, an unobserved one
    /// more.
    pub noise_share: &'a [f32; BONES],
    /// Ends of all bones in the first pose, metres.
    pub first_m: &'a [Vec3; BONES],
    /// Time since the frame before, seconds.
    pub dt_s: f32,
    /// Whether this is the first step.
    pub is_first: bool,
}

impl<'a, const BONES: usize, const ANGLES: usize> FramePast<'a, BONES, ANGLES> {
    /// What coordinate `index` changes by on the mean: what all particles share, else `persistence`
    /// of the filter's velocity.
    #[must_use]
    pub fn change(&self, index: usize, persistence: f32) -> f32 {
        let own = |velocity_per_s: &f32| persistence * velocity_per_s * self.dt_s;
        let shared = self.shared_change.get(index).copied().flatten();
        shared.unwrap_or_else(|| self.angle_velocity_per_s.get(index).map_or(0.0, own))
    }

    /// Standard deviations of all angles over this frame, radians, of a model with these after one
    /// second.
    #[must_use]
    pub fn angle_std_rad(&self, std_rad_per_sqrt_s: &[f32; ANGLES]) -> [f32; ANGLES] {
        let root_of_time = sqrt(self.dt_s);
        core::array::from_fn(|index| {
            let bone = self.scene.skeleton.bone_of_angle(index);
            std_rad_per_sqrt_s[index] * self.noise_share.get(bone).copied().unwrap_or(1.0) * root_of_time
        })
    }

    /// How far a free root is expected to go, metres.
    #[must_use]
    pub fn root_shift_m(&self) -> Vec3 {
        let mut shift_m = Vec3::zeros();
        if let Some(root) = self.scene.skeleton.bones().first() {
            for (axis, change) in root.joint.axes().iter().zip(&self.shared_change).take(root.joint.shift_count()) {
                shift_m += axis * change.unwrap_or(0.0);
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
            noise_share: self.noise_share,
            first_m: self.first_m,
            root_shift_m: self.root_shift_m(),
            dt_s: self.dt_s,
            is_first: self.is_first,
        }
    }
}

/// A pose that was climbed to.
///
/// ```
/// use sinew_core::pik::example::{arm_past, arm_points, arm_scene, guided_arm, hand_goals};
/// use sinew_core::pik::guided::GuidedMotion;
/// use sinew_core::pik::motion::{BodyMotion, BodyParticle};
///
/// let (scene, goals) = (arm_scene()?, hand_goals()?);
/// let motion = GuidedMotion { refining_steps: 3, ..guided_arm(&goals) };
/// let cloud = arm_points(&scene, &[0.5, 0.1, 0.1, 1.1]);
/// let before = BodyParticle::at(&scene.skeleton, [0.5, 0.1, 0.1, 1.0]);
/// let past = arm_past(&scene, &before, cloud.blocks());
/// // From where the pose is expected, and from the true one.
/// let found = motion.climb(&past, &before, None).expect("the guided model climbs");
/// let from_truth = motion.climb(&past, &before, Some(&[0.5, 0.1, 0.1, 1.1])).expect("as before");
/// assert!((found.angles_rad[3] - 1.1).abs() < 0.05);
/// assert!((found.log_density - from_truth.log_density).abs() < 1.0);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Climbed<const ANGLES: usize> {
    /// Coordinates of the pose.
    pub angles_rad: [f32; ANGLES],
    /// Log density there, up to a constant of the frame.
    pub log_density: f32,
}

/// A particle moved on, not yet weighed by the points.
///
/// ```
/// use sinew_core::pik::angular::AngularMotion;
/// use sinew_core::pik::example::{arm_past, arm_scene};
/// use sinew_core::pik::goal::MEMORY;
/// use sinew_core::pik::motion::{BodyMotion, BodyParticle};
/// use sinew_core::pik::root::RootProcess;
/// use sinew_core::random::Stream;
///
/// let scene = arm_scene()?;
/// let ancestor = BodyParticle::at(&scene.skeleton, [0.5, 0.1, 0.1, 1.0]);
/// let past = arm_past(&scene, &ancestor, &[]);
/// let motion = AngularMotion {
///     root: RootProcess::FIXED,
///     persistence: 1.0,
///     angle_std_rad_per_sqrt_s: [1.0; 4],
///     own_velocity: false,
/// };
///
/// let proposed = motion.propose(&past, &ancestor, &mut [0.0; MEMORY], &mut Stream::new(1, 0, 0));
/// assert_eq!(scene.skeleton.clamp(proposed.angles_rad), proposed.angles_rad, "inside the limits");
/// assert_eq!(proposed.posture, scene.posture(&proposed.angles_rad), "where the bones are");
/// assert_eq!(proposed.log_ratio, 0.0, "drawn from the motion itself: no importance ratio");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Proposed<const BONES: usize, const ANGLES: usize> {
    /// Its pose, inside the limits.
    pub angles_rad: [f32; ANGLES],
    /// Its posture.
    pub posture: Posture<BONES, ANGLES>,
    /// ln of transition over proposal, PIK (18).
    pub log_ratio: f32,
}

/// A motion model: how a particle moves on.
///
/// ```
/// use sinew_core::pik::example::{arm_past, arm_scene};
/// use sinew_core::pik::goal::{GoalMemory, MEMORY};
/// use sinew_core::pik::motion::{BodyMotion, BodyParticle, FramePast, Proposed};
/// use sinew_core::pik::root::RootProcess;
/// use sinew_core::random::Stream;
///
/// let scene = arm_scene()?;
/// let ancestor = BodyParticle::at(&scene.skeleton, [0.5, 0.1, 0.1, 1.0]);
/// let past = arm_past(&scene, &ancestor, &[]);
/// /// An arm of which only the elbow moves, by a random walk.
/// struct ElbowWalk;
///
/// impl BodyMotion<2, 4> for ElbowWalk {
///     fn root(&self) -> &RootProcess {
///         &RootProcess::FIXED
///     }
///
///     fn propose(
///         &self,
///         past: &FramePast<'_, 2, 4>,
///         ancestor: &BodyParticle<2, 4>,
///         _memory: &mut GoalMemory,
///         stream: &mut Stream,
///     ) -> Proposed<2, 4> {
///         let [elevation, deviation, rotation, elbow] = ancestor.angles_rad;
///         let drawn = [elevation, deviation, rotation, elbow + 0.2 * stream.normal()];
///         let angles_rad = past.scene.skeleton.clamp(drawn);
///         Proposed { angles_rad, posture: past.scene.posture(&angles_rad), log_ratio: 0.0 }
///     }
/// }
///
/// let moved = ElbowWalk.propose(&past, &ancestor, &mut [0.0; MEMORY], &mut Stream::new(1, 0, 0));
/// assert_eq!(moved.posture.ends[0], ancestor.ends_m[0], "the elbow stays in its place");
/// assert_ne!(moved.posture.ends[1], ancestor.ends_m[1]);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
pub trait BodyMotion<const BONES: usize, const ANGLES: usize> {
    /// The root's own process.
    fn root(&self) -> &RootProcess;

    /// Moves `ancestor` on by one frame; `memory` holds the ancestor's and keeps the new
    /// particle's.
    fn propose(
        &self,
        past: &FramePast<'_, BONES, ANGLES>,
        ancestor: &BodyParticle<BONES, ANGLES>,
        memory: &mut GoalMemory,
        stream: &mut Stream,
    ) -> Proposed<BONES, ANGLES>;

    /// The mode that is reported in place of the particles' mean, PIK (30), and its log density;
    /// `None` of a model that reports the mean. It climbs from `mean_rad`, or where there is none
    /// from what is expected after `before`, the pose of the frame before.
    fn climb(
        &self,
        past: &FramePast<'_, BONES, ANGLES>,
        before: &BodyParticle<BONES, ANGLES>,
        mean_rad: Option<&[f32; ANGLES]>,
    ) -> Option<Climbed<ANGLES>> {
        let _ = (past, before, mean_rad);
        None
    }
}
