//! An upper body from 500 points a frame; see `sinew_firmware_sim::body`.

#![cfg_attr(target_os = "none", no_std, no_main)]

sinew_firmware_sim::image!(sinew_firmware_sim::body::run);
