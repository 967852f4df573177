//! What a coach or a gait lab reads off a tracked recording: a folder with tables, plots and files
//! for other programs.

pub mod body;
pub mod contents;
pub mod document;
pub mod folder;
pub mod joints;
pub mod measured;
#[cfg(feature = "plots")]
pub mod plots;
pub mod series;

pub use contents::{Origin, OverlayOrigin, Report};
pub use folder::{ESTIMATES, MEASURED};

#[cfg(test)]
mod tests;
