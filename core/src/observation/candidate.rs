//! A blob that may be a hand, as the trackers see it.

use crate::camera::Pixel;

/// The part of a blob that an arm tracker uses: a few numbers, so that a frame's list is small state.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct HandCandidate {
    /// Where the hand's centre is taken to be.
    pub centre: Pixel,
    /// Second central moments of the blob's pixels: uu, uv, vv, in square pixels.
    pub moments_px2: [f32; 3],
    /// Number of pixels of the blob.
    pub area_px: f32,
    /// p(hand | blob) in [0, 1], eq. (6) of the arm paper or the default form.
    pub likelihood: f32,
}
