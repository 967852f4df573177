//! One file, written at once.

use super::TEMPORARY_PREFIX;
use super::folder::OutputDir;
use super::target::Target;
use crate::error::{Result, WriteContext};
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::Path;
use tempfile::{Builder, NamedTempFile};

/// Checks before a run that `path` can be written as a file; creates its parent folders.
///
/// # Errors
/// Names the path if it is a folder, a device or a socket, or if its folder cannot be created or
/// written.
pub fn check_writable_file(path: &Path) -> Result<()> {
    match Target::of(path)? {
        Target::File(file) => OutputDir::create(parent_of(&file)).map(|_| ()),
        Target::Fifo(_) | Target::Standard => Ok(()),
    }
}

/// Lets `fill` write the file `path`, which is replaced when all is written and synced; a FIFO and
/// `-` are written through.
///
/// If `fill` fails, a regular file stays as it was.
///
/// # Errors
/// Names the path with what `fill` or the operating system refused.
pub fn write_atomically<F>(path: &Path, fill: F) -> Result<()>
where
    F: FnOnce(&mut dyn Write) -> Result<()>,
{
    write(path, true, fill)
}

/// As [`write_atomically`], without waiting for the disk.
pub(super) fn write_unsynced<F>(path: &Path, fill: F) -> Result<()>
where
    F: FnOnce(&mut dyn Write) -> Result<()>,
{
    write(path, false, fill)
}

fn write<F>(path: &Path, is_synced: bool, fill: F) -> Result<()>
where
    F: FnOnce(&mut dyn Write) -> Result<()>,
{
    // Once for all callers: `fill` is the only part that differs.
    let mut fill = Some(fill);
    write_with(path, is_synced, &mut |writer| fill.take().map_or(Ok(()), |fill| fill(writer)))
}

fn write_with(path: &Path, is_synced: bool, fill: &mut dyn FnMut(&mut dyn Write) -> Result<()>) -> Result<()> {
    let mut inner = || -> Result<()> {
        match Target::of(path)? {
            Target::File(file) => replace(&file, is_synced, fill),
            Target::Fifo(fifo) => through(File::options().write(true).open(fifo)?, fill),
            // A reader that has gone away wants no more.
            Target::Standard => match through(std::io::stdout().lock(), fill) {
                Err(error) if error.is_closed_pipe() => Ok(()),
                other => other,
            },
        }
    };
    inner().writing(|| format!("`{}` cannot be written", path.display()))
}

fn replace(path: &Path, is_synced: bool, fill: &mut dyn FnMut(&mut dyn Write) -> Result<()>) -> Result<()> {
    let folder = parent_of(path);
    let mut temporary = temporary_in(folder, &temporary_prefix(path))?;
    let mut writer = BufWriter::new(temporary.as_file_mut());
    fill(&mut writer)?;
    writer.flush()?;
    drop(writer);
    if !is_synced {
        temporary.persist(path)?;
        return Ok(());
    }
    temporary.as_file().sync_all()?;
    temporary.persist(path)?;
    sync_folder(folder)
}

fn through(writer: impl Write, fill: &mut dyn FnMut(&mut dyn Write) -> Result<()>) -> Result<()> {
    let mut writer = BufWriter::new(writer);
    fill(&mut writer)?;
    Ok(writer.flush()?)
}

/// Makes a rename in `folder` last. What is no folder to the file system, as on Windows, is left.
pub(super) fn sync_folder(folder: &Path) -> Result<()> {
    if cfg!(unix) {
        File::open(folder)?.sync_all()?;
    }
    Ok(())
}

pub(super) fn parent_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// How the names of the temporary files of `path` begin.
pub(super) fn temporary_prefix(path: &Path) -> String {
    format!("{TEMPORARY_PREFIX}{}-", path.file_name().unwrap_or_default().to_string_lossy())
}

/// A new temporary file in `folder` with the permissions that an ordinary new file gets.
pub(super) fn temporary_in(folder: &Path, prefix: &str) -> std::io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(prefix);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::io::Read;

    #[test]
    fn a_link_stays_and_its_target_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        std::os::unix::fs::symlink("file", &link).unwrap();
        write_atomically(&link, |writer| Ok(writer.write_all(b"new")?)).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(file).unwrap(), b"new");
    }

    #[test]
    fn a_fifo_is_written_through() {
        let folder = tempfile::tempdir().unwrap();
        let fifo = folder.path().join("fifo");
        assert!(std::process::Command::new("mkfifo").arg(&fifo).status().unwrap().success());
        let reader = std::thread::spawn({
            let fifo = fifo.clone();
            move || {
                let mut text = String::new();
                File::open(fifo).unwrap().read_to_string(&mut text).unwrap();
                text
            }
        });
        write_atomically(&fifo, |writer| Ok(writer.write_all(b"rows")?)).unwrap();
        assert_eq!(reader.join().unwrap(), "rows");
        assert_eq!(Target::of(&fifo).unwrap(), Target::Fifo(fifo));
    }
}
