//! What is kept of each recording, under its key.

use super::content::names_in;
use crate::error::{Context, Result};
use crate::file::read_bytes;
use crate::output::write_atomically;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// File in each result's folder that says how it came about.
const JOB: &str = "job.json";
/// Most bytes of such a file: an answer has a few thousand.
const MAX_JOB_BYTES: u64 = 1 << 24;

/// How a recording ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Ended {
    /// Seconds of the last attempt.
    pub seconds: f64,
    /// How often it was tried.
    pub attempts: u32,
    /// What failed; nothing if there is a result.
    pub failure: Option<Failure>,
    /// What the last command answered.
    pub answer: Value,
}

/// Why there is no result.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Failure {
    /// Kind of the error, as in `docs/interruptions.md`.
    pub class: String,
    /// What was wrong, and the remedy.
    pub message: String,
}

/// The folder of a batch: `results/KEY`, `errors/KEY.json`, and `unfinished`.
#[derive(Debug, Clone)]
pub struct Store {
    root: PathBuf,
    /// Work that has not ended, of this process alone.
    unfinished: PathBuf,
}

impl Store {
    /// The store at `root` for the shard `name`, whose work that a killed one left is removed.
    ///
    /// # Errors
    /// The folder cannot be written.
    pub fn open(root: &Path, name: &str) -> Result<Self> {
        let store = Self { root: root.to_path_buf(), unfinished: root.join("unfinished").join(name) };
        if store.unfinished.exists() {
            fs::remove_dir_all(&store.unfinished).with_context(|| cannot_write(&store.unfinished))?;
        }
        for folder in [root.join("results"), root.join("errors"), store.unfinished.clone()] {
            fs::create_dir_all(&folder).with_context(|| cannot_write(&folder))?;
        }
        Ok(store)
    }

    /// Where the result of `key` is.
    #[must_use]
    pub fn result(&self, key: &str) -> PathBuf {
        self.root.join("results").join(key)
    }

    fn error(&self, key: &str) -> PathBuf {
        self.root.join("errors").join(format!("{key}.json"))
    }

    /// How `key` ended before, if it did; a file that cannot be read counts as none.
    #[must_use]
    pub fn ended(&self, key: &str) -> Option<Ended> {
        let read = |path: PathBuf| serde_json::from_slice(&read_bytes(&path, MAX_JOB_BYTES).ok()?).ok();
        read(self.result(key).join(JOB)).or_else(|| read(self.error(key)))
    }

    /// An empty folder for the work on `key`.
    ///
    /// # Errors
    /// It cannot be made.
    pub fn begin(&self, key: &str) -> Result<PathBuf> {
        let folder = self.unfinished.join(key);
        if folder.exists() {
            fs::remove_dir_all(&folder).with_context(|| cannot_write(&folder))?;
        }
        fs::create_dir_all(&folder).with_context(|| cannot_write(&folder))?;
        Ok(folder)
    }

    /// Keeps what was made in `folder`, all of it or nothing.
    ///
    /// # Errors
    /// It cannot be written or moved.
    pub fn keep(&self, key: &str, folder: &Path, ended: &Ended) -> Result<()> {
        write_json(&folder.join(JOB), ended)?;
        let target = self.result(key);
        if let Err(error) = fs::rename(folder, &target)
            && self.ended(key).is_none_or(|ended| ended.failure.is_some())
        {
            return Err(error).with_context(|| cannot_write(&target));
        }
        // Another shard may have made the same; an error of an earlier run does not count any more.
        let _ = fs::remove_dir_all(folder);
        let _ = fs::remove_file(self.error(key));
        Ok(())
    }

    /// Keeps that `key` has no result.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn fail(&self, key: &str, folder: &Path, ended: &Ended) -> Result<()> {
        write_json(&self.error(key), ended)?;
        let _ = fs::remove_dir_all(folder);
        Ok(())
    }

    /// Removes the folder of unfinished work.
    pub fn close(&self) {
        let _ = fs::remove_dir_all(&self.unfinished);
        // Stays while another shard works.
        let _ = fs::remove_dir(self.root.join("unfinished"));
    }

    /// Removes the unfinished work in `root` of those whose names begin with `prefix`.
    pub fn sweep(root: &Path, prefix: &str) {
        let folder = root.join("unfinished");
        for name in names_in(&folder).unwrap_or_default().iter().filter(|name| name.starts_with(prefix)) {
            let _ = fs::remove_dir_all(folder.join(name));
        }
        let _ = fs::remove_dir(folder);
    }
}

fn cannot_write(path: &Path) -> String {
    format!("`{}` cannot be written; choose another --out", path.display())
}

fn write_json(path: &Path, ended: &Ended) -> Result<()> {
    write_atomically(path, |file| Ok(serde_json::to_writer(file, ended)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_result_is_there_as_a_whole_and_takes_the_place_of_an_error() {
        let root = tempfile::tempdir().unwrap();
        let store = Store::open(root.path(), "status").unwrap();
        let failure = Failure { class: "data".into(), message: "no".into() };
        let failed = Ended { seconds: 1.0, attempts: 1, failure: Some(failure), answer: Value::Null };
        store.fail("k", &store.begin("k").unwrap(), &failed).unwrap();
        assert_eq!(store.ended("k"), Some(failed.clone()));
        let folder = store.begin("k").unwrap();
        fs::write(folder.join("estimate.csv"), "1").unwrap();
        assert!(!store.result("k").exists());
        let good = Ended { failure: None, ..failed };
        store.keep("k", &folder, &good).unwrap();
        assert_eq!(
            (store.ended("k"), fs::read(store.result("k").join("estimate.csv")).unwrap()),
            (Some(good), vec![b'1'])
        );
        fs::create_dir_all(root.path().join("unfinished/status/old")).unwrap();
        Store::open(root.path(), "status").unwrap().close();
        assert!(!root.path().join("unfinished").exists());
    }
}
