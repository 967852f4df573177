//! From angles to places and back.

pub mod body_information;
pub mod cholesky;
pub mod forward;
pub mod gradient_projection;
pub mod inverse;
pub mod jacobian;
pub mod pose_density;
