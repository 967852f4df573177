//! Skin colour: models trained from labelled pixels or image-mask pairs, calibrated to a scene, and
//! applied to whole images.
//!
//! The decisions taken here are written down in `docs/skin.md`.

pub mod background;
pub mod bit_image;
pub mod calibrate;
pub mod colour_cube;
pub mod confusion;
pub mod folds;
pub mod gaussian;
pub mod histogram;
pub mod labelled_pixels;
pub mod model;
pub mod model_file;
pub mod moving;
pub mod pairs;
pub mod threshold;
pub mod training;
pub mod training_set;
pub mod white_balance;

pub use background::Background;
pub use bit_image::BitImage;
pub use calibrate::Rectangle;
pub use model::SkinModel;
pub use moving::MovingSkin;
