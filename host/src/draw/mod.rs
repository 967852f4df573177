//! Pictures of what a tracker does: overlays on the video, contact sheets and plots, all rendered
//! to memory.
//!
//! Nothing here writes a file; the caller saves the [`image::RgbImage`] by [`crate::output`]. The
//! same input gives the same bytes. Positions may be anything, NaN and far outside of the image
//! included: what cannot be seen is not drawn.

mod arm_marks;
pub mod body_views;
pub mod colour;
pub mod contact_sheet;
mod lettering;
pub mod overlay;
pub mod plot;
pub mod pose_fan;
pub mod stick_figure;
mod stroke;
mod top_view;
