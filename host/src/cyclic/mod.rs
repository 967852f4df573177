//! Cyclic motion on the host: angle tables, training, cutting of cycles, and what people read off them.

pub mod angle_table;
pub mod error;

pub use angle_table::{AngleRow, AngleTable};
pub use error::CyclicError;
