//! Tracks the recordings on an emulated Cortex-M and prints what each part takes, in instructions;
//! fails where a tracker lost what it follows.

#![no_std]
#![no_main]

// Its critical section.
use cortex_m as _;

use core::fmt::Arguments;
use core::panic::PanicInfo;
use core::ptr::{read_volatile, write_volatile};
use cortex_m_rt::entry;
use cortex_m_semihosting::{debug, hprintln};
use sinew_board_tracking::camera::Camera;
use sinew_board_tracking::counted::{Machine, run};
use sinew_board_tracking::walker::Walker;
use static_cell::ConstStaticCell;

static WALKER: ConstStaticCell<Walker> = ConstStaticCell::new(Walker::empty());
static CAMERA: ConstStaticCell<Camera> = ConstStaticCell::new(Camera::empty());

/// Registers of CMSDK TIMER0 of both machines: control, value, reload.
const TIMER: [*mut u32; 3] = [0x4000_0000 as *mut u32, 0x4000_0004 as *mut u32, 0x4000_0008 as *mut u32];
/// Nanoseconds of a tick of the timer (25 MHz), and of an instruction (2^6, as .cargo/config.toml
/// says).
const TICK_NS: u64 = 40;
const INSTRUCTION_NS: u64 = 64;

/// The machines' timer, which counts down.
struct Board;

impl Machine for Board {
    fn ticks() -> u32 {
        // SAFETY: the register of a timer that nothing else uses.
        u32::MAX - unsafe { read_volatile(TIMER[1]) }
    }

    fn instructions(ticks: u32) -> u64 {
        u64::from(ticks) * TICK_NS / INSTRUCTION_NS
    }

    fn print(line: Arguments<'_>) {
        hprintln!("{}", line);
    }
}

fn leave(is_success: bool) -> ! {
    debug::exit(if is_success { debug::EXIT_SUCCESS } else { debug::EXIT_FAILURE });
    loop {}
}

#[entry]
fn main() -> ! {
    // SAFETY: registers of a timer that nothing else uses.
    unsafe {
        write_volatile(TIMER[2], u32::MAX);
        write_volatile(TIMER[1], u32::MAX);
        write_volatile(TIMER[0], 1);
    }
    leave(run::<Board>(WALKER.take(), CAMERA.take()))
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    hprintln!("{}", info);
    leave(false)
}
