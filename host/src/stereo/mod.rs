//! A small-baseline stereo camera that sees a body made of capsules: points with known truth.

pub mod camera;

pub use camera::StereoCamera;
