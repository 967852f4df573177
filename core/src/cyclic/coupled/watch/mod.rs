//! Where the filter's linearisation does not hold: a grid of phases runs beside it, and the filter
//! relocks to it.

pub(super) mod agreement;
mod all_places;
mod jump;
mod relock;
