//! A folder of results.

use super::file::{temporary_in, write_atomically, write_unsynced};
use super::pending::PendingFile;
use super::{LOCK_PREFIX, TEMPORARY_PREFIX};
use crate::error::{Result, WriteContext, bail_output};
use image::{ImageFormat, RgbImage};
use std::fs;
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Age from which a temporary file of one write is litter of a program that was killed.
const LITTER_AGE: Duration = Duration::from_secs(600);

/// A folder that was checked to be writable before the run starts.
#[derive(Debug, Clone)]
pub struct OutputDir {
    path: PathBuf,
}

impl OutputDir {
    /// Creates `path` with its parents if needed, and checks that files can be made in it. Also
    /// removes what a killed program left of its temporary files.
    ///
    /// # Errors
    /// Names the folder if it cannot be created, is a file, or refuses a file.
    pub fn create(path: &Path) -> Result<Self> {
        if path.exists() && !path.is_dir() {
            bail_output!("output `{}` is a file; give a folder, or remove the file", path.display());
        }
        fs::create_dir_all(path).writing(|| {
            format!("output folder `{}` cannot be created; choose one that can be written", path.display())
        })?;
        temporary_in(path, TEMPORARY_PREFIX)
            .writing(|| format!("output folder `{}` cannot be written; choose another", path.display()))?;
        sweep(path, TEMPORARY_PREFIX, LITTER_AGE);
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
        let bytes = png(image)?;
        write_atomically(&self.join(name), |writer| Ok(writer.write_all(&bytes)?))
    }

    /// As [`OutputDir::write`], for one of many files: not synced, which takes longer than making
    /// it.
    ///
    /// # Errors
    /// As [`write_atomically`].
    pub fn write_frame<F>(&self, name: impl AsRef<Path>, fill: F) -> Result<()>
    where
        F: FnOnce(&mut dyn Write) -> Result<()>,
    {
        write_unsynced(&self.join(name), fill)
    }

    /// As [`OutputDir::write_png`], for the picture of one frame of many.
    ///
    /// # Errors
    /// As [`write_atomically`].
    pub fn write_frame_png(&self, name: impl AsRef<Path>, image: &RgbImage) -> Result<()> {
        let bytes = png(image)?;
        self.write_frame(name, |writer| Ok(writer.write_all(&bytes)?))
    }

    /// A folder inside this one for the files of a series: it has its name once all are written.
    ///
    /// # Errors
    /// As [`OutputDir::create`].
    pub fn begin_series(&self, name: &str) -> Result<Series> {
        let growing = self.join(format!("{name}.partial"));
        if growing.exists() {
            fs::remove_dir_all(&growing).writing(|| format!("`{}` cannot be removed", growing.display()))?;
        }
        Ok(Series { folder: Self::create(&growing)?, named: self.join(name) })
    }

    /// The file `name` of this folder, all written but without its name yet.
    ///
    /// # Errors
    /// Names the file with what `fill` or the operating system refused.
    pub fn pending(
        &self,
        name: impl AsRef<Path>,
        fill: impl FnOnce(&mut dyn Write) -> Result<()>,
    ) -> Result<PendingFile> {
        let mut file = self.begin(name.as_ref())?;
        fill(&mut file).writing(|| format!("`{}` cannot be written", self.join(name).display()))?;
        Ok(file)
    }

    /// As [`OutputDir::pending`], with `image` as a PNG file.
    ///
    /// # Errors
    /// As [`OutputDir::pending`].
    pub fn pending_png(&self, name: impl AsRef<Path>, image: &RgbImage) -> Result<PendingFile> {
        let bytes = png(image)?;
        self.pending(name, |writer| Ok(writer.write_all(&bytes)?))
    }

    /// Begins the table `name` of this folder with its header.
    ///
    /// # Errors
    /// As [`OutputDir::begin`]; a header that cannot be written.
    pub fn begin_table<H: AsRef<[u8]>>(
        &self,
        name: &str,
        header: impl IntoIterator<Item = H>,
    ) -> Result<csv::Writer<PendingFile>> {
        let mut table = csv::Writer::from_writer(self.begin(name)?);
        table.write_record(header)?;
        Ok(table)
    }

    /// Begins the file `name` of this folder, which grows until [`PendingFile::finish`].
    ///
    /// # Errors
    /// Names the file if the folder refuses it.
    pub fn begin(&self, name: impl AsRef<Path>) -> Result<PendingFile> {
        PendingFile::begin(&self.join(name))
    }
}

fn png(image: &RgbImage) -> Result<Vec<u8>> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, ImageFormat::Png).writing(|| "a picture cannot be encoded")?;
    Ok(bytes.into_inner())
}

/// Files that are made one after the other and appear together.
#[derive(Debug)]
pub struct Series {
    folder: OutputDir,
    named: PathBuf,
}

impl Series {
    /// Where the files are written.
    #[must_use]
    pub fn folder(&self) -> &OutputDir {
        &self.folder
    }

    /// Gives the folder its name. Files of others that a folder of this name holds stay.
    ///
    /// # Errors
    /// The folder cannot be renamed.
    pub fn finish(self) -> Result<()> {
        let Self { folder, named } = self;
        let inner = || -> std::io::Result<()> {
            let is_free = fs::read_dir(&named).map_or(true, |mut entries| entries.next().is_none());
            if is_free {
                // What Windows refuses to replace.
                let _ = fs::remove_dir(&named);
                return fs::rename(folder.path(), &named);
            }
            for entry in fs::read_dir(folder.path())? {
                let entry = entry?;
                fs::rename(entry.path(), named.join(entry.file_name()))?;
            }
            fs::remove_dir(folder.path())
        };
        inner().writing(|| format!("`{}` cannot be written", named.display()))
    }
}

/// Removes temporary files of single writes that have this age, and names that begin with `prefix`.
/// Those that cannot be looked at or removed stay.
pub(super) fn sweep(folder: &Path, prefix: &str, min_age: Duration) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.filter_map(Result::ok) {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let is_temporary = name.starts_with(prefix) && !name.starts_with(LOCK_PREFIX);
        let age = || entry.metadata().ok()?.modified().ok()?.elapsed().ok();
        if is_temporary && age().is_some_and(|age| age >= min_age) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::bail;
    use crate::output::check_writable_file;
    use std::fs::FileTimes;
    use std::time::SystemTime;

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

    #[test]
    fn a_series_appears_at_once_and_leaves_files_of_others() {
        let folder = tempfile::tempdir().unwrap();
        let out = OutputDir::create(folder.path()).unwrap();
        let make = |text: &[u8]| {
            let series = out.begin_series("frames").unwrap();
            series.folder().write_frame("0.txt", |writer| Ok(writer.write_all(text)?)).unwrap();
            series
        };
        drop(make(b"killed"));
        assert!(!out.join("frames").exists());
        make(b"one").finish().unwrap();
        fs::write(out.join("frames/mine.txt"), "").unwrap();
        make(b"two").finish().unwrap();
        assert_eq!(fs::read(out.join("frames/0.txt")).unwrap(), b"two");
        assert!(out.join("frames/mine.txt").exists() && !out.join("frames.partial").exists());
    }

    #[test]
    fn old_temporary_files_are_swept_and_young_ones_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str, age_s: u64| {
            let file = fs::File::create(folder.path().join(name)).unwrap();
            file.set_times(FileTimes::new().set_modified(SystemTime::now() - Duration::from_secs(age_s))).unwrap();
        };
        file(".sinew-old", 3600);
        file(".sinew-new", 0);
        file("mine", 3600);
        OutputDir::create(folder.path()).unwrap();
        let is_there = |name: &str| folder.path().join(name).exists();
        assert!(!is_there(".sinew-old") && is_there(".sinew-new") && is_there("mine"));
    }
}
