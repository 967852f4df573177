//! How far a batch is: a bar, or lines for a log and for programs.

use crate::cli::console::Console;
use anyhow::Result;
use indicatif::ProgressBar;
use serde_json::json;
use std::io::{ErrorKind, Write, stderr};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Least time between two lines of a log; chosen, so that a day has some thousand.
const LOG_PERIOD: Duration = Duration::from_secs(10);
/// Least time between two lines for a program; chosen: 0.1 to 1 s look alike.
const JSON_PERIOD: Duration = Duration::from_millis(250);

/// How many recordings have ended.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    lines: Option<Mutex<Lines>>,
}

/// What is written in the place of a bar.
#[derive(Debug)]
struct Lines {
    is_json: bool,
    recordings: u64,
    done: u64,
    begun: Instant,
    written: Option<Instant>,
}

impl Progress {
    /// Of so many recordings; as lines on standard error where `as_lines`.
    ///
    /// # Errors
    /// None in practice.
    pub fn new(recordings: usize, console: &Console, as_lines: bool) -> Result<Self> {
        let recordings = recordings as u64;
        let lines = Lines { is_json: console.json, recordings, done: 0, begun: Instant::now(), written: None };
        let shown = Console { quiet: console.quiet || as_lines, ..*console };
        let bar = shown.bar(recordings, "{wide_bar} {pos} of {len}, {eta} left")?;
        Ok(Self { bar, lines: as_lines.then(|| Mutex::new(lines)) })
    }

    /// Another recording has ended. Sets `stop` where whoever reads the lines has gone away: a
    /// program that was killed does not leave its batch behind.
    pub fn add_one(&self, stop: &AtomicBool) {
        self.bar.inc(1);
        let Some(lines) = &self.lines else { return };
        let line = lines.lock().unwrap_or_else(PoisonError::into_inner).next();
        let written = line.map_or(Ok(()), |line| stderr().lock().write_all(line.as_bytes()));
        if written.is_err_and(|error| error.kind() == ErrorKind::BrokenPipe) {
            stop.store(true, Ordering::Relaxed);
        }
    }

    /// Takes the bar away.
    pub fn end(self) {
        self.bar.finish_and_clear();
    }
}

impl Lines {
    fn next(&mut self) -> Option<String> {
        self.done += 1;
        let period = if self.is_json { JSON_PERIOD } else { LOG_PERIOD };
        if self.written.is_some_and(|written| written.elapsed() < period) && self.done < self.recordings {
            return None;
        }
        self.written = Some(Instant::now());
        let (done, of) = (self.done, self.recordings);
        let left_s = self.begun.elapsed().as_secs_f64() / done as f64 * (of - done) as f64;
        Some(match self.is_json {
            true => format!("{}\n", json!({ "progress": { "done": done, "of": of, "left_s": left_s } })),
            false => format!("{done} of {of}, {left_s:.0} s left\n"),
        })
    }
}
