//! The trackers for programs in C: objects in memory that the caller gives, status codes, plain
//! structures.
//!
//! The header `include/sinew.h` is made from this folder. The rules of every function:
//!
//! - Nothing is allocated, nothing is global, nothing unwinds. Different objects may be used by
//!   different threads at the same time.
//! - A pointer that is null or misaligned, an object that was not initialised, a number out of
//!   range are answered with a status, and the object is as before; where a function says otherwise
//!   it says what is left.
//! - An object is refused while another call uses it, as an interrupt's may, and where it was
//!   copied or moved.
//! - Structures are read and written whole; the caller owns all memory.
//!
//! This folder has `unsafe` code: it turns the caller's pointers into references, after checking
//! what can be checked. The rest is the caller's duty: that a pointer which is not null points at
//! memory of the size that was said, and that tasks which share an object take turns.
#![allow(unsafe_code)]

pub mod arm;
pub mod arm_config;
pub mod arm_frame;
pub mod arm_pair;
pub mod body;
pub mod body_config;
pub mod body_frame;
pub mod clock;
#[cfg(test)]
mod configured;
pub mod cyclic;
pub mod cyclic_config;
pub mod cyclic_frame;
pub mod cyclic_particles;
pub mod cyclic_particles_config;
#[cfg(test)]
mod every_object;
#[cfg(test)]
mod misuse;
mod model;
mod object;
pub mod on_panic;
#[cfg(feature = "panic-handler")]
mod panic;
#[cfg(feature = "prove-no-panic")]
pub mod rust_entry_points;
mod stateful;
pub mod status;
#[cfg(test)]
mod tests;
pub mod vision;
pub mod vision_frame;
