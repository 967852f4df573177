//! The face of the person before a camera, and the colour of the skin.
//!
//! `sinew track arm` and the live page both find it here. So they find the same face in the same
//! picture.

mod detector;
mod skin;

pub use detector::{FaceDetector, FoundFace};
pub use skin::PersonSkin;
