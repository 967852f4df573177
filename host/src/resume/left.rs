//! What a run leaves that did not reach its end: how far it got and its state, in a file beside its
//! results.

use super::{Begun, REMEDY};
use crate::error::{Context, Result, WriteContext, bail, ensure};
use crate::file::read_text_within;
use crate::json_file::read_json;
use crate::limits::MAX_FILE_BYTES;
use crate::output::{Mark, PendingFile, mark, write_atomically};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Name of the file in a run directory.
pub const RESUME_FILE: &str = "resume.json";
/// The table of answers.
pub const TRACK_TABLE: &str = "track.csv";
/// The table of particles, of runs that write them.
pub const PARTICLE_TABLE: &str = "particles.csv";

/// A run as it was left; `S` is what the command needs of it.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Left<S> {
    /// How it was begun.
    pub begun: Begun,
    /// Frames that are finished.
    pub finished: usize,
    /// Time spent so far, seconds.
    pub seconds: f64,
    /// CRC-32 of the last finished frame's input; none where it could not be read.
    pub last_crc32: Option<u32>,
    /// How far each table has grown.
    tables: BTreeMap<String, Mark>,
    /// The rest.
    pub state: S,
}

impl<S> Left<S> {
    /// A run so far; [`Left::with_tables`] adds what there is of its tables.
    pub fn new(begun: Begun, finished: usize, seconds: f64, last_crc32: Option<u32>, state: S) -> Self {
        Self { begun, finished, seconds, last_crc32, tables: BTreeMap::new(), state }
    }

    /// Writes out the rows of the tables, and remembers how far these have grown.
    ///
    /// # Errors
    /// One cannot be written.
    pub fn with_tables(
        mut self,
        track: &mut csv::Writer<PendingFile>,
        particles: Option<&mut csv::Writer<PendingFile>>,
    ) -> Result<Self> {
        self.tables.insert(TRACK_TABLE.to_owned(), mark(track)?);
        if let Some(particles) = particles {
            self.tables.insert(PARTICLE_TABLE.to_owned(), mark(particles)?);
        }
        Ok(self)
    }

    /// Remembers how far the table `name` has grown.
    #[must_use]
    pub fn with_table(mut self, name: &str, mark: Mark) -> Self {
        self.tables.insert(name.to_owned(), mark);
        self
    }

    /// Whether it has tables to go on with.
    pub fn has_tables(&self) -> bool {
        !self.tables.is_empty()
    }

    /// The table `name` of the finished frames, to be written on; its file is `path`.
    ///
    /// # Errors
    /// It is no longer as it was left.
    pub fn reopened(&self, name: &str, path: &Path) -> Result<PendingFile> {
        let mark = self.tables.get(name).with_context(|| format!("the run left no `{name}`; {REMEDY}"))?;
        PendingFile::reopen(path, mark)
    }

    /// Refuses another input for the last finished frame, `name`, than there was; `crc32` is that
    /// of the present one. One that could not be read then is not compared.
    ///
    /// # Errors
    /// It is another.
    pub fn check_last(&self, name: &str, crc32: Option<u32>) -> Result<()> {
        ensure!(
            self.last_crc32.is_none() || self.last_crc32 == crc32,
            "`{name}` has changed since the run was ended; {REMEDY}"
        );
        Ok(())
    }
}

/// Where a run of one command keeps what it leaves.
#[derive(Debug, Clone)]
pub struct ResumeFile {
    path: PathBuf,
    command: &'static str,
}

impl ResumeFile {
    /// [`RESUME_FILE`] in the run directory `out`.
    #[must_use]
    pub fn in_folder(out: &Path, command: &'static str) -> Self {
        Self { path: out.join(RESUME_FILE), command }
    }

    /// `NAME_resume.json` beside the table `NAME.csv`.
    #[must_use]
    pub fn beside(table: &Path, command: &'static str) -> Self {
        let stem = table.file_stem().unwrap_or_default().to_string_lossy();
        Self { path: table.with_file_name(format!("{stem}_{RESUME_FILE}")), command }
    }

    /// Name of the file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes what is left.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn put<S: Serialize>(&self, left: &Left<S>) -> Result<()> {
        write_atomically(&self.path, |writer| Ok(serde_json::to_writer_pretty(writer, left)?))
    }

    /// Removes what an earlier run left, if it left something.
    ///
    /// # Errors
    /// The file cannot be removed.
    pub fn remove(&self) -> Result<()> {
        match fs::remove_file(&self.path) {
            Err(error) if self.path.exists() => {
                Err(error).writing(|| format!("`{}` cannot be removed", self.path.display()))
            }
            _ => Ok(()),
        }
    }

    /// Reads what was left in `out`.
    ///
    /// # Errors
    /// There is nothing, or it is of another version or command, or not whole.
    pub fn read<S: DeserializeOwned>(&self, out: &Path) -> Result<Left<S>> {
        let path = self.path.display();
        if !self.path.exists() {
            let report = read_json::<Value>(&out.join("run.json"));
            if report.is_ok_and(|report| report["complete"] == true) {
                bail!("the run in `{}` is complete; {REMEDY}", out.display());
            }
            bail!("`{}` holds no unfinished run (no `{path}`); {REMEDY}", out.display());
        }
        // It grows with the number of frames, and is written in full whatever its size.
        let text = read_text_within(&self.path, MAX_FILE_BYTES)
            .with_context(|| format!("`{path}` cannot be read; {REMEDY}"))?;
        // As a value first: its numbers are parsed exactly.
        let value: Value = serde_json::from_str(&text).with_context(|| format!("`{path}` is not JSON; {REMEDY}"))?;
        Begun::check_kind(&value["begun"], self.command, &self.path)?;
        let left: Left<S> =
            serde_json::from_value(value).with_context(|| format!("`{path}` is not whole; {REMEDY}"))?;
        // A number such as 1e999 is legal JSON.
        ensure!(
            left.seconds >= 0.0 && left.seconds.is_finite(),
            "`{path}`: `seconds` is {}, and has to be finite and at least 0; {REMEDY}",
            left.seconds
        );
        Ok(left)
    }
}

/// CRC-32 of text that stands for an input.
#[must_use]
pub fn text_crc32(text: &str) -> u32 {
    crc32fast::hash(text.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn what_was_left_comes_back_exactly_and_to_its_own_command_only() {
        let folder = tempfile::tempdir().unwrap();
        let begun = Begun::new("track arm", &json!({ "seed": 1 }), &[]).unwrap();
        let numbers = vec![0.1, 1.0 / 3.0, f64::MIN_POSITIVE, 6.283_185_307_179_586e-7, -1.0e300];
        let left = Left::new(begun, 3, 0.1 + 0.2, Some(9), numbers.clone());
        let file = ResumeFile::in_folder(folder.path(), "track arm");
        file.put(&left).unwrap();
        let back: Left<Vec<f64>> = file.read(folder.path()).unwrap();
        assert_eq!((back.finished, back.seconds.to_bits(), back.last_crc32), (3, (0.1_f64 + 0.2).to_bits(), Some(9)));
        assert_eq!(back.state, numbers);
        let other = ResumeFile::in_folder(folder.path(), "track body");
        let message = other.read::<Vec<f64>>(folder.path()).unwrap_err().to_string();
        assert!(message.contains("left by `sinew track arm`, not by `sinew track body`"), "{message}");
        file.remove().unwrap();
        file.remove().unwrap();
        assert!(file.read::<Vec<f64>>(folder.path()).unwrap_err().to_string().contains("holds no unfinished run"));
    }

    #[test]
    fn a_time_beyond_all_numbers_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let begun = Begun::new("track arm", &json!({}), &[]).unwrap();
        let file = ResumeFile::in_folder(folder.path(), "track arm");
        file.put(&Left::new(begun, 3, 12.25, None, Value::Null)).unwrap();
        let text = fs::read_to_string(&file.path).unwrap();
        for wrong in ["1e999", "-1.0"] {
            fs::write(&file.path, text.replace("12.25", wrong)).unwrap();
            let message = file.read::<Value>(folder.path()).unwrap_err().to_string();
            assert!(message.contains("`seconds` is"), "{message}");
        }
    }
}
