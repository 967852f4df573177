//! What a panic does in a library that is linked without Rust's standard library.

/// Never reached: the link-time proof (feature `prove-no-panic`) shows that no function of the
/// interface can panic.
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
    loop {
        core::hint::spin_loop();
    }
}
