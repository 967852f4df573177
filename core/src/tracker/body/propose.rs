//! One particle of the new set: an ancestor moved on and weighed.

use crate::observation::limb_likelihood::ExpectedBody;
use crate::pik::motion::{BodyMotion, BodyParticle, FramePast};
use crate::random::Stream;
use crate::skeleton::limbs::TRUNK_GROUP;

/// What is needed to move and weigh any particle of a frame, in any order, on any thread.
///
/// ```
/// use sinew_core::tracker::body::{BodyFrame, BodyTracker, DEFAULT_BODY_OPTIONS};
/// # use sinew_core::pik::guided::GuidedMotion;
/// # use sinew_core::pik::motion::{BodyParticle, BodyScene};
/// # use sinew_core::pik::{goal::LinearExtrapolation, processes::extrapolation::LinearGoals, root::RootProcess};
/// # use sinew_core::skeleton::arm::FOREARM;
/// # use sinew_core::math::Vec3;
/// # use sinew_core::observation::{point_cloud::PointCloud, point_likelihood::PointLikelihood};
/// # use sinew_core::skeleton::{ArmGeometry, Side};
/// # let skeleton = ArmGeometry::new(Side::Left, 0.30, 0.35)?.skeleton()?;
/// # let likelihood = PointLikelihood { std_m: 0.05, outlier_m: 0.15 };
/// # let camera_m = Vec3::new(0.0, 0.0, -2.0);
/// # let scene = BodyScene { skeleton, radii_m: [0.05, 0.04], camera_m, likelihood, self_penetration: None };
/// # let points_of = |pose: &[f32; 4]| {
/// #     let surface = scene.surface(&scene.posture(pose));
/// #     let mut points_m = core::array::from_fn::<Vec3, 32, _>(|i| {
/// #         let bone = &surface.capsules[i % 2].capsule;
/// #         let place_m = bone.start_m + (bone.end_m - bone.start_m) * (i as f32 / 32.0);
/// #         bone.nearest_visible(&scene.camera_m, &(place_m - Vec3::z()))
/// #     });
/// #     let mut cloud = PointCloud::<2>::new();
/// #     let _ = cloud.set(&mut points_m, &scene.camera_m);
/// #     cloud
/// # };
/// # let process = LinearExtrapolation { persistence: 0.5, std_m_per_sqrt_s: 0.3 };
/// # let goals = LinearGoals::new(&[FOREARM], 2, process, 0.05)?;
/// # let (process, root, angle_std_rad_per_sqrt_s) = (&goals, RootProcess::FIXED, [1.0; 4]);
/// # let (solver_steps, pulling_blocks, angle_persistence) = (3, 2, 0.0);
/// # let motion =
/// #     GuidedMotion { process, root, angle_std_rad_per_sqrt_s, angle_persistence, solver_steps, pulling_blocks };
/// # let truth = |frame: usize| [0.5, 0.1, 0.1, 1.0 + 0.05 * frame as f32];
/// # let first = BodyParticle::at(&scene.skeleton, truth(0));
///
/// # let new =
/// #     || BodyTracker::<2, 4, 30, _>::new(&first, ([first; 30], [first; 30]), DEFAULT_BODY_OPTIONS, 1);
/// // Particles in any order, or on any thread: each has its own random numbers, so the answer is the same to the bit.
/// let cloud = points_of(&truth(1));
/// let frame = BodyFrame { dt_s: 1.0 / 15.0, blocks: cloud.blocks() };
/// let backwards = new()?.step_with(&scene, &motion, &frame, |advance, particles| {
///     for (index, slot) in particles.iter_mut().enumerate().rev() {
///         advance.particle(index, slot);
///     }
/// });
/// assert_eq!(backwards, new()?.step(&scene, &motion, &frame));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug)]
pub struct Advance<'a, M, const BONES: usize, const ANGLES: usize> {
    pub(super) motion: &'a M,
    pub(super) past: FramePast<'a, BONES, ANGLES>,
    pub(super) ancestors: &'a [u16],
    pub(super) particles: &'a [BodyParticle<BONES, ANGLES>],
    pub(super) expected: &'a ExpectedBody<BONES>,
    pub(super) seed: u64,
    pub(super) frame: u64,
}

impl<M: BodyMotion<BONES, ANGLES>, const BONES: usize, const ANGLES: usize> Advance<'_, M, BONES, ANGLES> {
    /// Makes particle `index` of the new set, with its log-weights: that of the whole pose, then of each limb.
    pub fn particle(&self, index: usize, slot: &mut BodyParticle<BONES, ANGLES>) {
        let ancestor = self.ancestors.get(index).and_then(|&ancestor| self.particles.get(usize::from(ancestor)));
        let Some(ancestor) = ancestor else { return };
        let mut stream = Stream::new(self.seed, self.frame, index as u32);
        let mut memory = ancestor.memory;
        let proposed = self.motion.propose(&self.past, ancestor, &mut memory, &mut stream);
        let scene = self.past.scene;
        let mut log_weights = scene.log_weights(&scene.surface(&proposed.posture), self.past.blocks, self.expected);
        log_weights[TRUNK_GROUP] += proposed.log_ratio;
        *slot = BodyParticle { angles_rad: proposed.angles_rad, ends_m: proposed.posture.ends, memory, log_weights };
    }
}
