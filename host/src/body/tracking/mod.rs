//! Tracking a body from point clouds: which motion model, its numbers, and the core's step over
//! many threads.

pub mod end_effectors;
pub mod filter;
pub mod model_kind;
mod sized;
pub mod tuning;

pub use end_effectors::MAX_BODY_PARTICLES;
pub use filter::BodyFilter;
pub use model_kind::BodyModelKind;
pub use tuning::BodyTuning;
