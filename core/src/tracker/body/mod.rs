//! The body tracker: particles of whole poses, weighed by a frame's 3D points (PIK paper, sections
//! 5 to 7).
//!
//! [`BodyScene`](crate::pik::motion::BodyScene) is what does not change, a
//! [`BodyMotion`](crate::pik::motion::BodyMotion) says how particles move, [`BodyTracker`] is the
//! state. A frame goes in as a [`BodyFrame`], a [`BodyEstimate`] comes out, for every frame.
//!
//! ```
//! use sinew_core::math::Vec3;
//! use sinew_core::observation::point_cloud::PointCloud;
//! use sinew_core::observation::point_likelihood::PointLikelihood;
//! use sinew_core::pik::goal::LinearExtrapolation;
//! use sinew_core::pik::guided::GuidedMotion;
//! use sinew_core::pik::motion::{BodyParticle, BodyScene};
//! use sinew_core::pik::processes::extrapolation::LinearGoals;
//! use sinew_core::pik::root::RootProcess;
//! use sinew_core::random::Stream;
//! use sinew_core::skeleton::BodyMeasures;
//! use sinew_core::skeleton::full_body::{BODY_ANGLES, BODY_BONES, FOREARMS, HEAD, body_radii_m, full_body};
//! use sinew_core::tracker::body::{BodyFrame, BodyTracker, DEFAULT_BODY_OPTIONS};
//!
//! let measures = BodyMeasures::of_height(1.75)?;
//! let scene = BodyScene {
//!     skeleton: full_body(&measures)?,
//!     radii_m: body_radii_m(&measures),
//!     camera_m: Vec3::zeros(),
//!     likelihood: PointLikelihood { std_m: 0.15, outlier_m: 0.25 },
//!     self_penetration: None,
//! };
//! // Someone 3 m away who bends the right elbow (coordinate 19), and points on the skin that the camera sees.
//! let truth = |frame: usize| {
//!     let mut pose = [0.0; BODY_ANGLES];
//!     (pose[2], pose[16], pose[19]) = (3.0, 0.5, 0.5 + 0.05 * frame as f32);
//!     pose
//! };
//! let points = |frame: usize| {
//!     let surface = scene.surface(&scene.posture(&truth(frame)));
//!     let mut stream = Stream::new(7, frame as u64, 0);
//!     let mut points_m: Vec<Vec3> = Vec::new();
//!     for seen in surface.capsules.iter().cycle().take(800) {
//!         let axis_m = seen.capsule.start_m + seen.along_m * stream.uniform();
//!         let out = stream.normal3().normalize();
//!         points_m.push(axis_m + (if out.dot(&axis_m) > 0.0 { -out } else { out }) * seen.capsule.radius_m);
//!     }
//!     let mut cloud = PointCloud::<50>::new();
//!     let _ = cloud.set(&mut points_m, &scene.camera_m);
//!     cloud
//! };
//!
//! let process = LinearExtrapolation { persistence: 0.5, std_m_per_sqrt_s: 0.3 };
//! let goals = LinearGoals::new(&[HEAD, FOREARMS[0], FOREARMS[1]], BODY_BONES, process, 0.05)?;
//! let motion = GuidedMotion {
//!     process: &goals,
//!     root: RootProcess::FIXED,
//!     angle_std_rad_per_sqrt_s: [1.0; BODY_ANGLES],
//!     angle_persistence: 0.0,
//!     solver_steps: 2,
//!     pulling_blocks: 32,
//!     refining_steps: 2,
//! };
//! let first = BodyParticle::at(&scene.skeleton, truth(0));
//! let memory = (vec![first; 20], vec![first; 20]);
//! let mut tracker = BodyTracker::<BODY_BONES, BODY_ANGLES, 20, _>::new(&first, memory, DEFAULT_BODY_OPTIONS, 1)?;
//! for frame in 1..10 {
//!     let cloud = points(frame);
//!     let estimate = tracker.step(&scene, &motion, &BodyFrame { dt_s: 1.0 / 15.0, blocks: cloud.blocks() });
//!     let hand_m = scene.posture(&truth(frame)).ends[FOREARMS[1]];
//!     assert!((estimate.ends_m[FOREARMS[1]] - hand_m).norm() < 0.1);
//! }
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

mod alignment;
mod deadband;
mod estimate;
mod exchange;
mod expect;
mod frame;
mod legs;
mod mean_rotation;
pub mod modes;
mod observed;
mod options;
mod pace;
mod propose;
mod resample;
mod reshape;
mod rival;
mod rival_step;
mod saved;
mod state;
mod step;
mod tempering;
#[cfg(test)]
mod tests;
pub mod upper;
mod velocity;
mod weigh;

pub use alignment::RootAlignment;
pub use estimate::BodyEstimate;
pub use frame::BodyFrame;
pub use legs::Legs;
pub use mean_rotation::{angles_of_rotation, mean_rotation};
pub use options::{BodyOptions, DEFAULT_BODY_OPTIONS};
pub use pace::SpeedScaledNoise;
pub use propose::Advance;
pub use rival::RivalOptions;
pub use state::BodyTracker;
