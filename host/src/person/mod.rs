//! The person before the camera: the face, the skin's own colour, and both hands over time.

mod face;
mod finder;
mod given;
mod skin;

pub use face::{FaceDetector, FoundFace};
pub use finder::{PersonFinder, PersonView};
pub use given::{FaceTable, GivenHands, HandTable};
pub use skin::PersonSkin;
