//! A batch in parts, for a program that hands them to other processes: rows as text go to a part,
//! lines of the tables as text come back.

use super::job::Job;
use super::manifest::{self, Row};
use super::progress::Progress;
use super::store::Store;
use super::tables::{Line, json_lines, write};
use super::work::{self, Plan};
use crate::cli::console::Console;
use crate::error::bail_output;
use crate::output::OutputLock;
use anyhow::{Context, Result};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// What the unfinished work of a part is named after; the whole batch removes what is left of it.
const PREFIX: &str = "part_";

/// Rows of a manifest, and where their results go.
#[derive(Debug, Clone)]
pub struct Part {
    /// [`Row::to_json`] of each, a line each.
    pub rows: String,
    /// Where files lie that options name.
    pub folders: [PathBuf; 2],
    /// Folder of all results.
    pub out: PathBuf,
    /// A name that no other part has, of letters and digits.
    pub name: String,
    /// Recordings that are worked on at once.
    pub jobs: usize,
    /// Failures of earlier runs are tried again.
    pub retry_failed: bool,
}

impl Part {
    /// Works on the rows, and returns lines as JSON in their order.
    ///
    /// # Errors
    /// Rows that are none, a folder that cannot be written.
    pub fn work(&self, stop: &AtomicBool) -> Result<String> {
        let rows = self.read()?;
        let store = Store::open(&self.out, &format!("{PREFIX}{}", self.name))?;
        let plan = Plan { jobs: self.jobs, retry_failed: self.retry_failed };
        let quiet = Console { quiet: true, json: true };
        let work::Done { lines, .. } =
            work::all(&rows, &store, plan, &Progress::new(rows.len(), &quiet, false)?, stop)?;
        store.close();
        Ok(json_lines(&lines)?)
    }

    /// The key of each row, none where the row cannot have one.
    ///
    /// # Errors
    /// Rows that are none.
    pub fn keys(&self) -> Result<Vec<Option<String>>> {
        Ok(self.read()?.iter().map(|row| Some(Job::of(row).ok()?.key)).collect())
    }

    fn read(&self) -> Result<Vec<Row>> {
        manifest::of_lines(&self.rows, "part", &self.folders)
    }
}

/// A batch whose parts others work on, in a folder that no other batch has.
#[derive(Debug)]
pub struct Whole {
    out: PathBuf,
    lines: Vec<Line>,
    _lock: OutputLock,
}

impl Whole {
    /// A batch of recordings with these names into the folder `out`.
    ///
    /// # Errors
    /// The folder cannot be written, or another batch writes it.
    pub fn begin(out: &Path, ids: Vec<String>) -> Result<Self> {
        make_folder(out)?;
        let lock = OutputLock::of_table(&out.join("status.csv"), "batch")?;
        Store::open(out, "status")?.close();
        let open = |id| Line { id, key: String::new(), ended: None };
        Ok(Self { out: out.to_path_buf(), lines: ids.into_iter().map(open).collect(), _lock: lock })
    }

    /// Takes the lines that a part returned; `rows` are the numbers of its recordings.
    ///
    /// # Errors
    /// Lines that are none.
    pub fn add(&mut self, rows: &[usize], lines: &str) -> Result<()> {
        for (row, text) in rows.iter().zip(lines.lines()) {
            let line: Line = serde_json::from_str(text).context("a part returned no lines")?;
            let known = self.lines.get_mut(*row).filter(|known| known.id == line.id);
            *known.context("a part returned other recordings than it had")? = line;
        }
        Ok(())
    }

    /// Writes both tables, and removes what killed parts left if no part can be at work any more.
    ///
    /// # Errors
    /// A table that cannot be written.
    pub fn end(&self, all_parts_ended: bool) -> Result<()> {
        write(&self.lines, &self.out.join("status.csv"), &self.out.join("summary.csv"))?;
        if all_parts_ended {
            Store::sweep(&self.out, PREFIX);
        }
        Ok(())
    }
}

/// Makes the folder of a batch.
///
/// # Errors
/// It cannot be made.
pub fn make_folder(out: &Path) -> crate::error::Result<()> {
    match std::fs::create_dir_all(out) {
        Ok(()) => Ok(()),
        Err(error) => bail_output!("`{}` cannot be made ({error}); choose another --out", out.display()),
    }
}
