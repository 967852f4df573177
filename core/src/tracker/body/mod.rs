//! The body tracker: particles of whole poses, weighed by a frame's 3D points (PIK paper, sections 5 to 7).
//!
//! [`BodyScene`](crate::pik::motion::BodyScene) is what does not change, a [`BodyMotion`](crate::pik::motion::BodyMotion) says how
//! particles move, [`BodyTracker`] is the state. A frame goes in as a [`BodyFrame`], a [`BodyEstimate`] comes out, for every frame.

mod alignment;
mod estimate;
mod mean_rotation;
mod observed;
mod step;
mod tempering;
#[cfg(test)]
mod tests;

pub use alignment::RootAlignment;
pub use estimate::BodyEstimate;
pub use mean_rotation::{angles_of_rotation, mean_rotation};
pub use step::{Advance, BodyFrame, BodyOptions, BodyTracker, DEFAULT_BODY_OPTIONS};
