//! What must not happen, on purpose: images whose failure is the expected end.

use crate::port::{Port, Sink};
use core::hint::black_box;
use sinew_record::RecordError;

/// Panics.
///
/// # Errors
/// None.
pub fn panic<P: Port>(_: &mut P) -> Result<(), RecordError> {
    panic!("on purpose")
}

/// Executes an instruction that is none.
///
/// # Errors
/// None.
pub fn hard_fault<P: Port>(_: &mut P) -> Result<(), RecordError> {
    #[cfg(target_os = "none")]
    cortex_m::asm::udf();
    #[cfg(not(target_os = "none"))]
    panic!("there is no such instruction here")
}

/// Calls itself until the stack is full.
///
/// # Errors
/// None.
pub fn stack_overflow<P: Port>(port: &mut P) -> Result<(), RecordError> {
    let left = deeper(black_box(1_000_000));
    port.split().1.write(&left.to_le_bytes());
    Ok(())
}

fn deeper(left: u32) -> u32 {
    let page = black_box([left; 64]);
    if left == 0 { 0 } else { deeper(left - 1).wrapping_add(page[7]) }
}
