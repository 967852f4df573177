//! The board's timer and serial line (ARM AN386 and AN500: CMSDK peripherals).

#![expect(unsafe_code, reason = "peripherals lie at fixed addresses")]

use crate::port::ICOUNT_SHIFT;
use core::ptr::{read_volatile, write_volatile};

const TIMER_CONTROL: *mut u32 = 0x4000_0000 as *mut u32;
const TIMER_VALUE: *mut u32 = 0x4000_0004 as *mut u32;
const TIMER_RELOAD: *mut u32 = 0x4000_0008 as *mut u32;
const UART_DATA: *mut u32 = 0x4000_4000 as *mut u32;
const UART_STATE: *mut u32 = 0x4000_4004 as *mut u32;
const UART_CONTROL: *mut u32 = 0x4000_4008 as *mut u32;
const UART_DIVIDER: *mut u32 = 0x4000_4010 as *mut u32;

/// Nanoseconds of a tick of the timer (25 MHz).
const TICK_NS: u64 = 40;

/// Starts timer and serial line.
pub fn start() {
    // SAFETY: the addresses are those of the board's registers, which only this file uses.
    unsafe {
        write_volatile(TIMER_RELOAD, u32::MAX);
        write_volatile(TIMER_VALUE, u32::MAX);
        write_volatile(TIMER_CONTROL, 1);
        write_volatile(UART_DIVIDER, 16);
        write_volatile(UART_CONTROL, 1);
    }
}

/// Instructions since [`start`], wrapped: the emulator lets 2^[`ICOUNT_SHIFT`] ns pass for each.
pub fn instructions() -> u32 {
    // SAFETY: as above.
    let ticks = u32::MAX - unsafe { read_volatile(TIMER_VALUE) };
    ((u64::from(ticks) * TICK_NS) >> ICOUNT_SHIFT) as u32
}

/// Sends a byte over the serial line.
pub fn send(byte: u8) {
    // SAFETY: as above.
    unsafe {
        while read_volatile(UART_STATE) & 1 != 0 {}
        write_volatile(UART_DATA, u32::from(byte));
    }
}
