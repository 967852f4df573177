#![cfg_attr(not(test), no_std)]
#![doc = include_str!("../README.md")]

pub mod angle;
#[cfg(feature = "c-api")]
pub mod c_api;
pub mod camera;
pub mod checksum;
pub mod correction;
pub mod cyclic;
pub mod error;
pub mod kinematics;
pub mod math;
pub mod numeric;
pub mod observation;
pub mod particle;
pub mod pik;
pub mod random;
pub mod ranges;
pub mod saved_state;
pub mod skeleton;
pub mod slot;
pub mod tracker;
pub mod vision;
