//! Cyclic motion of a stick figure (the cyclic paper): a motion model learned from a few cycles,
//! and the filters that track with it.
//!
//! ```
//! use sinew_core::cyclic::{AngleMeasurement, CoupledFilter, ModelTable};
//! use std::f32::consts::TAU;
//!
//! // Two angles that swing against each other, sixty frames a cycle; a model has its numbers at 100 positions.
//! const POSITIONS: usize = 100;
//! let pose = |position: f32| [0.5 * (TAU * position).sin(), -0.3 * (TAU * position).sin()];
//! let place = |i: f32| pose(i / POSITIONS as f32);
//! let mut table = ModelTable::<POSITIONS, 2, 3> {
//!     mean_acceleration: [[0.0; 2]; POSITIONS],
//!     acceleration_covariance: [[1e-8, 0.0, 1e-8]; POSITIONS], // a lower triangle
//!     mean_pose_rad: [[0.0; 2]; POSITIONS],
//!     mean_velocity: [[0.0; 2]; POSITIONS],
//!     offset_std_rad: [0.08; 2],
//!     cosine_std_rad: [0.05; 2],
//!     sine_std_rad: [0.05; 2],
//!     rest_std_rad: [0.03; 2],
//!     rest_rate_per_cycle: [6.0; 2],
//!     turns_per_cycle: [0; 2],
//!     mean_duration_frames: 60.0,
//!     rate_hz: 60.0,
//! };
//! for i in 0..POSITIONS {
//!     let [before, here, after] = [-1.0, 0.0, 1.0].map(|step| place(i as f32 + step));
//!     for j in 0..2 {
//!         table.mean_pose_rad[i][j] = here[j];
//!         table.mean_velocity[i][j] = 0.5 * (after[j] - before[j]);
//!         table.mean_acceleration[i][j] = after[j] - 2.0 * here[j] + before[j];
//!     }
//! }
//! let model = table.model().expect("the numbers agree");
//!
//! // A person who moves a tenth faster than the mean. Some measurements miss an angle, some all.
//! let seen = |frame: usize| {
//!     let angles = pose(frame as f32 / 54.0).map(Some);
//!     match frame % 7 {
//!         3 => AngleMeasurement::new(&[angles[0], None], 0.05),
//!         5 => Ok(AngleMeasurement::nothing()),
//!         _ => AngleMeasurement::new(&angles, 0.05),
//!     }
//! };
//! let mut filter = CoupledFilter::<2>::new(&model, &seen(0)?, None, None)?;
//! let mut last = filter.step(&model, &seen(1)?);
//! for frame in 2..300 {
//!     last = filter.step(&model, &seen(frame)?);
//! }
//! let truth = pose(299.0 / 54.0);
//! assert!((last.angles_rad[0] - truth[0]).abs() < 0.05, "{last:?}");
//! let (cadence, std) = last.cadence_per_min(model.rate_hz());
//! assert!((cadence - 60.0 * 60.0 / 54.0).abs() < 3.0 && std < 5.0, "{cadence} +- {std} cycles a minute");
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

pub mod coupled;
pub mod cycle_state;
pub mod estimate;
pub mod events;
pub mod example;
pub mod figure;
pub mod filter;
pub mod kalman;
pub mod measurement;
pub mod model;
pub mod particle;
pub mod phase;
pub mod recognition;
mod saved_ranges;
pub mod start;
pub mod substeps;
#[cfg(test)]
pub mod synthetic;

pub use coupled::{BlockTransition, CoupledFilter, CoupledTransition};
pub use estimate::CyclicEstimate;
pub use figure::{FigurePlace, PlaceOptions};
pub use filter::{CyclicFilter, FilterChoice};
pub use kalman::{CovarianceScaling, GainReach, KalmanFilter, KalmanOptions};
pub use measurement::AngleMeasurement;
pub use model::{CoupledModel, CoupledParts, CoupledTable, HumanCoupledTable};
pub use model::{CyclePoint, Deviation, HumanModelTable, ModelError, ModelParts, ModelTable, MotionModel};
pub use particle::ParticleTracker;
pub use start::CycleStart;
