//! Recognition of the motion: several models at once, and whether any of them explains the
//! measurements.

pub mod bank;
pub(crate) mod explained_variance;

pub use bank::MotionBank;
