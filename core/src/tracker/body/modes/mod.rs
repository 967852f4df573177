//! A body by a few modes in place of many particles: each is the top of one explanation, a normal
//! distribution with the Hessian PIK (21) as precision.
//!
//! Most particles of a set repeat one explanation. What loses a body is another one that fits:
//! exchanged legs or arms, a pelvis that is turned. So rivals of the leading mode begin in every
//! frame. They are climbed beside it, and their evidence is summed over frames before one of them
//! leads. docs/body_modes.md has the algorithm and its numbers.

mod jumps;
mod options;
mod saved;
mod select;
mod single;
mod state;
mod step;
#[cfg(test)]
mod tests;

pub use options::{DEFAULT_MODE_OPTIONS, MAX_MODES, ModeOptions};
pub(super) use select::is_alike;
pub use single::SingleModeTracker;
pub use state::{BodyMode, ModeTracker};
pub use step::ModeAdvance;
