//! Cyclic motion of a stick figure (the cyclic paper): a motion model learned from a few cycles, and what tracks with it.

pub mod deviation;
pub mod estimate;
pub mod interpolation;
pub mod measurement;
pub mod model;
pub mod model_table;
pub mod phase;
pub mod semi_definite;

pub use deviation::Deviation;
pub use estimate::CyclicEstimate;
pub use interpolation::CyclePoint;
pub use measurement::AngleMeasurement;
pub use model::{ModelError, ModelParts, MotionModel};
pub use model_table::{HumanModelTable, ModelTable};
