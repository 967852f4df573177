//! Cyclic motion on the host: angle tables, training, cutting of cycles, and what people read off
//! them.

pub mod about;
pub mod anatomy;
pub mod angle_table;
pub mod angle_units;
pub mod cuts;
pub mod cutting;
pub mod error;
pub mod even_rows;
pub mod export;
pub mod facing;
pub mod feet;
pub mod gait;
pub mod heading;
pub mod image_joints;
pub mod model;
pub mod model_file;
pub mod model_range;
pub mod noise;
pub mod own_cycle;
#[cfg(feature = "plots")]
pub mod pictures;
pub mod place_columns;
pub mod planar;
pub mod plausibility;
pub mod projection;
pub mod rate;
pub mod recording;
pub mod report;
pub mod resample;
pub mod smoothing;
pub mod spline;
pub mod stops;
pub mod synthetic_keypoints;
pub mod synthetic_person;
pub mod tracking;
pub mod training;
pub mod turns;

pub use angle_table::{AngleRow, AngleTable};
pub use cuts::{Cut, CutList};
pub use error::CyclicError;
pub use model::CyclicModel;
pub use synthetic_person::SyntheticPerson;
