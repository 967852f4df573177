//! Whole bodies from recordings: their joints over time, their measures, and the poses that come
//! nearest to them.

pub mod body_file;
pub mod body_size;
pub mod camera_axes;
pub mod export;
pub mod first_points;
pub mod fitting;
pub mod joints;
pub mod measuring;
pub mod part;
pub mod placing;
pub mod pose_file;
pub mod recording;
pub mod run;
pub mod tracking;

pub use body_file::BodyFile;
pub use body_size::BodySize;
pub use fitting::{FittedPose, fit_pose, fit_recording};
pub use joints::{BodyJoints, BodySources};
pub use measuring::measure;
pub use part::BodyPart;
pub use placing::Placement;
pub use recording::{BodyRecording, BodyRecordingOptions, RecordedBody};
