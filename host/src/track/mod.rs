//! Tracking the arms of one image folder or video.

mod arms;
mod finish;
mod input;
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
mod table;
mod vision;

pub use arms::{ArmSet, ArmView, SideChoice};
pub use finish::RunOutcome;
pub use input::{FrameFolder, SkippedImage};
pub use options::{FrontEnd, RATES_HZ, TrackOptions};
pub use report::{Inputs, REPORT_VERSION, RunReport, StatusCounts};
pub use run::{Event, TrackRun};
pub use sample::HandSample;
pub use seen::SeenCounts;
pub use source::{FrameSource, VideoSource};
pub use table::{HEADER, TrackRow};
