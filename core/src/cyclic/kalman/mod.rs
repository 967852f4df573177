//! The paper's Kalman filter (cyclic (2) to cyclic (12)).

pub mod covariance;
pub mod filter;
mod joint_update;
#[cfg(test)]
mod joint_update_tests;
pub mod options;
mod saved;
#[cfg(test)]
mod tests;

pub use filter::KalmanFilter;
pub(crate) use options::ANGLE_VARIANCE_RAD2;
pub use options::{CovarianceScaling, GainReach, KalmanOptions};
