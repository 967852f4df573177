//! Where the estimates go, and what is kept beside them for `--resume`.

use super::args::{COMMAND, TrackCyclicArgs};
use crate::output::{OutputLock, PendingFile, Target};
use crate::resume::{Left, ResumeFile};
use anyhow::{Result, bail};

/// Where the estimates go.
#[derive(Debug)]
pub(super) struct Place {
    target: Target,
    /// For what can be resumed.
    kept: Option<(ResumeFile, OutputLock)>,
}

impl Place {
    /// The place of `--out`, which is locked if it is a file.
    pub(super) fn of(args: &TrackCyclicArgs) -> Result<Self> {
        let target = Target::of(&args.out)?;
        let kept = match &target {
            // What came on standard input does not come again.
            Target::File(path) if !args.is_read_once() => {
                let (file, lock) = (ResumeFile::beside(path, COMMAND), OutputLock::of_table(path, COMMAND)?);
                // What a killed run left of its temporary files.
                [path, file.path()].into_iter().for_each(|file| lock.sweep_of(file));
                Some((file, lock))
            }
            Target::File(_) | Target::Fifo(_) | Target::Standard => None,
        };
        Ok(Self { target, kept })
    }

    /// What stands behind `--out`.
    pub(super) const fn target(&self) -> &Target {
        &self.target
    }

    /// Where the state is kept.
    pub(super) fn resume_file(&self) -> Option<&ResumeFile> {
        self.kept.as_ref().map(|(file, _)| file)
    }

    /// What the run left that `--resume` goes on with.
    pub(super) fn left(&self, args: &TrackCyclicArgs) -> Result<Option<Left<Option<String>>>> {
        match (args.resume, self.resume_file()) {
            (false, _) => Ok(None),
            (true, Some(file)) => Ok(Some(file.read(&args.out)?)),
            (true, None) => bail!("--resume goes on with files; give a table and --out as files"),
        }
    }

    /// Removes what is of no use after a run that reached its end.
    pub(super) fn clear(&self) -> crate::Result<()> {
        if let Target::File(path) = &self.target {
            PendingFile::remove_left(path)?;
        }
        self.resume_file().map_or(Ok(()), ResumeFile::remove)
    }
}
