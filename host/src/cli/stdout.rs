//! Standard output that may be closed early, as by `| head`.

use anyhow::Result;
use std::cell::RefCell;
use std::io::{self, ErrorKind, Write};

thread_local! {
    /// What this thread would print, while that is kept.
    static KEPT: RefCell<Option<Vec<u8>>> = const { RefCell::new(None) };
}

/// What `work` returns, and what it would have written to standard output.
pub fn captured<T>(work: impl FnOnce() -> T) -> (T, Vec<u8>) {
    KEPT.set(Some(Vec::new()));
    let done = work();
    (done, KEPT.take().unwrap_or_default())
}

/// Writes `bytes` to standard output; a reader that has gone away is no error.
///
/// # Errors
/// Any other failure of the operating system.
pub fn write_all(bytes: &[u8]) -> Result<()> {
    let is_kept = KEPT.with_borrow_mut(|kept| kept.as_mut().map(|kept| kept.extend_from_slice(bytes)).is_some());
    if is_kept {
        return Ok(());
    }
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}
