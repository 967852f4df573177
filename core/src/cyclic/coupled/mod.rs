//! The phase-coupled filter: measurements move the cycle position, and a person's own cycle is
//! learned.

#[cfg(feature = "ablation")]
pub mod ablation;
#[cfg(not(feature = "ablation"))]
mod ablation;
mod constants;
pub mod hypothesis;
mod measurement;
pub mod moments;
pub mod person;
pub mod phase;
mod saved;
mod start;
pub mod state;
pub mod step;
#[cfg(test)]
mod tests;
mod watch;

pub use moments::{BlockTransition, CoupledTransition};
pub use state::CoupledFilter;
