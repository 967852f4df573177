//! Native work without the interpreter's lock, in a forked process as in any other.

use crate::errors::exception;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use sinew::error::{Error, Result};
use std::process::id;
use std::sync::{Mutex, OnceLock, PoisonError};

/// The process that loaded the module. Rayon's global threads are its own.
static LOADED_IN: OnceLock<u32> = OnceLock::new();
/// The threads of a process that was forked from it.
static FORKED: Mutex<Option<(u32, &'static ThreadPool)>> = Mutex::new(None);

/// Keeps which process loads the module.
pub fn remember_process() {
    LOADED_IN.get_or_init(id);
}

/// Runs `work` without the interpreter's lock. A fork copies no thread but the one that calls it,
/// so that a forked process has threads of its own; without a fork this is `work` alone.
pub fn detached<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    let run = || if LOADED_IN.get() == Some(&id()) { Ok(work()) } else { Ok(forked_threads()?.install(work)) };
    py.detach(run).map_err(|error: Error| exception(&error))
}

/// The threads of this process. Those of the process that it was forked from are not dropped:
/// nothing is there that would end them.
fn forked_threads() -> Result<&'static ThreadPool> {
    let mut forked = FORKED.lock().unwrap_or_else(PoisonError::into_inner);
    match *forked {
        Some((process, threads)) if process == id() => Ok(threads),
        _ => {
            let threads: &'static ThreadPool = Box::leak(Box::new(ThreadPoolBuilder::new().build()?));
            *forked = Some((id(), threads));
            Ok(threads)
        }
    }
}
