//! The trackers: each frame's step reads like the algorithm box in its paper.

pub mod arm;
pub mod body;
pub mod cyclic;
