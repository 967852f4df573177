//! Hands over time, apart from the head and from what only has the colour of skin.

pub mod belief;
pub mod cells;
pub mod ends;
pub mod evidence;
pub mod find;
pub mod geodesic;
pub mod grid;
pub mod hands;
pub mod head;
pub mod labels;
pub mod person_colour;
pub mod place;
