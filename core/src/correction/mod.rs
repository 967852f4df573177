//! Hand correction: blobs move the hands of some particles (arm paper, section 3).
//!
//! This is not the auxiliary particle filter of the literature, which looks ahead by auxiliary
//! weights.

pub mod allocation;
pub mod elbow;
pub mod hand;
