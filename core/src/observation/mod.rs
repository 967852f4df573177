//! What a frame tells a tracker.

pub mod body_surface;
pub mod candidate;
pub mod capsule;
pub mod hough;
pub mod limbs;
pub mod orientation;
pub mod point_cloud;
pub mod point_likelihood;
pub mod point_pull;
pub mod self_penetration;
