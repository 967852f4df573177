//! The cyclic tracker where the true angles are known: the paper's tables and figures on any cut
//! cycles.

pub mod after_something_else;
pub mod baselines;
pub mod experiments;
pub mod figures;
pub mod long_runs;
pub mod other_sources;
pub mod protocol;
pub mod rate;
pub mod report;
pub mod stress;
pub mod synthetic;
pub mod tempo;

pub use experiments::{Cell, Setting};
pub use long_runs::{LONG_RUN_SIGMA_DEG, LongRun, Recording, long_runs, tracked};
pub use protocol::{Errors, Protocol, TestCycle, test_cycles};
pub use rate::rate_of;
pub use report::CyclicReport;
