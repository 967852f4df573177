//! The arm tracker on a browser's pictures, as a WebAssembly module without a binding generator.
//!
//! A page writes a picture into the module's memory, calls `see` and `track`, and reads numbers:
//! [`exports`] lists the functions. What they do is [`session::Session`], an ordinary structure.
//! Vision is the whole-frame chain of [`sinew_core::vision::frame`], and the tracker has the
//! defaults of `sinew track arm`. A test holds the answers bit for bit to the command's on the same
//! pictures.

pub mod answer;
pub mod calibration;
pub mod either_skin;
pub mod exports;
pub mod face;
pub mod frame;
pub mod person;
pub mod session;
pub mod skin_model;
