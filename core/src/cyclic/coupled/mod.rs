//! The phase-coupled filter: measurements move the cycle position, and a person's own cycle is learned.

pub mod block;
mod cycle_pair;
pub mod filter;
mod first_row;
mod measured_path;
pub mod moments;
mod noise_share;
mod phase_evidence;
pub mod phase_grid;
mod prediction_fit;
mod saved;
mod stored_grid;
#[cfg(test)]
mod tests;
mod watch;
mod winding;

pub use filter::CoupledFilter;
pub use moments::{BlockTransition, CoupledTransition};
