//! Clouds of points in space, one file a frame: PLY, PCD, CSV and depth images are read, PLY is
//! written.
//!
//! Coordinates are metres in the camera's axes: x right, y down, z forward, the camera's centre is
//! the origin. They are used as they are; a PCD file's `VIEWPOINT` is not applied.

pub use crate::limits::MAX_FILE_BYTES;

pub mod blocks;
pub mod csv;
pub mod depth_camera;
pub mod depth_image;
pub mod error;
pub mod folder;
pub mod frame_number;
pub mod pcd;
pub mod ply;
pub mod point_cloud;
mod reading;
pub mod region;
pub mod source;
pub mod subsample;

pub use blocks::blocks_of;
pub use depth_camera::DepthCamera;
pub use error::CloudError;
pub use folder::{CloudFolder, CloudFrame};
pub use ply::write_ply;
pub use point_cloud::{MAX_DISTANCE_M, MAX_POINTS, PointCloud};
pub use reading::{read, read_noting};
pub use region::Region;
pub use source::{CloudSource, FoundSource};

#[cfg(test)]
mod tests;
