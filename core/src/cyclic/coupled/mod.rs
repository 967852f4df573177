//! The phase-coupled filter: measurements move the cycle position, and a person's own cycle is
//! learned.

#[cfg(feature = "ablation")]
pub mod ablation;
#[cfg(not(feature = "ablation"))]
mod ablation;
mod all_places;
pub mod block;
mod constants;
mod correct;
mod cycle_pair;
mod evidence;
mod hypothesis;
mod initial_measurement;
mod measured_path;
mod measurement_noise;
pub mod moments;
pub mod phase_grid;
pub mod predict;
mod rival;
mod saved;
mod spread_scale;
mod start;
pub mod state;
pub mod step;
mod stored_grid;
#[cfg(test)]
mod tests;
mod watch;
mod winding;

pub use moments::{BlockTransition, CoupledTransition};
pub use state::CoupledFilter;
