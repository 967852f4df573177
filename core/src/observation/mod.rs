//! What a frame tells a tracker.

pub mod candidate;
pub mod hough;
pub mod limbs;
pub mod orientation;
