//! One line a frame, in whole numbers, so that outputs of any two devices can be compared byte by byte.

use core::fmt;
use sinew_core::camera::Camera;
use sinew_core::math::round;
use sinew_core::tracker::arm::{ArmEstimate, Status};

/// Names of the columns.
pub const HEADER: &str = "frame status u_px v_px x_mm y_mm z_mm";

/// A frame's line: status 2 is tracking, 1 predicted, 0 lost; the hand's image is -1 -1 where it has none.
#[derive(Debug, Clone, Copy)]
pub struct Line {
    numbers: [i32; 7],
}

impl Line {
    /// The line of `frame`.
    #[must_use]
    pub fn new(frame: u64, estimate: &ArmEstimate, camera: &Camera) -> Self {
        let status = match estimate.status {
            Status::Tracking => 2,
            Status::Predicted => 1,
            Status::Lost => 0,
        };
        let hand_m = estimate.joints.hand_m;
        let (u, v) = camera.project(&hand_m).map_or((-1.0, -1.0), |pixel| (pixel.u_px, pixel.v_px));
        let millimetres = (hand_m * 1000.0).map(|value| round(value) as i32);
        let [x, y, z] = [millimetres.x, millimetres.y, millimetres.z];
        Self { numbers: [frame as i32, status, round(u) as i32, round(v) as i32, x, y, z] }
    }
}

impl fmt::Display for Line {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, number) in self.numbers.iter().enumerate() {
            if index > 0 {
                formatter.write_str(" ")?;
            }
            write!(formatter, "{number}")?;
        }
        Ok(())
    }
}
