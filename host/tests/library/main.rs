//! The library as a caller uses it.

mod cyclic_space;
mod loading;
mod record;
mod same_bits;
mod walking_model;
