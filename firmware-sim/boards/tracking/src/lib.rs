//! What the images for boards track: a walker and a camera's lines, recorded in flash, or a real
//! camera's lines. No hardware is used here.

#![no_std]

pub mod camera;
pub mod counted;
pub mod layout;
pub mod recording;
pub mod walker;
