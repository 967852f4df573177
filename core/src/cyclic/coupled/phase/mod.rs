//! The place in the cycle: evidence for it, and the grid of all places.

pub(crate) mod cycle_pair;
pub(crate) mod evidence;
pub mod phase_grid;
pub(crate) mod stored_grid;
