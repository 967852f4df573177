//! What a frame tells a tracker.

pub mod candidate;
