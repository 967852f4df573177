//! How a run over frames ended, and what is said of it.

use super::Interrupted;
use crate::error::{Error, Result};

/// How the frames of a run ended.
#[derive(Debug)]
pub enum Ended {
    /// At the last one.
    Complete,
    /// By a signal.
    Stopped,
    /// At one that cannot be worked on.
    Failed(Error),
    /// Because results cannot be written; this says so, and what is kept.
    Unwritable(Error),
}

impl Ended {
    /// How it ended; where results cannot be written, `save` tries to keep the state and says
    /// whether it did.
    pub fn of(tracked: Result<bool>, save: &mut dyn FnMut() -> bool) -> Self {
        match tracked {
            Ok(true) => Self::Complete,
            Ok(false) => Self::Stopped,
            Err(error) if error.is_output() => Self::Unwritable(unwritable(error, save())),
            Err(error) => Self::Failed(error),
        }
    }

    /// What the run returns after its results were written, or not.
    ///
    /// # Errors
    /// Whatever ended the run before its last frame; results that cannot be written.
    pub fn conclude<T>(self, written: Result<T>, interrupted: Interrupted) -> Result<T> {
        match (self, written) {
            (Self::Complete, Ok(results)) => Ok(results),
            (Self::Stopped, Ok(_)) => Err(interrupted.into()),
            (Self::Failed(error), Ok(_)) => {
                let Interrupted { finished, unit, out, .. } = interrupted;
                let kept = format!(
                    "the results of the {finished} finished {unit} are in `{}`, and the same command with --resume goes on from there",
                    out.display()
                );
                Err(Error::Unfinished { error: Box::new(error), kept })
            }
            (Self::Failed(error), Err(other)) => {
                Err(Error::Unfinished { error: Box::new(error), kept: format!("and then {}", other.chain()) })
            }
            (Self::Unwritable(error), _) => Err(error),
            (_, Err(error)) => Err(unwritable(error, false)),
        }
    }
}

fn unwritable(error: Error, is_saved: bool) -> Error {
    let since = if is_saved { "what is finished" } else { "what was finished at the last checkpoint" };
    let kept = format!("{since} is kept: free some space or mend the folder, and give the same command with --resume");
    Error::Unfinished { error: Box::new(error), kept }
}
