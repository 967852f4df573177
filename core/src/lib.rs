#![cfg_attr(not(test), no_std)]
#![doc = include_str!("../README.md")]

pub mod camera;
pub mod error;
pub mod math;
pub mod observation;
pub mod random;
pub mod vision;
