//! Weighted particles: log-weights, effective sample size, resampling.
//!
//! ```
//! use sinew_core::particle::Weights;
//! use sinew_core::particle::resampling::systematic;
//!
//! // Four particles, the third of which fits best.
//! let mut weights = Weights::<4>::uniform(4)?;
//! for (index, log_weight) in [-2.0, -2.0, -0.1, f32::NEG_INFINITY].into_iter().enumerate() {
//!     weights.set_log(index, log_weight);
//! }
//! weights.normalise().expect("one of them is above zero");
//! assert!(weights.effective_sample_size() < 2.5);
//!
//! let mut ancestors = [0; 4];
//! systematic(weights.normalised(), 0.5, &mut ancestors);
//! assert!(ancestors.iter().filter(|&&ancestor| ancestor == 2).count() >= 2);
//! assert!(!ancestors.contains(&3));
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

pub mod resampling;
pub mod weights;

pub use weights::{Degenerate, Weights};
