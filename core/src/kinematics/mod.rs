//! From angles to places and back.

pub mod cholesky;
pub mod forward;
pub mod inverse;
pub mod jacobian;
