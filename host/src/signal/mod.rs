//! Filters of evenly sampled series with gaps: outlier rejection, a gap limit, and smoothing
//! without lag.
//!
//! Own code, because of the published crates for Butterworth filters and smoothing splines. They
//! are parts of large numerical suites, bring a second version of nalgebra, or are in their first
//! release.

pub mod butterworth;
pub mod gaps;
pub mod gaussian;
pub mod gcv_spline;
pub mod hampel;
pub mod loess;
pub mod median;
mod odd_extension;
mod options;
mod series;

pub use options::{DEFAULT_CUTOFF_HZ, FilterKind, FilterOptions, MAX_CUTOFF_SHARE};
pub use series::{filtered, filtered_angles};
