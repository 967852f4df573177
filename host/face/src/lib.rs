//! The face of the person before a camera, and the colour of the skin.
//!
//! `sinew track arm` and the live page both find it here. So they find the same face in the same
//! picture.

mod detector;
mod skin;

/// Frames after which the answer of a look for a face counts. Chosen: a third of a second, in which
/// any computer finds a face.
pub const LATENCY: usize = 10;
/// Most columns of cells in which the person's hands are looked for. Chosen: a hand of a person two
/// metres away is a few cells wide.
pub const COLUMNS: usize = 80;
/// Most rows of cells.
pub const ROWS: usize = 60;

pub use detector::{FaceDetector, FoundFace};
pub use skin::PersonSkin;
