//! A noisy walk that the shipped model describes: its mean poses with measurement noise.

use sinew_core::cyclic::{AngleMeasurement, MotionModel};
use sinew_core::random::Stream;

/// Angles of the stick figure.
pub const ANGLES: usize = 13;
/// Standard deviation of the measured angles: 29 degrees.
pub const STD_RAD: f32 = 0.506;

/// Measured angles, frame by frame; begins again after the last.
pub struct Walk(Vec<[Option<f32>; ANGLES]>);

impl Walk {
    pub fn new(model: &MotionModel<'_>, frames: u16) -> Self {
        let frame = |index: u16| {
            let mut stream = Stream::new(9, u64::from(index), 0);
            let pose = model.mean_pose_rad::<ANGLES>(model.point(f32::from(index) * model.mean_cycle_velocity()));
            let std_rad = if index == 0 { 0.0 } else { STD_RAD };
            pose.map(|angle| Some(angle + std_rad * stream.normal()))
        };
        Self((0..frames).map(frame).collect())
    }

    pub fn angles(&self, frame: usize) -> &[Option<f32>; ANGLES] {
        &self.0[frame % self.0.len()]
    }

    pub fn measurement(&self, frame: usize) -> AngleMeasurement<ANGLES> {
        AngleMeasurement::new(self.angles(frame), STD_RAD).expect("a positive deviation")
    }
}
