//! Signals as a wish to stop after the current frame.

use anyhow::{Context, Result};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicI32, Ordering};

static STOP: AtomicBool = AtomicBool::new(false);
/// The last signal that came.
static SIGNAL: AtomicI32 = AtomicI32::new(0);
static HANDLER: OnceLock<Result<(), String>> = OnceLock::new();

/// Status of a program that signal 0 would end; shells add the signal's number.
const SIGNALLED: i32 = 128;

/// A flag that SIGINT (Ctrl-C), SIGTERM and SIGHUP set; from the first call on, none of these ends
/// the program by itself.
///
/// # Errors
/// The operating system refuses the handler.
pub fn stop_flag() -> Result<&'static AtomicBool> {
    let installed = HANDLER.get_or_init(|| listen().map_err(|error| error.to_string()));
    installed.clone().map_err(anyhow::Error::msg).context("signals cannot be handled")?;
    Ok(&STOP)
}

/// The exit status of a run that was interrupted.
pub(super) fn interrupted_status() -> u8 {
    let signal = match SIGNAL.load(Ordering::Relaxed) {
        0 => signal_hook::consts::SIGINT,
        signal => signal,
    };
    u8::try_from(SIGNALLED + signal).unwrap_or(u8::MAX)
}

/// Takes signals on a thread of its own, where no rule of signal handlers holds.
#[cfg(unix)]
fn listen() -> std::io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    let mut signals = signal_hook::iterator::Signals::new([SIGINT, SIGTERM, SIGHUP])?;
    std::thread::Builder::new().name("signals".to_owned()).spawn(move || {
        for signal in signals.forever() {
            SIGNAL.store(signal, Ordering::Relaxed);
            STOP.store(true, Ordering::Relaxed);
        }
    })?;
    Ok(())
}

#[cfg(not(unix))]
fn listen() -> std::io::Result<()> {
    use std::sync::Arc;
    use std::time::Duration;
    let came = Arc::new(AtomicBool::new(false));
    signal_hook::flag::register(signal_hook::consts::SIGINT, Arc::clone(&came))?;
    std::thread::Builder::new().name("signals".to_owned()).spawn(move || {
        while !came.load(Ordering::Relaxed) {
            std::thread::sleep(Duration::from_millis(20));
        }
        STOP.store(true, Ordering::Relaxed);
    })?;
    Ok(())
}
