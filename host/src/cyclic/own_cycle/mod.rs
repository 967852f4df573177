//! The person's own cycle in a finished recording: its shape, and where in it each frame is. Also
//! what it says of the angles that were not seen.
//!
//! A filter gives the first phases, and they a first shape: harmonics of the phase, with the
//! model's mean cycle as prior ([`shape`]). The likeliest way through that shape ([`path`]) is what
//! the filter would have answered, had it known it from the start. Then shape and phases are fitted
//! to each other in turn. The phase of each frame moves to where the shape fits the frames around
//! it best ([`phase`]). What comes out hangs on the model only where the recording says nothing.

pub mod course;
pub mod fill;
pub mod finish;
pub mod noise;
pub mod path;
pub mod phase;
pub mod seen;
pub mod shape;
pub mod standing;

#[cfg(test)]
mod tests;

pub use finish::finish;
pub use seen::Seen;
pub use shape::Shape;
