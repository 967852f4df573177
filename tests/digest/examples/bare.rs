//! Prints the digests: on the host as any program, on an emulated Cortex-M by semihosting.
//!
//! For bare metal it is linked without an allocator, which succeeds only where neither the core nor
//! a crate that it builds on asks for one.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() -> Result<(), sinew_core::error::ParameterError> {
    use sinew_digest::{FRAMES, Line, Subject};
    for subject in Subject::ALL {
        println!("{}", Line { subject, digest: subject.digest(FRAMES)? });
    }
    Ok(())
}

#[cfg(all(target_os = "none", target_arch = "arm"))]
mod emulated {
    use core::fmt::Write;
    use cortex_m_rt::entry;
    use cortex_m_semihosting::debug::{EXIT_FAILURE, EXIT_SUCCESS, exit};
    use cortex_m_semihosting::hio::hstdout;
    use sinew_digest::{FRAMES, Line, Subject};

    #[entry]
    fn main() -> ! {
        let code = if print_digests().is_ok() { EXIT_SUCCESS } else { EXIT_FAILURE };
        loop {
            exit(code);
        }
    }

    fn print_digests() -> Result<(), core::fmt::Error> {
        let mut out = hstdout().map_err(|()| core::fmt::Error)?;
        for subject in Subject::ALL {
            let digest = subject.digest(FRAMES).map_err(|_| core::fmt::Error)?;
            writeln!(out, "{}", Line { subject, digest })?;
        }
        Ok(())
    }

    #[panic_handler]
    fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
        loop {
            exit(EXIT_FAILURE);
        }
    }
}

/// Other processors: linked, not run.
#[cfg(all(target_os = "none", not(target_arch = "arm")))]
mod linked {
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
