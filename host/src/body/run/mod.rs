//! `sinew track body`: a folder of point clouds becomes a table, an animation and a report.

mod answer;
mod cloud_check;
mod finish;
pub mod inputs;
pub mod measures_source;
pub mod options;
pub mod particles;
#[cfg(feature = "plots")]
pub mod pictures;
#[cfg(not(feature = "plots"))]
#[path = "no_pictures.rs"]
pub mod pictures;
pub mod report;
mod resume;
pub mod score;
pub mod table;
pub mod track;
pub mod tuning_file;

pub use inputs::BodyInputs;
pub use options::{BodyTrackOptions, DEPTH_POINTS, SizeSource};
pub use report::{BodyRunReport, REPORT_VERSION};
pub use track::{BodyEvent, BodyTrackRun};
