//! The start: at the first row, or anywhere in the cycle.

mod all_places;
mod begin;
mod initial_measurement;
