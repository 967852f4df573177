//! Ctrl-C as a wish to stop after the current frame.

use anyhow::{Context, Result};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

static STOP: AtomicBool = AtomicBool::new(false);
static HANDLER: OnceLock<Result<(), String>> = OnceLock::new();

/// A flag that is set when Ctrl-C is pressed; from the first call on, Ctrl-C no longer ends the
/// program by itself.
///
/// # Errors
/// The operating system refuses the handler.
pub fn stop_flag() -> Result<&'static AtomicBool> {
    let installed = HANDLER
        .get_or_init(|| ctrlc::set_handler(|| STOP.store(true, Ordering::Relaxed)).map_err(|error| error.to_string()));
    installed.clone().map_err(anyhow::Error::msg).context("Ctrl-C cannot be handled")?;
    Ok(&STOP)
}
