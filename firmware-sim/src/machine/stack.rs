//! The stack's limit, and how much of the stack was in use. The stack is painted before `main`, and
//! paint that is left was never written over.

#![expect(unsafe_code, reason = "the stack is memory that no variable names")]

use core::ptr::{addr_of, read_volatile};

/// What `cortex-m-rt` paints with (`STACK_PAINT_VALUE`).
const PAINT: u32 = 0xcccc_cccc;

unsafe extern "C" {
    static _stack_start: u32;
    static _stack_end: u32;
}

/// Largest number of bytes in use.
pub fn most_used_bytes() -> u32 {
    // The stack grows from the first symbol down to the second.
    let (high, low) = (addr_of!(_stack_start), addr_of!(_stack_end));
    let mut at = low;
    // SAFETY: all words between both symbols are memory.
    while at < high && unsafe { read_volatile(at) } == PAINT {
        at = at.wrapping_add(1);
    }
    (high as u32).saturating_sub(at as u32)
}

/// Makes every access below the stack a fault, by a region of the memory protection unit without
/// any permission.
pub fn guard() {
    const SIZE_64_KIB: u32 = 15 << 1;
    const NO_ACCESS_NOR_EXECUTION: u32 = 1 << 28;
    const ENABLE_WITH_DEFAULT_MAP: u32 = 0b101;
    // SAFETY: called once, before anything else uses the unit.
    let unit = unsafe { &*cortex_m::peripheral::MPU::PTR };
    let below = (addr_of!(_stack_end) as u32).wrapping_sub(64 * 1024);
    // SAFETY: the image keeps nothing below its stack, which begins at a multiple of 64 KiB.
    unsafe {
        unit.rnr.write(0);
        unit.rbar.write(below);
        unit.rasr.write(NO_ACCESS_NOR_EXECUTION | SIZE_64_KIB | 1);
        unit.ctrl.write(ENABLE_WITH_DEFAULT_MAP);
    }
    cortex_m::asm::dsb();
    cortex_m::asm::isb();
}

/// Whether the stack pointer has left the stack, or nearly.
pub fn is_overflown() -> bool {
    cortex_m::register::msp::read() < addr_of!(_stack_end) as u32 + 256
}

/// Goes on in `then` with an empty stack.
pub fn abandon(then: extern "C" fn() -> !) -> ! {
    // SAFETY: nothing on the old stack is used again.
    unsafe { cortex_m::asm::bootstrap(addr_of!(_stack_start), then as *const u32) }
}
