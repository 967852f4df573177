//! Measuring the trackers where the truth is known.

pub mod clips;
pub mod hands;
pub mod observed;
pub mod score;
