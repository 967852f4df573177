//! Cyclic motion of a stick figure (the cyclic paper): a motion model learned from a few cycles, and what tracks with it.

mod angle_blocks;
pub mod angle_walk;
pub mod coupled;
pub mod coupled_block;
pub mod coupled_moments;
mod coupled_search;
mod coupled_state;
#[cfg(test)]
mod coupled_tests;
pub mod covariance;
pub mod cycle_pair;
pub mod cycle_state;
pub mod deviation;
pub mod estimate;
pub mod events;
pub mod figure_place;
pub mod filter;
pub mod gate;
pub mod image_filter;
pub mod interpolation;
pub mod joint_update;
pub mod kalman;
pub mod kalman_options;
#[cfg(test)]
mod kalman_tests;
pub mod log_product;
pub mod measurement;
pub mod model;
pub mod model_bytes;
pub mod model_table;
pub mod models;
pub mod motion_bank;
pub mod particle;
pub mod particle_moments;
pub mod particle_resampling;
pub mod particle_sweep;
pub mod particle_table;
pub mod particle_tracker;
pub mod phase;
pub mod phase_grid;
pub mod semi_definite;
pub mod start;
pub mod substeps;
#[cfg(test)]
pub mod synthetic;

pub use coupled::CoupledFilter;
pub use coupled_moments::{BlockTransition, CoupledTransition};
pub use deviation::Deviation;
pub use estimate::CyclicEstimate;
pub use figure_place::{FigurePlace, PlaceOptions};
pub use filter::{CyclicFilter, FilterChoice};
pub use interpolation::CyclePoint;
pub use kalman::KalmanFilter;
pub use kalman_options::{CovarianceScaling, GainReach, KalmanOptions};
pub use measurement::AngleMeasurement;
pub use model::{ModelError, ModelParts, MotionModel};
pub use model_table::{HumanModelTable, ModelTable};
pub use particle_tracker::ParticleTracker;
pub use start::CycleStart;
