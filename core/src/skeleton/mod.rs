//! What a body is: rigid bones in a tree, their joints and limits. Immutable; poses are small arrays of angles.

pub mod arm;
pub mod body_measures;
pub mod full_body;
pub mod stick_figure;
pub mod tree;
pub mod upper_body;

pub use arm::{ArmGeometry, Side};
pub use body_measures::BodyMeasures;
pub use stick_figure::{StickFigure, StickJoint};
pub use tree::{Bone, Joint, Limit, Skeleton};
