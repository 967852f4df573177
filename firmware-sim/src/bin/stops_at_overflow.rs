//! Uses more stack than there is: the emulator has to end with a failure.

#![cfg_attr(target_os = "none", no_std, no_main)]

sinew_firmware_sim::image!(sinew_firmware_sim::faults::stack_overflow);
