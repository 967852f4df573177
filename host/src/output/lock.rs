//! One run at a time in a folder of results, or at a table.

use super::file::{parent_of, temporary_prefix};
use super::folder::sweep;
use super::{LOCK_PREFIX, TEMPORARY_PREFIX};
use crate::error::{Error, Result, WriteContext};
use std::fs::{self, File, TryLockError};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// A folder or a table that no other run may write for as long as this exists.
///
/// The operating system lets go of it with the process, however that ends.
#[derive(Debug)]
pub struct OutputLock {
    path: PathBuf,
    /// Locked; none on a file system without locks.
    file: Option<File>,
}

impl OutputLock {
    /// Takes `folder` for the run of the subcommand `command`, and removes what a killed one left
    /// of its temporary files.
    ///
    /// # Errors
    /// [`Error::InUse`] if another process has it; a folder that refuses the file.
    pub fn of_folder(folder: &Path, command: &str) -> Result<Self> {
        let lock = Self::take(folder.join(LOCK_PREFIX), folder, command)?;
        lock.sweep(folder);
        Ok(lock)
    }

    /// Removes what a killed run left of its temporary files in `folder`, the locked one or one
    /// below; without locks they may be another run's.
    pub fn sweep(&self, folder: &Path) {
        if self.file.is_some() {
            sweep(folder, TEMPORARY_PREFIX, Duration::ZERO);
        }
    }

    /// As [`OutputLock::sweep`], of the files that were to become `file`.
    pub fn sweep_of(&self, file: &Path) {
        if self.file.is_some() {
            sweep(parent_of(file), &temporary_prefix(file), Duration::ZERO);
        }
    }

    /// Takes the table `table` for the run of `command`.
    ///
    /// # Errors
    /// As [`OutputLock::of_folder`].
    pub fn of_table(table: &Path, command: &str) -> Result<Self> {
        let name = table.file_name().unwrap_or_default().to_string_lossy();
        Self::take(table.with_file_name(format!("{LOCK_PREFIX}-{name}")), table, command)
    }

    fn take(path: PathBuf, output: &Path, command: &str) -> Result<Self> {
        let cannot = || format!("`{}` cannot be written; choose another output", output.display());
        loop {
            let open = File::options().read(true).write(true).create(true).truncate(false).open(&path);
            let mut file = open.writing(cannot)?;
            match file.try_lock() {
                Ok(()) if !is_at(&file, &path) => continue,
                Ok(()) => {
                    let owner = format!("`sinew {command}`, process {} on {}\n", std::process::id(), host());
                    file.set_len(0).and_then(|()| file.write_all(owner.as_bytes())).writing(cannot)?;
                    return Ok(Self { path, file: Some(file) });
                }
                Err(TryLockError::WouldBlock) => {
                    let mut owner = String::new();
                    // Another process may be writing it just now.
                    let _ = file.read_to_string(&mut owner);
                    return Err(Error::InUse { output: output.to_path_buf(), owner: owner.trim().to_owned() });
                }
                Err(TryLockError::Error(_)) => return Ok(Self { path, file: None }),
            }
        }
    }
}

impl Drop for OutputLock {
    fn drop(&mut self) {
        // Before the lock is let go of, so that no other process has it.
        let _ = fs::remove_file(&self.path);
        drop(self.file.take());
    }
}

/// Whether `file` is still what `path` names: its owner may have removed it in between.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let same = || -> std::io::Result<bool> {
        let (open, named) = (file.metadata()?, fs::metadata(path)?);
        Ok((open.dev(), open.ino()) == (named.dev(), named.ino()))
    };
    same().unwrap_or(false)
}

#[cfg(not(unix))]
fn is_at(_: &File, path: &Path) -> bool {
    path.exists()
}

fn host() -> String {
    gethostname::gethostname().to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_has_one_owner_who_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let first = OutputLock::of_folder(folder.path(), "track arm").unwrap();
        let message = OutputLock::of_folder(folder.path(), "track body").unwrap_err().to_string();
        let owner = format!("`sinew track arm`, process {}", std::process::id());
        assert!(message.contains(&owner) && message.contains("another --out"), "{message}");
        drop(first);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        OutputLock::of_folder(folder.path(), "track body").unwrap();
    }
}
