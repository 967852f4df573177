//! What is learned of the measurements: their noise, their turns, and angles that wind.

pub(crate) mod measured_path;
pub(crate) mod measurement_noise;
pub(crate) mod winding;
