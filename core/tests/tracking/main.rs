//! The core as a caller uses it.

mod arm_tracking;
mod particle_linear;
mod solver_brute_force;
mod unbiased_weights;
