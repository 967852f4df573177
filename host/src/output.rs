//! Outputs that appear whole or not at all: a temporary name in the same folder, then a rename.

use crate::error::{Result, WriteContext, bail};
use image::{ImageFormat, RgbImage};
use std::fs;
use std::io::{BufWriter, Cursor, Write};
use std::path::{Path, PathBuf};
use tempfile::{Builder, NamedTempFile};

/// A folder that was checked to be writable before the run starts.
#[derive(Debug, Clone)]
pub struct OutputDir {
    path: PathBuf,
}

impl OutputDir {
    /// Creates `path` with its parents if needed, and checks that files can be made in it.
    ///
    /// # Errors
    /// Names the folder if it cannot be created, is a file, or refuses a file.
    pub fn create(path: &Path) -> Result<Self> {
        if path.exists() && !path.is_dir() {
            bail!("output `{}` is a file; give a folder, or remove the file", path.display());
        }
        fs::create_dir_all(path).writing(|| {
            format!("output folder `{}` cannot be created; choose one that can be written", path.display())
        })?;
        temporary_in(path)
            .writing(|| format!("output folder `{}` cannot be written; choose another", path.display()))?;
        Ok(Self { path: path.to_path_buf() })
    }

    /// The folder.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Path of `name` in this folder.
    #[must_use]
    pub fn join(&self, name: impl AsRef<Path>) -> PathBuf {
        self.path.join(name)
    }

    /// A folder inside this one, created and checked likewise.
    ///
    /// # Errors
    /// As [`OutputDir::create`].
    pub fn subfolder(&self, name: impl AsRef<Path>) -> Result<Self> {
        Self::create(&self.path.join(name))
    }

    /// Writes the file `name` of this folder by [`write_atomically`].
    ///
    /// # Errors
    /// As [`write_atomically`].
    pub fn write<F>(&self, name: impl AsRef<Path>, fill: F) -> Result<()>
    where
        F: FnOnce(&mut dyn Write) -> Result<()>,
    {
        write_atomically(&self.join(name), fill)
    }

    /// Writes `image` as the PNG file `name` of this folder.
    ///
    /// # Errors
    /// As [`write_atomically`].
    pub fn write_png(&self, name: impl AsRef<Path>, image: &RgbImage) -> Result<()> {
        let mut bytes = Cursor::new(Vec::new());
        let path = self.join(name);
        image.write_to(&mut bytes, ImageFormat::Png).writing(|| format!("`{}` cannot be encoded", path.display()))?;
        write_atomically(&path, |writer| Ok(writer.write_all(bytes.get_ref())?))
    }

    /// Begins the file `name` of this folder.
    ///
    /// # Errors
    /// Names the file if the folder refuses it.
    pub fn begin(&self, name: impl AsRef<Path>) -> Result<PendingFile> {
        let path = self.join(name);
        let temporary = temporary_in(&self.path).writing(|| format!("`{}` cannot be written", path.display()))?;
        Ok(PendingFile { path, writer: BufWriter::new(temporary) })
    }
}

/// A file that grows under a temporary name and gets its own name at the end; dropped before, it
/// leaves nothing.
#[derive(Debug)]
pub struct PendingFile {
    path: PathBuf,
    writer: BufWriter<NamedTempFile>,
}

impl PendingFile {
    /// Gives the file its name, replacing what was there.
    ///
    /// # Errors
    /// Names the file if what is left cannot be written or the name cannot be taken.
    pub fn finish(self) -> Result<()> {
        let Self { path, writer } = self;
        let inner = || -> Result<()> {
            writer.into_inner()?.persist(&path)?;
            Ok(())
        };
        inner().writing(|| format!("`{}` cannot be written", path.display()))
    }
}

impl Write for PendingFile {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.writer.write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.writer.flush()
    }
}

/// Checks before a run that `path` can be written as a file; creates its parent folders.
///
/// # Errors
/// Names the path if it is a folder or if its folder cannot be created or written.
pub fn check_writable_file(path: &Path) -> Result<()> {
    if path.is_dir() {
        bail!("output `{}` is a folder; give the name of a file", path.display());
    }
    OutputDir::create(parent_of(path)).map(|_| ())
}

/// Lets `fill` write to a temporary file beside `path`, then renames it to `path`, replacing what
/// was there.
///
/// If `fill` fails, `path` stays as it was.
///
/// # Errors
/// Names the path with what `fill` or the operating system refused.
pub fn write_atomically<F>(path: &Path, fill: F) -> Result<()>
where
    F: FnOnce(&mut dyn Write) -> Result<()>,
{
    let inner = || -> Result<()> {
        let mut temporary = temporary_in(parent_of(path))?;
        let mut writer = BufWriter::new(temporary.as_file_mut());
        fill(&mut writer)?;
        writer.flush()?;
        drop(writer);
        temporary.persist(path)?;
        Ok(())
    };
    inner().writing(|| format!("`{}` cannot be written", path.display()))
}

fn parent_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// A new temporary file in `folder` with the permissions that an ordinary new file gets.
fn temporary_in(folder: &Path) -> std::io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(".sinew-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

/// Gives a table its name.
///
/// # Errors
/// A file that cannot be written.
pub(crate) fn finish_table(table: csv::Writer<PendingFile>) -> Result<()> {
    let file = table.into_inner().writing(|| "a table cannot be written")?;
    file.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_old_file_and_no_litter() {
        let folder = tempfile::tempdir().unwrap();
        let output = OutputDir::create(&folder.path().join("a/b")).unwrap();
        output.write("x.txt", |writer| Ok(writer.write_all(b"old")?)).unwrap();
        let failure = output.write("x.txt", |writer| {
            writer.write_all(b"half")?;
            bail!("no more")
        });
        assert!(format!("{:#}", failure.unwrap_err()).contains("x.txt"));
        assert_eq!(fs::read(output.join("x.txt")).unwrap(), b"old");
        assert_eq!(fs::read_dir(output.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_file_in_place_of_a_folder_is_refused_before_the_run() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, b"").unwrap();
        assert!(OutputDir::create(&file).unwrap_err().to_string().contains("is a file"));
        assert!(OutputDir::create(&file.join("inside")).is_err());
        assert!(check_writable_file(folder.path()).unwrap_err().to_string().contains("is a folder"));
    }
}
