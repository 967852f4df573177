//! Anatomical angles in degrees, and what is read off them: range of motion, tempo, curves over the
//! cycle, symmetry.
//!
//! All angles are those of the side view of a person who faces right (x forward, y down). Zero is
//! standing upright with hanging arms; the signs are in [`ANATOMICAL_ANGLES`].

pub mod angles;
pub mod curves;
pub mod measured;
pub mod repetition;
pub mod symmetry;

pub use angles::{ANATOMICAL_ANGLES, AnatomicalSeries, COUNT, PAIRS, of_pose};
pub use curves::{CycleCurves, CyclePointStatistics};
pub use measured::{FOOT_ANGLES, MeasuredAngles};
pub use repetition::{Range, Repetition};
pub use symmetry::Symmetry;
