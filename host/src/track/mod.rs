//! Tracking the arms of one image folder.

mod arms;
mod table;

pub use arms::{ArmSet, ArmView, SideChoice};
pub use table::{HEADER, TrackRow, side_name};
