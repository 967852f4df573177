//! What goes into a step.

use crate::observation::point_cloud::PointBlock;

/// One frame.
///
/// ```
/// use sinew_core::pik::example::{arm_points, arm_scene, bending_elbow, guided_arm, hand_goals};
/// use sinew_core::pik::motion::BodyParticle;
/// use sinew_core::skeleton::arm::FOREARM;
/// use sinew_core::tracker::body::{BodyFrame, BodyTracker, DEFAULT_BODY_OPTIONS};
///
/// let (scene, goals) = (arm_scene()?, hand_goals()?);
/// let motion = guided_arm(&goals);
/// let first = BodyParticle::at(&scene.skeleton, bending_elbow(0));
/// let sets = ([first; 30], [first; 30]);
/// let mut tracker = BodyTracker::<2, 4, 30, _>::new(&first, sets, DEFAULT_BODY_OPTIONS, 1)?;
/// let cloud = arm_points(&scene, &bending_elbow(1));
/// let seen = tracker.step(&scene, &motion, &BodyFrame { dt_s: 1.0 / 15.0, blocks: cloud.blocks() });
/// // No points for a third of a second: an ordinary frame, that has no evidence.
/// let unseen = tracker.step(&scene, &motion, &BodyFrame { dt_s: 1.0 / 3.0, blocks: &[] });
/// assert_eq!(unseen.observed, [false; 2]);
/// assert!(unseen.spread_m[FOREARM] > seen.spread_m[FOREARM], "and the particles know less");
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct BodyFrame<'a> {
    /// Time since the frame before, seconds; frames that were dropped are simply not given. Not a
    /// number, no time, or time that runs back counts as the shortest time.
    pub dt_s: f32,
    /// The points; none is a frame without evidence. A frame with a block that no
    /// [`PointCloud`](crate::observation::point_cloud::PointCloud) holds counts as one without
    /// points.
    pub blocks: &'a [PointBlock],
}
