//! Readers and writers of the files that Sinew takes: recorded motion, point clouds, images and
//! videos.

pub mod cloud;
pub mod images;
pub mod motion;
pub mod registry;
