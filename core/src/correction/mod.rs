//! Hand correction: blobs decide where some particles' hands are sent (arm paper, section 3).
//!
//! Not to be confused with the auxiliary particle filter of the literature, which looks ahead by auxiliary weights.

pub mod allocation;
pub mod elbow;
pub mod hand;
