//! What camera firmware does with `sinew-core`, run on the host.
//!
//! A [`camera::SyntheticCamera`] delivers lines of RGB, [`front_end::FrontEnd`] turns them into blobs and temporal edges without ever
//! holding a colour frame, and [`device::Device`] tracks an arm with 50 particles. The library is `no_std` without an allocator, as
//! the firmware would be; only the program that prints (`main.rs`) uses the standard library.

#![no_std]

pub mod camera;
pub mod device;
pub mod front_end;
pub mod report;
