//! Host side of Sinew: image folders, skin models, scenes, plots and reports around [`sinew_core`].

pub mod blob_rows;
pub mod body;
pub mod camera_lines;
#[cfg(feature = "command")]
pub mod cli;
pub mod config;
mod csv_text;
pub mod cyclic;
#[cfg(feature = "report")]
pub mod doctor;
#[cfg(feature = "plots")]
pub mod draw;
pub mod error;
pub mod frames;
mod json_file;
pub mod keypoints;
pub mod model_text;
pub mod output;
pub mod person;
pub mod pixels;
mod reading_again;
pub mod record;
#[cfg(feature = "report")]
pub mod report;
pub mod resume;
pub mod scene;
pub mod signal;
pub mod skin;
pub mod stereo;
pub mod track;
#[cfg(feature = "rerun")]
pub mod viewer;
pub mod wording;

pub use error::{Error, Result};
pub use sinew_formats::{cloud, images, limits, motion, registry};
pub(crate) use sinew_formats::{file, quote};
