//! The particle filter over poses in their cycle, with the transition of the paper's Kalman filter.

mod angle_blocks;
mod computed_factors;
pub mod factors;
pub mod moments;
pub mod propose;
pub mod resample;
pub mod sweep;
pub mod tracker;
pub mod weigh;
pub mod weights;

pub use tracker::ParticleTracker;
