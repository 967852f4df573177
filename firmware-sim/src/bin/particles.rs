//! The cyclic particle filter with the walking model; see `sinew_firmware_sim::particles`.

#![cfg_attr(target_os = "none", no_std, no_main)]

sinew_firmware_sim::image!(sinew_firmware_sim::particles::run);
