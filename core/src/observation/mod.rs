//! What a frame tells a tracker.

pub mod candidate;
pub mod edge_pixel;
pub mod hough;
pub mod limbs;
pub mod orientation;
