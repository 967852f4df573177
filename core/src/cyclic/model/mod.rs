//! Motion models: the learned moments of a cyclic motion, as numbers in flash.

pub mod bytes;
pub mod coupled_model;
pub mod coupled_table;
pub mod deviation;
pub mod interpolation;
pub mod motion_model;
pub mod table;
#[cfg(feature = "walking-model")]
pub mod walking;

pub use coupled_model::{CoupledModel, CoupledParts, ModelError};
pub use coupled_table::{CoupledTable, HumanCoupledTable};
pub use deviation::Deviation;
pub use interpolation::CyclePoint;
pub use motion_model::{ModelParts, MotionModel};
pub use table::{HumanModelTable, ModelTable};
