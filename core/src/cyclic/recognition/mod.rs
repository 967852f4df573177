//! Which motion a person performs: several models at once, and whether any of them explains what is seen.

pub mod bank;
pub(crate) mod explained_variance;

pub use bank::MotionBank;
