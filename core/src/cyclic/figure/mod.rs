//! The figure in the image: root position and segment lengths, each filtered on its own.

pub mod image_filter;
pub mod place;

pub use place::{FigurePlace, PlaceOptions};
