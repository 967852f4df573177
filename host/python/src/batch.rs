//! The command line, and batches whose parts other processes work on.

use crate::errors::{of_command, of_kind};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use sinew::cli::batch::chunk::{Part, Whole};
use sinew::cli::batch::manifest;
use sinew::cli::signals::stop_flag;
use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// How often Python may handle signals while a part is worked on; chosen: a
/// user waits for it, and no recording does.
const SIGNAL_PERIOD: Duration = Duration::from_millis(50);

/// Runs a command line, of which the first word is the program's name, and returns the exit status.
#[pyfunction]
pub fn run_command(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| sinew::cli::run_words(words))
}

/// Raises what the command called an error of this kind.
#[pyfunction]
pub fn raise_error(kind: &str, message: &str) -> PyResult<()> {
    Err(of_kind(kind, message.to_owned()))
}

/// Name, kind and text of each recording of a manifest: of the text of JSON lines, else of a file
/// or folder.
#[pyfunction]
pub fn batch_rows(
    py: Python<'_>,
    manifest: PathBuf,
    text: Option<&str>,
    folder: Option<PathBuf>,
    set: Vec<(String, String)>,
) -> PyResult<Vec<(String, Option<String>, String)>> {
    let rows = py.detach(|| {
        let mut rows = match text {
            Some(text) => manifest::of_lines(text, "manifest", &[folder.unwrap_or_default(), PathBuf::new()]),
            None => manifest::read(&manifest, folder.as_deref()).map(|manifest| manifest.rows),
        }?;
        rows.iter_mut().for_each(|row| row.set(&set));
        Ok(rows.into_iter().map(|row| (row.id.clone(), row.kind.clone(), row.to_json())).collect())
    });
    rows.map_err(|error| of_command(&error))
}

/// Rows of a manifest that are worked on here.
#[pyclass(module = "sinew._sinew", frozen)]
#[derive(Debug)]
pub struct BatchPart(Part);

#[pymethods]
impl BatchPart {
    #[new]
    fn new(rows: String, folders: [PathBuf; 2], out: PathBuf, name: String, retry_failed: bool) -> Self {
        Self(Part { rows, folders, out, name, jobs: 1, retry_failed })
    }

    /// The key of each row, `None` where it cannot have one.
    fn keys(&self, py: Python<'_>) -> PyResult<Vec<Option<String>>> {
        py.detach(|| self.0.keys()).map_err(|error| of_command(&error))
    }

    /// Lines of the tables as JSON.
    fn work(&self, py: Python<'_>) -> PyResult<String> {
        watched(py, |stop| self.0.work(stop))
    }
}

/// Does `work` on another thread, so that Python handles signals: an exception of a handler stops
/// it.
fn watched<T: Send>(py: Python<'_>, work: impl FnOnce(&AtomicBool) -> anyhow::Result<T> + Send) -> PyResult<T> {
    let stop = stop_flag().map_err(|error| of_command(&error))?;
    let mut raised = None;
    let done = std::thread::scope(|scope| {
        let (sender, receiver) = channel();
        let receiver = Mutex::new(receiver);
        let wait = || receiver.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(SIGNAL_PERIOD);
        let worker = scope.spawn(move || {
            let done = work(stop);
            // Who waits is there until the thread has ended.
            let _ = sender.send(());
            done
        });
        while py.detach(wait) == Err(RecvTimeoutError::Timeout) {
            if raised.is_none() {
                raised = py.check_signals().err();
                stop.fetch_or(raised.is_some(), Ordering::Relaxed);
            }
        }
        worker.join()
    });
    if let Some(raised) = raised {
        // The process may have more to do.
        stop.store(false, Ordering::Relaxed);
        return Err(raised);
    }
    let done = done.map_err(|_| PyRuntimeError::new_err("a fault of the program; please report it"))?;
    done.map_err(|error| of_command(&error))
}

/// A batch whose parts others work on; its folder is this process's until `close`.
#[pyclass(module = "sinew._sinew")]
#[derive(Debug)]
pub struct WholeBatch(Option<Whole>);

#[pymethods]
impl WholeBatch {
    #[new]
    fn new(out: PathBuf, ids: Vec<String>) -> PyResult<Self> {
        Ok(Self(Some(Whole::begin(&out, ids).map_err(|error| of_command(&error))?)))
    }

    /// Takes the lines of the recordings with these numbers.
    fn add(&mut self, rows: Vec<usize>, lines: &str) -> PyResult<()> {
        self.whole()?.add(&rows, lines).map_err(|error| of_command(&error))
    }

    /// Writes the tables, and removes what killed parts left if none can be at work any more.
    fn end(&mut self, py: Python<'_>, all_parts_ended: bool) -> PyResult<()> {
        let whole = self.whole()?;
        py.detach(|| whole.end(all_parts_ended)).map_err(|error| of_command(&error))
    }

    /// Lets other batches into the folder.
    fn close(&mut self) {
        self.0 = None;
    }
}

impl WholeBatch {
    fn whole(&mut self) -> PyResult<&mut Whole> {
        self.0.as_mut().ok_or_else(|| PyRuntimeError::new_err("the batch is closed"))
    }
}
