//! Recordings on several threads, each of which is done once.

use super::job::Job;
use super::manifest::Row;
use super::progress::Progress;
use super::store::{Ended, Failure, Store};
use super::tables::{Line, Outcome};
use crate::cli::console::Console;
use crate::cli::stdout::captured;
use crate::cli::{Cli, interrupted, kind_of, run};
use crate::error::{Error, ErrorKind};
use anyhow::Result;
use serde_json::Value;
use std::collections::{BTreeMap, HashMap};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// How often a recording is tried whose files the operating system refuses.
const MAX_ATTEMPTS: u32 = 3;
/// Pause before it is tried again; each is twice the one before.
const FIRST_PAUSE: Duration = Duration::from_millis(200);

/// How the work is done.
#[derive(Debug, Clone, Copy)]
pub struct Plan {
    /// Threads.
    pub jobs: usize,
    /// Failures of earlier runs are tried again.
    pub retry_failed: bool,
}

/// What the threads share.
struct Work<'a> {
    rows: &'a [Row],
    store: &'a Store,
    plan: Plan,
    stop: &'a AtomicBool,
    next: AtomicUsize,
    lines: Mutex<Vec<Option<Line>>>,
    /// The row that does the work of each key.
    first_of: Mutex<HashMap<String, usize>>,
    /// Rows that ask for the same as another, with that one.
    twins: Mutex<Vec<(usize, usize)>>,
    /// Of each default how many rows are of a kind that does not have it.
    left_out: Mutex<BTreeMap<String, usize>>,
    /// What ended the work as a whole.
    broken: Mutex<Option<anyhow::Error>>,
}

/// What the work came to.
#[derive(Debug)]
pub struct Done {
    /// A line a row.
    pub lines: Vec<Line>,
    /// Of each default how many rows are of a kind that does not have it.
    pub left_out: BTreeMap<String, usize>,
}

/// Does what is not done yet. Rows that ask for the same are done once.
///
/// # Errors
/// The store cannot be written.
pub fn all(rows: &[Row], store: &Store, plan: Plan, progress: &Progress, stop: &AtomicBool) -> Result<Done> {
    let work = Work {
        rows,
        store,
        plan,
        stop,
        next: AtomicUsize::new(0),
        lines: Mutex::new(vec![None; rows.len()]),
        first_of: Mutex::default(),
        twins: Mutex::default(),
        left_out: Mutex::default(),
        broken: Mutex::default(),
    };
    std::thread::scope(|scope| {
        for _ in 0..plan.jobs.min(rows.len()) {
            scope.spawn(|| work.many(&|| progress.add_one(stop)));
        }
    });
    work.done()
}

impl Work<'_> {
    /// One row after the other, until there is none or the work ends.
    fn many(&self, notify: &dyn Fn()) {
        while !self.stop.load(Ordering::Relaxed) && locked(&self.broken).is_none() {
            let index = self.next.fetch_add(1, Ordering::Relaxed);
            if index >= self.rows.len() {
                break;
            }
            if let Err(error) = self.one(index) {
                *locked(&self.broken) = Some(error);
            }
            notify();
        }
    }

    fn one(&self, index: usize) -> Result<()> {
        let row = &self.rows[index];
        let put = |key: &str, ended| {
            locked(&self.lines)[index] = Some(Line { id: row.id.clone(), key: key.to_owned(), ended });
        };
        let job = match Job::of(row) {
            Ok(job) => job,
            Err(error) => {
                put("", Some(Outcome::of(failed(&error.into(), Instant::now(), 1), false)));
                return Ok(());
            }
        };
        for name in &job.left_out {
            *locked(&self.left_out).entry(name.clone()).or_default() += 1;
        }
        let first = *locked(&self.first_of).entry(job.key.clone()).or_insert(index);
        if first != index {
            locked(&self.twins).push((index, first));
            return Ok(());
        }
        let before = self.store.ended(&job.key);
        let ended = match before.filter(|ended| ended.failure.is_none() || !self.plan.retry_failed) {
            Some(ended) => Some(Outcome::of(ended, true)),
            None => tried(&job, self.store, self.stop)?.map(|ended| Outcome::of(ended, false)),
        };
        put(&job.key, ended);
        Ok(())
    }

    fn done(self) -> Result<Done> {
        let Self { rows, lines, twins, left_out, broken, .. } = self;
        if let Some(error) = inner(broken) {
            return Err(error);
        }
        let open = |row: &Row| Line { id: row.id.clone(), key: String::new(), ended: None };
        let mut lines: Vec<Line> =
            inner(lines).into_iter().zip(rows).map(|(line, row)| line.unwrap_or_else(|| open(row))).collect();
        for (twin, first) in inner(twins) {
            lines[twin] = Line { id: rows[twin].id.clone(), ..lines[first].clone() };
        }
        Ok(Done { lines, left_out: inner(left_out) })
    }
}

fn inner<T>(mutex: Mutex<T>) -> T {
    mutex.into_inner().unwrap_or_else(PoisonError::into_inner)
}

/// What another thread holds is whole even where it panicked: a panic of a recording is caught.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Tries `job` until it has a result or an error that stays; nothing if a signal ended it.
fn tried(job: &Job, store: &Store, stop: &AtomicBool) -> Result<Option<Ended>> {
    let mut pause = FIRST_PAUSE;
    for attempt in 1.. {
        let begun = Instant::now();
        let folder = store.begin(&job.key)?;
        let error = match done(job, &folder) {
            Ok(answer) => {
                let ended = Ended { seconds: begun.elapsed().as_secs_f64(), attempts: attempt, failure: None, answer };
                store.keep(&job.key, &folder, &ended)?;
                return Ok(Some(ended));
            }
            Err(error) => error,
        };
        if interrupted(&error).is_some() || stop.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let may_pass = matches!(kind_of(&error), ErrorKind::Io | ErrorKind::TryAgain);
        if !may_pass || attempt == MAX_ATTEMPTS {
            let ended = failed(&error, begun, attempt);
            store.fail(&job.key, &folder, &ended)?;
            return Ok(Some(ended));
        }
        std::thread::sleep(pause);
        pause *= 2;
    }
    Ok(None)
}

/// Runs the commands of `job`; what the last one answers.
fn done(job: &Job, folder: &Path) -> Result<Value> {
    let mut answer = Value::Null;
    for (index, line) in job.command_lines(folder)?.into_iter().enumerate() {
        if index > 0 {
            job.check_rate(&answer)?;
        }
        let line = Cli { console: Console { quiet: true, json: true }, ..line };
        let (ended, text) = captured(|| catch_unwind(AssertUnwindSafe(|| run(&line))));
        ended.unwrap_or_else(|_| Err(Error::Invalid("a fault of the program; please report it".into()).into()))?;
        answer = serde_json::from_slice(&text).unwrap_or_default();
    }
    // Names of files are those of the folder before it is moved.
    if let Some(parts) = answer.as_object_mut() {
        parts.retain(|_, part| !part.is_string());
    }
    Ok(answer)
}

fn failed(error: &anyhow::Error, begun: Instant, attempts: u32) -> Ended {
    let failure = Failure { class: kind_of(error).name().to_owned(), message: format!("{error:#}") };
    Ended { seconds: begun.elapsed().as_secs_f64(), attempts, failure: Some(failure), answer: Value::Null }
}
