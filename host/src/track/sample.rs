//! What a run keeps of each arm in each frame.

use sinew_core::camera::Pixel;
use sinew_core::math::Vec3;
use sinew_core::skeleton::Side;
use sinew_core::tracker::arm::Status;

/// One row of a tracker's table: one arm in one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HandSample {
    /// Time of the frame, seconds.
    pub time_s: f32,
    /// The person's own side.
    pub side: Side,
    /// How the estimate came about; nothing but shading is drawn where lost.
    pub status: Status,
    /// Image of the hand.
    pub hand_px: Option<Pixel>,
    /// The hand, metres in camera axes.
    pub hand_m: Option<Vec3>,
    /// Likelihood of the blob that carries the estimate, 0..=1.
    pub likelihood: f32,
    /// Standard deviation of the hand, metres.
    pub hand_std_m: f32,
    /// Effective sample size.
    pub effective_sample_size: f32,
}
