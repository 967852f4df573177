//! What goes into a step.

use crate::observation::point_cloud::PointBlock;

/// One frame.
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
/// # let sets = ([first; 30], [first; 30]);
/// # let mut tracker = BodyTracker::<2, 4, 30, _>::new(&first, sets, DEFAULT_BODY_OPTIONS, 1)?;
/// let cloud = points_of(&truth(1));
/// let seen = tracker.step(&scene, &motion, &BodyFrame { dt_s: 1.0 / 15.0, blocks: cloud.blocks() });
/// // No points for a third of a second: an ordinary frame, of which nobody learns anything.
/// let unseen = tracker.step(&scene, &motion, &BodyFrame { dt_s: 1.0 / 3.0, blocks: &[] });
/// assert_eq!(unseen.observed, [false; 2]);
/// assert!(unseen.spread_m[FOREARM] > seen.spread_m[FOREARM], "and the particles know less");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct BodyFrame<'a> {
    /// Time since the frame before, seconds; frames that were dropped are simply not given.
    pub dt_s: f32,
    /// The points; none is a frame without evidence.
    pub blocks: &'a [PointBlock],
}
