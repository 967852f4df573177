//! Angle tables: one row a frame, the 13 angles of the stick figure in radians, an empty cell where
//! one is missing.

mod clock;
mod columns;
mod own_sides;
mod rows;
mod table;
#[cfg(test)]
mod tests;

pub use columns::{ANGLES, COLUMNS, MAX_FRAME, SIDE_COLUMNS, SPACE_ANGLES, TIME_COLUMN, angle_columns, time_cell};
pub use own_sides::sides_exchanged;
pub use rows::{AngleRow, AngleRows, ReadRow};
pub use table::AngleTable;
