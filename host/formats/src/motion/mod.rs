//! Recorded and generated human motion: readers (BVH, ASF/AMC, exponential maps) and what an arm
//! tracker needs of it.
//!
//! A reader gives a [`Motion`], joint positions in metres over time. [`ArmMotion`] keeps of it the
//! directions of upper arm and forearm in the torso's frame, so that another body can perform it.

pub mod amc;
pub mod anthropometry;
pub mod arm_motion;
pub mod asf;
pub mod bvh;
pub mod c3d;
pub mod clips;
#[cfg(test)]
mod damaged_tests;
pub mod error;
pub mod exponential_map;
pub mod export;
mod figure;
mod given_names;
pub mod joint_names;
mod joint_table;
pub mod landmarks;
pub mod markers;
mod missing_joint;
mod name_forms;
pub mod reach;
pub mod read_options;
mod reading;
pub mod recording;
pub mod shortfall;
pub mod trc;

pub use arm_motion::{ArmDirections, ArmMotion, ArmSide};
pub use error::MotionError;
pub use markers::MarkerMotion;
pub use missing_joint::MissingJoint;
pub use read_options::{DEFAULT_FRAMES_PER_SECOND, ReadOptions};
pub use reading::{endings_without_rate, has_skin_markers, needs_skeleton, read, read_space};
pub use recording::Motion;
pub use shortfall::Shortfall;
