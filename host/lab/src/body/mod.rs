//! The PIK paper's experiments on simulated stereo views of real motion (section 7).

pub mod figures;
pub mod flagged;
pub mod hidden_arm;
pub mod motions;
pub mod prediction;
pub mod report;
pub mod runners;
pub mod search;
pub mod trial;

pub use motions::MotionChoice;
pub use report::{BodyReport, BodyResult, Measured};
