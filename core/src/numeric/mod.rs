//! Numerics that several topics share.

pub(crate) mod bf16;
pub mod chi_square;
pub(crate) mod log_product;
pub(crate) mod rolled;
pub mod semi_definite;
