//! Standard output that may be closed early, as by `| head`.

use anyhow::Result;
use std::io::{self, ErrorKind, Write};

/// Writes `bytes` to standard output; a reader that has gone away is no error.
///
/// # Errors
/// Any other failure of the operating system.
pub fn write_all(bytes: &[u8]) -> Result<()> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}
