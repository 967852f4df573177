//! The estimate given the whole recording: a Rauch-Tung-Striebel pass backwards over the states of
//! a filter. Source: Rauch, Tung and Striebel, "Maximum likelihood estimates of linear dynamic
//! systems", AIAA Journal 3, 1965.
//!
//! The states of the forward pass are kept as they were. Means, covariances and the step to the
//! next frame are taken from them in `f64`, frame by frame. The predicted covariance is that of the
//! step, F P F' + Q, not the filter's rounded or limited one.

mod coupled;
mod kalman;
mod pass;
mod recursion;
mod replace;

pub use coupled::CoupledState;
pub use kalman::KalmanState;
pub use pass::{Link, Smoothable, Smoothed, backward};
pub use recursion::{Moments, smooth_step};
pub use replace::replace_estimates;

#[cfg(test)]
mod tests;
