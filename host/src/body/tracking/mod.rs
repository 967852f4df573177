//! Tracking a body from point clouds: which motion model, its numbers, the core's step over many
//! threads, and a stream of frames.

pub mod ambiguity;
pub mod by_joint;
pub mod end_effectors;
pub mod facing;
pub mod filter;
pub mod frame_time;
pub mod model_kind;
pub mod paper_tuning;
pub mod seen_points;
pub mod size_estimate;
pub mod size_from_frames;
mod sized;
pub mod start;
pub mod stream;
pub mod stream_options;
pub mod tuning;
mod turned_round;

pub use by_joint::ByJoint;
pub use end_effectors::MAX_BODY_PARTICLES;
pub use filter::BodyFilter;
pub use frame_time::FrameTime;
pub use model_kind::BodyModelKind;
pub use paper_tuning::{PaperRoot, PaperTuning};
pub use seen_points::SeenPoints;
pub use start::FirstPose;
pub use stream::{BodyStream, StreamState, StreamedFrame};
pub use stream_options::BodyStreamOptions;
pub use tuning::BodyTuning;
