//! Colours and words for sides and states: the same ones in overlays and plots.
//!
//! Orange and blue stay apart for all common kinds of colour blindness, on dark video as well as on
//! white paper.

use image::Rgb;
use sinew_core::skeleton::Side;

/// All that belongs to the person's left arm: orange.
pub const LEFT: Rgb<u8> = Rgb([236, 112, 0]);
/// All that belongs to the person's right arm: blue.
pub const RIGHT: Rgb<u8> = Rgb([30, 136, 255]);
/// Blobs that may be a hand: yellow.
pub const BLOB: Rgb<u8> = Rgb([255, 230, 60]);
/// Temporal edges: pink.
pub const EDGE: Rgb<u8> = Rgb([255, 90, 200]);
/// Skin: green.
pub const SKIN: Rgb<u8> = Rgb([0, 220, 150]);
/// Text and symbols that belong to no side.
pub const INK: Rgb<u8> = Rgb([245, 245, 245]);
/// What lies under text and around lines, so that they show on any picture.
pub const SHADE: Rgb<u8> = Rgb([12, 12, 16]);

/// Colour of all that belongs to `side`.
#[must_use]
pub fn of_side(side: Side) -> Rgb<u8> {
    match side {
        Side::Left => LEFT,
        Side::Right => RIGHT,
    }
}
