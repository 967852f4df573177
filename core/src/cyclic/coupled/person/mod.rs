//! A person: each angle's deviation from the mean cycle, and how unlike the training it is.

pub mod block;
pub(crate) mod spread_scale;
