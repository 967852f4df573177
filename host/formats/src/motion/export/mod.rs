//! Motions for other programs: BVH (angles of joints; animation) and TRC (places of joints;
//! biomechanics).

pub mod bvh;
pub mod error;
pub mod euler;
pub mod layout;
pub mod trc;

pub use bvh::{BvhFrame, write_bvh};
pub use error::ExportError;
pub use layout::{LayoutJoint, SkeletonLayout};
pub use trc::{TrcFrame, TrcHeading, TrcUnit, to_trc};
