//! Both arms of a person before a camera and a blob of a hand, for examples and tests.
//!
//! ```
//! use sinew_core::tracker::arm::example::{SHOULDERS_M, hand_blob, left_arm};
//! use sinew_core::tracker::arm::{ArmFrame, ArmImage, ArmTracker, Status};
//!
//! let model = left_arm()?;
//! let mut tracker = ArmTracker::<50>::new(&model, SHOULDERS_M[0], 1)?;
//! let image = Some(ArmImage { candidates: &[hand_blob()], edges: &[] });
//! let frame = ArmFrame { timestamp_us: 0, image, shoulder_m: SHOULDERS_M[0] };
//! assert_eq!(tracker.step(&model, &frame).status, Status::Tracking);
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

use super::{ArmModel, ArmOptions};
use crate::camera::{Camera, Pixel};
use crate::error::ParameterError;
use crate::math::Vec3;
use crate::skeleton::{ArmGeometry, Side};
use crate::vision::candidate::HandCandidate;

/// Left and right shoulder, metres in camera axes.
pub const SHOULDERS_M: [Vec3; 2] = [Vec3::new(0.2, -0.1, 1.2), Vec3::new(-0.2, -0.1, 1.2)];

/// A camera of 640 x 480 pixels that sees an arm of `side`.
fn arm(side: Side) -> Result<ArmModel, ParameterError> {
    let camera = Camera::from_field_of_view(640, 480, 1.05)?;
    ArmModel::new(camera, (640, 480), ArmGeometry::new(side, 0.30, 0.35)?, ArmOptions::default())
}

/// The left arm before its camera.
///
/// # Errors
/// None.
pub fn left_arm() -> Result<ArmModel, ParameterError> {
    arm(Side::Left)
}

/// The right arm before the same camera.
///
/// # Errors
/// None.
pub fn right_arm() -> Result<ArmModel, ParameterError> {
    arm(Side::Right)
}

/// A blob of the left hand.
#[must_use]
pub fn hand_blob() -> HandCandidate {
    let centre = Pixel::new(400.0, 250.0);
    HandCandidate { centre, moments_px2: [400.0, 0.0, 400.0], area_px: 4700.0, likelihood: 0.8 }
}
