//! The cyclic tracker: pose and phase by a filter, the cycles counted, the cadence, root and
//! segment lengths.
//!
//! ```
//! # #[cfg(feature = "walking-model")] {
//! use sinew_core::cyclic::AngleMeasurement;
//! use sinew_core::cyclic::model::walking::WALKING;
//! use sinew_core::tracker::cyclic::{CyclicTracker, CyclicTrackerOptions, FirstPhase};
//!
//! // The walking model is in flash (feature `walking-model`); a person walks its mean cycle.
//! let model = WALKING.model().expect("the shipped model is sound");
//! let seen = |frame: usize| {
//!     let pose = model.mean_pose_rad::<13>(model.point(0.3 + frame as f32 * model.mean_cycle_velocity()));
//!     AngleMeasurement::new(&pose.map(Some), 0.1).expect("a standard deviation above zero").into()
//! };
//! let options = CyclicTrackerOptions::default();
//! let mut tracker = CyclicTracker::<13>::new(&model, options, &seen(0), FirstPhase::default()).expect("13 angles");
//! let mut answer = tracker.step(&model, &seen(1));
//! for frame in 2..300 {
//!     answer = tracker.step(&model, &seen(frame));
//! }
//! let cycles = 299.0 * model.mean_cycle_velocity();
//! assert!((answer.cycles_completed - cycles as i32).abs() <= 1);
//! let cadence = 60.0 * model.rate_hz() * model.mean_cycle_velocity();
//! assert!((answer.cadence_per_min - cadence).abs() < 2.0);
//!
//! // A frame without a measurement is an ordinary input.
//! let bridged = tracker.step(&model, &AngleMeasurement::nothing().into());
//! assert!(bridged.cadence_std_per_min >= answer.cadence_std_per_min);
//! # }
//! ```

mod coupled;
mod estimate;
mod frame;
mod options;
mod particles;
mod step;

pub use coupled::CoupledTracker;
pub use estimate::CyclicFrame;
pub use frame::CyclicFrameInput;
pub use options::{CyclicTrackerOptions, FirstPhase};
pub use particles::ParticleCycleTracker;
pub use step::CyclicTracker;
