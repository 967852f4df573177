//! Weighted particles: log-weights, resampling, and groups of particles that agree.

pub mod resampling;
pub mod weights;

pub use weights::{Degenerate, Weights};
