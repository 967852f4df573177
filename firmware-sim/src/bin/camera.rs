//! See `sinew_firmware_sim::camera`.

#![cfg_attr(target_os = "none", no_std, no_main)]

sinew_firmware_sim::image!(sinew_firmware_sim::camera::run);
