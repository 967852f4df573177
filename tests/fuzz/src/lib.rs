//! Arbitrary input for every reader, saved state, stream of records and tracker.
//!
//! A [`Target`] takes any bytes. It neither panics, nor takes more than [`execution::MAX_TIME`],
//! nor asks for more than [`execution::MAX_BYTES`]. [`mutation`] makes its input from small valid
//! files. [`campaign`] runs it and measures.

pub mod allocation;
pub mod campaign;
pub mod execution;
pub mod file;
pub mod keeping;
pub mod mutation;
pub mod numbers;
pub mod random;
pub mod regressions;
mod shrinking;
mod target;
pub mod targets;

pub use target::Target;
