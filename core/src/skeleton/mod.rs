//! Skeletons: rigid bones in a tree, their joints and limits. Immutable; poses are small arrays of
//! angles.
//!
//! ```
//! use sinew_core::math::Vec3;
//! use sinew_core::skeleton::full_body::{HEAD, full_body};
//! use sinew_core::skeleton::{BodyMeasures, Bone, Joint, Limit, Skeleton};
//!
//! // A person of 1.75 m, as a tree of rigid bones.
//! let person = full_body(&BodyMeasures::of_height(1.75)?)?;
//! assert!(person.angle_moves(2, HEAD), "a shift of the root moves everything");
//!
//! // A tree of your own: a lamp with two hinges.
//! let hinge = |parent, length_m: f32| Bone {
//!     parent,
//!     joint: Joint::Hinge(Vec3::z()),
//!     offset_m: Vec3::new(0.0, -length_m, 0.0),
//! };
//! let lamp = Skeleton::new(
//!     [hinge(None, 0.4), hinge(Some(0), 0.3)],
//!     [Limit::from_degrees(-90.0, 90.0); 2],
//! )?;
//! assert_eq!(lamp.bone_of_angle(1), 1);
//! assert_eq!(lamp.clamp([0.0, 3.0])[1], 90.0_f32.to_radians());
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

pub mod arm;
pub mod body_measures;
pub mod full_body;
pub mod limbs;
pub mod stick_figure;
pub mod tree;
pub mod upper_body;

pub use arm::{ArmGeometry, Side};
pub use body_measures::BodyMeasures;
pub use limbs::Limbs;
pub use stick_figure::{StickFigure, StickJoint};
pub use tree::{Bone, Joint, Limit, Skeleton};
