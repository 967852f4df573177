//! The person before the camera: the face, the skin's own colour, and both hands over time.

mod faces;
mod finder;
mod given;
mod lines_finder;

pub use faces::FaceLooks;
pub use finder::{PersonFinder, PersonView};
pub use given::{FaceTable, GivenHand, GivenHands, HandTable, given_head, refuse_shares};
pub use lines_finder::LinesFinder;
pub use sinew_face::{FaceDetector, FoundFace, PersonSkin};
