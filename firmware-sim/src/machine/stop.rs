//! Ends of the emulator that are failures: panics and faults.

#![expect(unsafe_code, reason = "a handler of faults is an unsafe function")]

use super::stack;
use core::panic::PanicInfo;
use cortex_m_rt::{ExceptionFrame, exception};
use cortex_m_semihosting::debug::{EXIT_FAILURE, exit};
use cortex_m_semihosting::hio;

/// Writes a line to the emulator's standard output.
pub fn print(message: &str) {
    if let Ok(mut out) = hio::hstdout() {
        let _ = out.write_all(message.as_bytes());
        let _ = out.write_all(b"\n");
    }
}

/// Tells where, without the formatting that would take more flash than the tracker, and ends with a
/// failure.
#[panic_handler]
fn panicked(info: &PanicInfo<'_>) -> ! {
    print("panic at");
    if let Some(place) = info.location() {
        print(place.file());
        let mut digits = [b'0'; 6];
        let mut left = place.line();
        for digit in digits.iter_mut().rev() {
            *digit = b'0' + (left % 10) as u8;
            left /= 10;
        }
        print(core::str::from_utf8(&digits).unwrap_or_default());
    }
    fail()
}

#[exception]
unsafe fn HardFault(_: &ExceptionFrame) -> ! {
    stack::abandon(if stack::is_overflown() { overflown } else { faulted })
}

extern "C" fn overflown() -> ! {
    print("stack overflow");
    fail()
}

extern "C" fn faulted() -> ! {
    print("hard fault");
    fail()
}

#[exception]
unsafe fn DefaultHandler(_: i16) {
    print("an exception without a handler");
    fail()
}

fn fail() -> ! {
    loop {
        exit(EXIT_FAILURE);
    }
}
