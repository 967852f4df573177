//! An output that is written row by row, whatever it is.

use super::file::parent_of;
use super::folder::OutputDir;
use super::pending::{Mark, PendingFile};
use super::target::Target;
use crate::error::{Result, WriteContext};
use std::fs::File;
use std::io::{BufWriter, Write, stdout};

/// A file that appears whole, or a FIFO or standard output, which get what is flushed at once.
pub enum GrowingOutput {
    /// A file.
    File(PendingFile),
    /// What is written through.
    Through(Box<dyn Write>),
}

impl GrowingOutput {
    /// Begins it.
    ///
    /// # Errors
    /// Names what cannot be written.
    pub fn begin(target: &Target) -> Result<Self> {
        Ok(match target {
            Target::File(path) => {
                OutputDir::create(parent_of(path))?;
                Self::File(PendingFile::begin(path)?)
            }
            Target::Fifo(path) => {
                let fifo = File::options().write(true).open(path);
                let fifo = fifo.writing(|| format!("`{}` cannot be written", path.display()))?;
                Self::Through(Box::new(BufWriter::new(fifo)))
            }
            Target::Standard => Self::Through(Box::new(stdout())),
        })
    }

    /// How far a file has grown; `None` for what is written through.
    ///
    /// # Errors
    /// The file cannot be synced.
    pub fn mark(&self) -> Result<Option<Mark>> {
        match self {
            Self::File(file) => file.mark().map(Some),
            Self::Through(_) => Ok(None),
        }
    }

    /// Gives a file its name.
    ///
    /// # Errors
    /// What is left cannot be written.
    pub fn finish(self) -> Result<()> {
        match self {
            Self::File(file) => file.finish(),
            Self::Through(mut writer) => writer.flush().writing(|| "the end of the output cannot be written"),
        }
    }
}

impl Write for GrowingOutput {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        match self {
            Self::File(file) => file.write(bytes),
            Self::Through(writer) => writer.write(bytes),
        }
    }

    fn flush(&mut self) -> std::io::Result<()> {
        match self {
            Self::File(file) => file.flush(),
            Self::Through(writer) => writer.flush(),
        }
    }
}

impl std::fmt::Debug for GrowingOutput {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::File(file) => file.fmt(formatter),
            Self::Through(_) => formatter.write_str("Through"),
        }
    }
}
