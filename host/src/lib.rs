//! Host side of Sinew: image folders, skin models, scenes, plots and reports around [`sinew_core`].

pub mod body;
pub mod cli;
pub mod cloud;
pub mod config;
pub mod cyclic;
pub mod doctor;
pub mod draw;
pub mod frames;
pub mod images;
pub mod keypoints;
pub mod model_text;
pub mod motion;
pub mod output;
pub mod record;
pub mod report;
pub mod resume;
pub mod scene;
pub mod skin;
pub mod stereo;
pub mod track;
#[cfg(feature = "rerun")]
pub mod viewer;
pub mod wording;
