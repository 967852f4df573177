//! The stick figure on the person's own frames, and alone as an animation.

pub mod animation;
pub mod figure;
pub mod overlay;

pub use figure::{has_pixels, measured};
pub use overlay::{Drawn, Overlaid, OverlayFrames};

#[cfg(test)]
mod tests;
