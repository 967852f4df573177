//! Going on with a run that did not reach its end. This module holds what the run leaves
//! beside its results, and what it is compared with when it is taken up.
//!
//! [`Begun`] says how a run was begun, [`Left`] adds how far it got and in which state it was,
//! [`ResumeFile`] is where that is kept. A state is text ([`to_text`]) by way of the core's saved
//! states, so that it comes back bit for bit. Evaluations keep [`Cells`] instead.

mod begun;
mod cells;
mod checkpoint;
mod ended;
mod interrupted;
mod left;
mod state_text;

pub use crate::wording::REMEDY;
pub use begun::{Begun, absolute, file_crc32, identity};
pub use cells::{CELLS_FOLDER, Cells, Stop, crc32_of};
pub use checkpoint::{Checkpoints, DEFAULT_CHECKPOINT};
pub use ended::Ended;
pub use interrupted::Interrupted;
pub use left::{Left, PARTICLE_TABLE, RESUME_FILE, ResumeFile, TRACK_TABLE, text_crc32};
pub use state_text::{List, from_text, long_real, optional, real, reals, to_text};
