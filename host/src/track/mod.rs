//! Tracking the arms of one image folder or video, or of any stream of images.

mod arms;
mod finish;
pub(crate) mod gaps;
mod input;
mod last_picture;
mod options;
mod particles;
#[cfg(feature = "plots")]
pub(crate) mod pictures;
#[cfg(not(feature = "plots"))]
#[path = "no_pictures.rs"]
mod pictures;
mod report;
mod resume;
mod run;
mod sample;
mod seen;
mod source;
mod stream;
mod stream_state;
mod table;
mod vision;

pub use arms::{ArmSet, ArmView, SideChoice};
pub use finish::RunOutcome;
pub use input::{FrameFolder, SkippedImage};
pub use options::{DEFAULT_RATE_HZ, DEFAULT_SEED, FaceSource, FrontEnd, RATES_HZ, StreamOptions, TrackOptions};
pub use report::{Inputs, REPORT_VERSION, RunReport, StatusCounts};
pub use run::{Event, TrackRun};
pub use sample::HandSample;
pub use seen::SeenCounts;
pub use source::{FrameSource, VideoSource};
pub use stream::{ArmStream, StreamAnswer, StreamFrame};
pub use table::{HEADER, TrackRow};
