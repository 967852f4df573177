//! The face of the person before a camera, and the colour of the skin.
//!
//! `sinew track arm` and the live page both find it here. So they find the same face in the same
//! picture.

mod detector;
mod skin;

/// Frames after which the answer of a look for a face counts. Chosen: a third of a second, in which
/// any computer finds a face.
pub const LATENCY: usize = 10;
/// Whether a look begins in a frame: every `interval` frames, and until a face is known as soon as
/// the answer to the last look has come.
///
/// ```
/// use sinew_face::is_time_to_look;
///
/// let frames = |is_known| -> Vec<usize> {
///     (0..50).filter(|frame| is_time_to_look(*frame, 30, is_known)).collect()
/// };
/// assert_eq!((frames(false), frames(true)), (vec![0, 10, 20, 30, 40], vec![0, 30]));
/// ```
#[must_use]
pub const fn is_time_to_look(frame: usize, interval: usize, is_known: bool) -> bool {
    frame.is_multiple_of(interval) || !is_known && frame.is_multiple_of(LATENCY)
}

/// Most columns of cells in which the person's hands are looked for. Chosen: a hand of a person two
/// metres away is a few cells wide.
pub const COLUMNS: usize = 80;
/// Most rows of cells.
pub const ROWS: usize = 60;

pub use detector::{FaceDetector, FoundFace};
pub use skin::PersonSkin;
