//! Tracking a recording with one of the core's cyclic filters.

pub mod bank;
pub(in crate::cyclic) mod cycle_times;
pub mod filter;
mod kept;
pub mod measurements;
pub mod online_run;
pub mod options;
pub mod particles;
pub mod run;
mod saved_estimate;
pub mod steps;
pub mod stream_run;
pub mod summary;
pub mod table;
pub mod table_run;
mod walk;
pub mod wide_vectors;

pub use bank::NamedMotion;
pub use measurements::Measurements;
pub use online_run::OnlineRun;
pub use options::{FilterName, ScalingName, StartName, TrackingOptions, Updates};
pub use run::{SideEstimate, Tracked, TrackedFrame};
pub use stream_run::StreamRun;
pub use summary::Summary;
pub use table_run::{TableRun, track};
