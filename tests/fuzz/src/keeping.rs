//! Where inputs that fail are kept, and which one is running.
//!
//! A panic, a long time and much memory are seen by the program itself. An input that does not end,
//! that exhausts the stack, or that asks for more memory than the program may have, ends it. Its
//! number is then in a file, and mostly the input too.

use std::fs::{self, File};
use std::io::{self, Seek, Write};
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// After this time an input counts as one that does not end.
const MAX_TIME: Duration = Duration::from_secs(60);

/// The folder of inputs that failed: `fuzz` in cargo's target folder.
#[must_use]
pub fn folder() -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| PathBuf::from("target"), PathBuf::from);
    target.join("fuzz")
}

/// Writes an input that failed and gives its file: the name of the target and the input's CRC-32.
///
/// # Errors
/// The file cannot be written.
pub fn keep(target: &str, input: &[u8]) -> io::Result<PathBuf> {
    let path = folder().join(format!("{target}-{:08x}", sinew_core::checksum::crc32(input)));
    fs::create_dir_all(folder())?;
    fs::write(&path, input)?;
    Ok(path)
}

struct Running {
    target: &'static str,
    input: Vec<u8>,
    since: Instant,
}

static RUNNING: Mutex<Option<Running>> = Mutex::new(None);

/// Says in a file which input of a target is running.
#[derive(Debug)]
pub struct Progress {
    target: &'static str,
    file: File,
    path: PathBuf,
}

impl Progress {
    /// Begins with a target.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn begin(target: &'static str) -> io::Result<Self> {
        fs::create_dir_all(folder())?;
        let path = folder().join(format!("{target}.running"));
        Ok(Self { target, file: File::create(&path)?, path })
    }

    /// Before an execution.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn before(&mut self, number: u64, input: &[u8]) -> io::Result<()> {
        self.file.rewind()?;
        // At once: each part of a format would be a call of the operating system.
        self.file.write_all(format!("{number:<20}").as_bytes())?;
        let mut running = RUNNING.lock().unwrap_or_else(PoisonError::into_inner);
        let entry = running.get_or_insert_with(|| Running { target: "", input: Vec::new(), since: Instant::now() });
        entry.target = self.target;
        entry.input.clear();
        entry.input.extend_from_slice(input);
        entry.since = Instant::now();
        Ok(())
    }

    /// After the last execution.
    ///
    /// # Errors
    /// The file cannot be removed.
    pub fn end(self) -> io::Result<()> {
        *RUNNING.lock().unwrap_or_else(PoisonError::into_inner) = None;
        fs::remove_file(self.path)
    }
}

/// Ends the program with status 1 where an input asks for too much memory or does not end, after
/// it is kept.
pub fn watch() {
    crate::allocation::at_refusal(|size| give_up(&format!("asked for {} MB more than it may", size >> 20)));
    std::thread::spawn(|| {
        loop {
            std::thread::sleep(Duration::from_secs(1));
            let running = RUNNING.lock().unwrap_or_else(PoisonError::into_inner);
            let is_over = running.as_ref().is_some_and(|running| running.since.elapsed() > MAX_TIME);
            drop(running);
            if is_over {
                give_up("did not end");
            }
        }
    });
}

fn give_up(what: &str) {
    let Some(running) = RUNNING.lock().unwrap_or_else(PoisonError::into_inner).take() else { return };
    match keep(running.target, &running.input) {
        Ok(path) => eprintln!("{}: {what}: {}", running.target, path.display()),
        Err(error) => eprintln!("{}: {what}, and cannot be kept: {error}", running.target),
    }
    std::process::exit(1);
}
