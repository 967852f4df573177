//! What a panic does in a library that is linked without Rust's standard library.

/// Calls `sinew_on_panic`, and loops where that returns.
///
/// The link-time proof (feature `prove-no-panic`) shows which functions of the interface cannot
/// come here.
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    #[cfg(feature = "prove-no-panic")]
    {
        unsafe extern "C" {
            /// Defined nowhere: the link fails where a panic can be reached.
            fn sinew_panic_is_reachable() -> !;
        }
        // SAFETY: there is no such function, so a program that gets here cannot be linked.
        unsafe { sinew_panic_is_reachable() }
    }
    #[cfg(not(feature = "prove-no-panic"))]
    {
        #[cfg(all(any(target_arch = "arm", target_arch = "riscv32", target_arch = "x86_64"), not(windows)))]
        weak_hook::call();
        loop {
            core::hint::spin_loop();
        }
    }
}

/// A `sinew_on_panic` that the program's own one replaces. Stable Rust has no weak functions, the
/// assemblers of these processors have.
#[cfg(not(feature = "prove-no-panic"))]
#[cfg(all(any(target_arch = "arm", target_arch = "riscv32", target_arch = "x86_64"), not(windows)))]
mod weak_hook {
    core::arch::global_asm!(
        ".section .text.sinew_on_panic, \"ax\", %progbits",
        ".weak sinew_on_panic",
        ".type sinew_on_panic, %function",
        "sinew_on_panic:",
        #[cfg(target_arch = "arm")]
        "bx lr",
        #[cfg(not(target_arch = "arm"))]
        "ret",
        ".size sinew_on_panic, . - sinew_on_panic",
        ".text",
    );

    pub(super) fn call() {
        // SAFETY: defined above, or by the program as the header says.
        unsafe { super::super::on_panic::sinew_on_panic() }
    }
}
