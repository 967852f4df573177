//! Motion models: the learned moments of a cyclic motion, as numbers in flash.

pub mod bytes;
pub mod deviation;
pub mod interpolation;
pub mod motion_model;
pub mod table;
#[cfg(feature = "walking-model")]
pub mod walking;

pub use deviation::Deviation;
pub use interpolation::CyclePoint;
pub use motion_model::{ModelError, ModelParts, MotionModel};
pub use table::{HumanModelTable, ModelTable};
