//! Prints the digests. For a bare-metal target it prints nothing and is only linked: that succeeds only where neither the core nor a
//! crate that it builds on asks for an allocator, since nothing here gives one.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() -> Result<(), sinew_core::error::ParameterError> {
    use sinew_digest::{FRAMES, Line, Subject};
    for subject in Subject::ALL {
        println!("{}", Line { subject, digest: subject.digest(FRAMES)? });
    }
    Ok(())
}

#[cfg(target_os = "none")]
mod bare {
    use sinew_digest::Subject;

    /// Where a linker without a script of its own lets a program begin.
    // An exported name cannot clash here: the program has nothing else.
    #[allow(unsafe_code)]
    #[unsafe(no_mangle)]
    extern "C" fn _start() -> ! {
        for subject in Subject::ALL {
            let _ = core::hint::black_box(subject.digest(1));
        }
        stop()
    }

    #[panic_handler]
    fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
        stop()
    }

    fn stop() -> ! {
        loop {
            core::hint::spin_loop();
        }
    }
}
