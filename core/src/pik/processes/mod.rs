//! Goal processes, the paper's own and one a user might write.

pub mod extrapolation;
pub mod paper_extrapolation;
pub mod pelvic_lift;
pub mod reach;
pub mod stick;
pub mod walking;
