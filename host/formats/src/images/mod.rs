//! Folders of images: which files, in which order, as RGB pixels.

pub mod folder;
pub mod jpeg;
pub mod video;

pub use folder::{ImageFileError, ImageInput, InputError, list_images, load_rgb, size_by_header};
pub use video::{VideoError, VideoFacts, VideoFrames, is_video};
