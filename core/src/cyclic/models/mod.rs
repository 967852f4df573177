//! Motion models that are shipped, as constants for flash.

#[cfg(feature = "walking-model")]
pub mod walking;
