//! A file that grows while a run goes on.

use super::file::{parent_of, sync_folder};
use crate::error::{Result, WriteContext, ensure};
use crate::wording::REMEDY;
use serde::{Deserialize, Serialize};
use std::fs::{self, File};
use std::io::{BufWriter, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// What is added to the name of a file for as long as it grows.
const SUFFIX: &str = ".partial";

/// How far a file had grown: its content up to there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Mark {
    bytes: u64,
    crc32: u32,
}

/// A file that grows as `NAME.partial` and becomes `NAME` at the end.
///
/// Dropped before, it leaves nothing, unless it was marked: then a later run goes on from the mark.
#[derive(Debug)]
pub struct PendingFile {
    path: PathBuf,
    writer: BufWriter<File>,
    bytes: u64,
    hasher: crc32fast::Hasher,
    /// Whether the partial file stays when this is dropped.
    is_kept: AtomicBool,
}

impl PendingFile {
    /// Begins the file `path`.
    ///
    /// # Errors
    /// Names the file if its folder refuses it.
    pub(super) fn begin(path: &Path) -> Result<Self> {
        let file = File::create(partial(path)).writing(|| format!("`{}` cannot be written", path.display()))?;
        Ok(Self {
            path: path.to_path_buf(),
            writer: BufWriter::new(file),
            bytes: 0,
            hasher: crc32fast::Hasher::new(),
            is_kept: AtomicBool::new(false),
        })
    }

    /// Goes on with the file `path`, partial or finished, from where it was marked.
    ///
    /// # Errors
    /// It has another content up to there.
    pub fn reopen(path: &Path, mark: &Mark) -> Result<Self> {
        if let Some(hasher) = hash_of(&partial(path), mark) {
            let inner = || -> std::io::Result<File> {
                let mut file = File::options().write(true).open(partial(path))?;
                file.set_len(mark.bytes)?;
                file.seek(SeekFrom::End(0))?;
                Ok(file)
            };
            let file = inner().writing(|| format!("`{}` cannot be written", path.display()))?;
            let is_kept = AtomicBool::new(true);
            return Ok(Self {
                path: path.to_path_buf(),
                writer: BufWriter::new(file),
                bytes: mark.bytes,
                hasher,
                is_kept,
            });
        }
        let is_whole = fs::metadata(path).is_ok_and(|facts| facts.len() == mark.bytes);
        ensure!(
            is_whole && hash_of(path, mark).is_some(),
            "`{}` has changed since the run was ended; {REMEDY}",
            path.display()
        );
        let mut pending = Self::begin(path)?;
        let mut copy = || std::io::copy(&mut File::open(path)?, &mut pending);
        copy().writing(|| format!("`{}` cannot be written", path.display()))?;
        Ok(pending)
    }

    /// Removes what a run that did not reach its end left of the file `path`.
    ///
    /// # Errors
    /// It cannot be removed.
    pub fn remove_left(path: &Path) -> Result<()> {
        match fs::remove_file(partial(path)) {
            Err(error) if error.kind() != ErrorKind::NotFound => {
                Err(error).writing(|| format!("`{}` cannot be removed", partial(path).display()))
            }
            _ => Ok(()),
        }
    }

    /// How far the file has grown, what was written being synced; the partial file stays from now
    /// on.
    pub(super) fn mark(&self) -> Result<Mark> {
        let synced = self.writer.get_ref().sync_data();
        synced.writing(|| format!("`{}` cannot be written", self.path.display()))?;
        self.is_kept.store(true, Ordering::Relaxed);
        Ok(Mark { bytes: self.bytes, crc32: self.hasher.clone().finalize() })
    }

    /// Gives the file its name, replacing what was there.
    ///
    /// # Errors
    /// Names the file if what is left cannot be written or the name cannot be taken.
    pub fn finish(self) -> Result<()> {
        finish_all([self])
    }

    fn sync(&mut self) -> Result<()> {
        let mut inner = || -> std::io::Result<()> {
            self.writer.flush()?;
            self.writer.get_ref().sync_all()
        };
        inner().writing(|| format!("`{}` cannot be written", self.path.display()))
    }

    fn rename(self) -> Result<()> {
        let named = fs::rename(partial(&self.path), &self.path);
        named.writing(|| format!("`{}` cannot be written", self.path.display()))?;
        sync_folder(parent_of(&self.path))
    }
}

impl Write for PendingFile {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let count = self.writer.write(bytes)?;
        self.hasher.update(&bytes[..count]);
        self.bytes += count as u64;
        Ok(count)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.writer.flush()
    }
}

impl Drop for PendingFile {
    fn drop(&mut self) {
        if !self.is_kept.load(Ordering::Relaxed) {
            // After a rename there is none.
            let _ = fs::remove_file(partial(&self.path));
        }
    }
}

/// Gives the files of a run their names, after the last of them is written and synced.
///
/// # Errors
/// Names the file that cannot be written; then none has its name, unless a rename failed.
pub fn finish_all(files: impl IntoIterator<Item = PendingFile>) -> Result<()> {
    let mut files: Vec<PendingFile> = files.into_iter().collect();
    files.iter_mut().try_for_each(PendingFile::sync)?;
    files.into_iter().try_for_each(PendingFile::rename)
}

/// Writes out a table's rows and says how far it has grown.
///
/// # Errors
/// Names the file if it cannot be written.
pub fn mark(table: &mut csv::Writer<PendingFile>) -> Result<Mark> {
    table.flush().writing(|| format!("`{}` cannot be written", table.get_ref().path.display()))?;
    table.get_ref().mark()
}

/// The file of a table whose last row is written.
///
/// # Errors
/// Its rows cannot be written.
pub fn finished_table(table: csv::Writer<PendingFile>) -> Result<PendingFile> {
    let path = table.get_ref().path.clone();
    table.into_inner().writing(|| format!("`{}` cannot be written", path.display()))
}

fn partial(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(SUFFIX);
    path.with_file_name(name)
}

/// State of the checksum at the mark, if the file has the marked content.
fn hash_of(path: &Path, mark: &Mark) -> Option<crc32fast::Hasher> {
    let mut left = File::open(path).ok()?.take(mark.bytes);
    let (mut hasher, mut buffer, mut bytes) = (crc32fast::Hasher::new(), vec![0; 1 << 16], 0);
    loop {
        let count = left.read(&mut buffer).ok()?;
        if count == 0 {
            break;
        }
        hasher.update(&buffer[..count]);
        bytes += count as u64;
    }
    (bytes == mark.bytes && hasher.clone().finalize() == mark.crc32).then_some(hasher)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::OutputDir;

    fn table(file: PendingFile) -> csv::Writer<PendingFile> {
        csv::Writer::from_writer(file)
    }

    #[test]
    fn a_marked_file_goes_on_from_its_mark_however_it_was_left() {
        let folder = tempfile::tempdir().unwrap();
        let out = OutputDir::create(folder.path()).unwrap();
        let path = out.join("a.csv");
        let mut first = table(out.begin("a.csv").unwrap());
        first.write_record(["1"]).unwrap();
        let one = mark(&mut first).unwrap();
        first.write_record(["lost"]).unwrap();
        drop(first);
        assert!(partial(&path).exists() && !path.exists());
        let mut second = table(PendingFile::reopen(&path, &one).unwrap());
        second.write_record(["2"]).unwrap();
        let two = mark(&mut second).unwrap();
        second.into_inner().unwrap().finish().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"1\n2\n");
        assert!(!partial(&path).exists());
        let mut third = table(PendingFile::reopen(&path, &two).unwrap());
        third.write_record(["3"]).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"1\n2\n");
        third.into_inner().unwrap().finish().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"1\n2\n3\n");
        fs::write(&path, b"1\n4\n").unwrap();
        assert!(PendingFile::reopen(&path, &two).unwrap_err().to_string().contains("has changed"));
    }

    #[test]
    fn an_unmarked_file_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let out = OutputDir::create(folder.path()).unwrap();
        let mut writer = table(out.begin("a.csv").unwrap());
        writer.write_record(["1"]).unwrap();
        drop(writer);
        assert_eq!(fs::read_dir(out.path()).unwrap().count(), 0);
    }
}
