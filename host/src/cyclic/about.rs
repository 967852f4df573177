//! What belongs to a recording and is no angle, in a file beside its angle table: `walk.csv` has
//! `walk.about.json`.

use super::error::{CyclicError, read_text};
use super::facing::Facing;
use crate::error::{Context, Result};
use crate::output::write_atomically;
use crate::resume::file_crc32;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Name of the format.
const FORMAT: &str = "sinew-recording";
/// Version of the format.
const VERSION: u32 = 1;

/// What is known of the recording behind an angle table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct About {
    format: String,
    version: u32,
    /// Checksum of the table that this belongs to.
    table_crc32: u32,
    /// Frames per second of the table.
    pub rate_hz: Option<f64>,
    /// Which way the person faces in the image.
    pub facing: Option<Facing>,
    /// Width and height of the picture, pixels.
    pub image_size_px: Option<[f64; 2]>,
    /// What was read, as a format of files or of keypoints.
    pub layout: Option<String>,
    /// Unit of places and lengths in the table: `px` or `m`.
    pub unit: Option<String>,
    /// The file or folder that was read, as it was given.
    pub source: String,
    /// What a user should know, one sentence each.
    pub notes: Vec<String>,
    /// What speaks against the recording, one sentence each.
    pub doubts: Vec<String>,
}

impl About {
    /// Nothing but where the recording comes from.
    #[must_use]
    pub fn of_source(source: &Path) -> Self {
        Self {
            format: FORMAT.to_owned(),
            version: VERSION,
            table_crc32: 0,
            rate_hz: None,
            facing: None,
            image_size_px: None,
            layout: None,
            unit: None,
            source: source.display().to_string(),
            notes: Vec::new(),
            doubts: Vec::new(),
        }
    }

    /// Where it lies: beside the table, if that is a file.
    #[must_use]
    pub fn path_beside(table: &Path) -> Option<PathBuf> {
        let is_file = std::fs::metadata(table).is_ok_and(|facts| facts.is_file());
        is_file.then(|| table.with_extension("about.json"))
    }

    /// Writes it beside a table that was just written; nothing where that is no file.
    ///
    /// # Errors
    /// Names the path with what the operating system refused.
    pub fn write_beside(mut self, table: &Path) -> Result<()> {
        let Some(path) = Self::path_beside(table) else { return Ok(()) };
        self.table_crc32 = file_crc32(table)?;
        write_atomically(&path, |writer| Ok(serde_json::to_writer_pretty(writer, &self)?))
    }

    /// What stands beside a table; `None` where nothing does, or the table was changed since.
    ///
    /// # Errors
    /// Names the file, which is there and cannot be read.
    pub fn read_beside(table: &Path) -> Result<Option<Self>> {
        let Some(path) = Self::path_beside(table).filter(|path| path.is_file()) else { return Ok(None) };
        let about: Self = serde_json::from_str(&read_text(&path)?).ok().with_context(|| {
            format!(
                "`{}` is not what `sinew angles` writes beside a table; remove it, or make the table anew",
                path.display()
            )
        })?;
        if about.format != FORMAT || about.version != VERSION {
            let rule = format!("is of version {}, this program reads {VERSION}; make the table anew", about.version);
            return Err(CyclicError::broken(&path, 1, rule).into());
        }
        Ok((about.table_crc32 == file_crc32(table)?).then_some(about))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn it_belongs_to_the_table_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        let table = folder.path().join("walk.csv");
        assert_eq!(About::read_beside(&table).unwrap(), None);
        fs::write(&table, "frame\n0\n").unwrap();
        let mut about = About::of_source(Path::new("k.json"));
        (about.rate_hz, about.facing) = (Some(30.0), Some(Facing::Left));
        about.write_beside(&table).unwrap();
        let read = About::read_beside(&table).unwrap().unwrap();
        assert_eq!((read.rate_hz, read.facing, read.source.as_str()), (Some(30.0), Some(Facing::Left), "k.json"));
        fs::write(&table, "frame\n1\n").unwrap();
        assert_eq!(About::read_beside(&table).unwrap(), None, "the table is another one");
        fs::write(folder.path().join("walk.about.json"), "{").unwrap();
        assert!(About::read_beside(&table).unwrap_err().to_string().contains("make the table anew"));
    }
}
