//! Runs the device for 80 frames: a line a frame on standard output, the memory that it takes on standard error.

use sinew_core::error::ParameterError;
use sinew_core::tracker::arm::ArmTracker;
use sinew_firmware_sim::device::{Device, PARTICLES};
use sinew_firmware_sim::front_end::{Finder, FrontEnd};
use sinew_firmware_sim::report::{HEADER, Line};
use std::sync::{Mutex, PoisonError};

const SEED: u64 = 1;
const FRAMES: u64 = 80;

/// The device's memory has a fixed place, as in firmware.
static DEVICE: Mutex<Option<Device>> = Mutex::new(None);

fn main() -> Result<(), ParameterError> {
    eprintln!("bytes of the whole device: {}", size_of::<Device>());
    eprintln!("bytes of vision: {}, of them the blob finder: {}", size_of::<FrontEnd>(), size_of::<Finder>());
    eprintln!("bytes of the tracker with {PARTICLES} particles: {}", size_of::<ArmTracker<PARTICLES>>());
    let mut place = DEVICE.lock().unwrap_or_else(PoisonError::into_inner);
    let device = place.insert(Device::new(SEED)?);
    println!("{HEADER}");
    for frame in 0..FRAMES {
        let estimate = device.step()?;
        println!("{}", Line::new(frame, &estimate, &device.camera().geometry()));
    }
    Ok(())
}
