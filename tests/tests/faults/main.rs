//! What the world does to a run: signals, full disks, folders that vanish, others in the same
//! folder.
//!
//! `SINEW_FAULTS=50 cargo test --release -p sinew-tests --test faults` kills each kind of run at 50
//! moments by each signal; without the variable it is a few.

#![cfg(unix)]

mod disk;
mod kinds;
mod signals;
mod targets;
mod together;
