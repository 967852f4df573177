//! RV32IMC without floats in registers, as ESP32-C3 has: tracks the recordings once, counts the
//! instructions by the processor's own counter, and prints them over the serial line of QEMU's
//! `virt`.

#![no_std]
#![no_main]

use core::fmt::{Arguments, Write};
use core::ptr::write_volatile;
use panic_halt as _;
use riscv::register::instret;
use riscv_rt::entry;
use sinew_board_tracking::camera::Camera;
use sinew_board_tracking::counted::{Machine, run};
use sinew_board_tracking::walker::Walker;
use static_cell::ConstStaticCell;

static WALKER: ConstStaticCell<Walker> = ConstStaticCell::new(Walker::empty());
static CAMERA: ConstStaticCell<Camera> = ConstStaticCell::new(Camera::empty());

/// Data register of the serial line of `virt` (a 16550), and its finisher, which ends the emulator.
const UART_DATA: *mut u8 = 0x1000_0000 as *mut u8;
const FINISHER: *mut u32 = 0x0010_0000 as *mut u32;
/// What the finisher takes as success, and as failure with status 1.
const PASS: u32 = 0x5555;
const FAIL: u32 = 0x1_3333;

struct Serial;

impl Write for Serial {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        // SAFETY: the register of a device that nothing else uses.
        text.bytes().for_each(|byte| unsafe { write_volatile(UART_DATA, byte) });
        Ok(())
    }
}

impl Machine for Serial {
    fn ticks() -> u32 {
        instret::read() as u32
    }

    fn instructions(ticks: u32) -> u64 {
        ticks.into()
    }

    fn print(line: Arguments<'_>) {
        let _ = writeln!(Self, "{line}");
    }
}

#[entry]
fn main() -> ! {
    let is_tracked = run::<Serial>(WALKER.take(), CAMERA.take());
    // SAFETY: the device takes any number.
    unsafe { write_volatile(FINISHER, if is_tracked { PASS } else { FAIL }) };
    loop {}
}
