//! Readers and writers of the files that Sinew takes: recorded motion, point clouds, images and
//! videos.

pub mod cloud;
pub mod file;
pub mod images;
pub mod limits;
pub mod motion;
mod quiet_panic;
pub mod quote;
pub mod registry;
