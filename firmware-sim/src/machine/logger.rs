//! defmt over the serial line.

#![expect(unsafe_code, reason = "defmt's logger is a trait of unsafe functions")]

use super::registers::send;
use core::cell::UnsafeCell;
use defmt::{Encoder, Logger, global_logger};

#[global_logger]
struct SerialLogger;

/// The encoder; nothing interrupts, so whoever logs is alone.
struct Single(UnsafeCell<Encoder>);

// SAFETY: one core, and no interrupt logs.
unsafe impl Sync for Single {}

static ENCODER: Single = Single(UnsafeCell::new(Encoder::new()));

// SAFETY: `acquire` and `release` come in pairs, and nothing can come between them.
unsafe impl Logger for SerialLogger {
    fn acquire() {
        // SAFETY: see `Single`.
        unsafe { (*ENCODER.0.get()).start_frame(put) };
    }

    unsafe fn flush() {}

    unsafe fn release() {
        // SAFETY: see `Single`.
        unsafe { (*ENCODER.0.get()).end_frame(put) };
    }

    unsafe fn write(bytes: &[u8]) {
        // SAFETY: see `Single`.
        unsafe { (*ENCODER.0.get()).write(bytes, put) };
    }
}

fn put(bytes: &[u8]) {
    bytes.iter().for_each(|&byte| send(byte));
}
