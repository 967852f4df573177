//! What is true in a frame: the joints, their pixels, and what can be seen.

use super::body::ArmJoints;
use crate::motion::ArmSide;
use crate::wording::side_name;
use sinew_core::camera::{Camera, Pixel};
use std::fmt::Write;

/// Truth of one arm in one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SideTruth {
    /// The person's side.
    pub side: ArmSide,
    /// Joints in camera axes, metres.
    pub joints: ArmJoints,
    /// Whether the hand's skin can be seen: not hidden, and at least half of its parts inside the
    /// image and not behind something.
    pub hand_visible: bool,
}

impl SideTruth {
    /// Pixel of the middle of the hand, also where it is hidden or outside the image; `None` behind
    /// the camera.
    #[must_use]
    pub fn hand_px(&self, camera: &Camera) -> Option<Pixel> {
        camera.project(&self.joints.hand_m)
    }
}

/// Truth of one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameTruth {
    /// Number of the frame, from 0.
    pub frame: usize,
    /// Its time, seconds.
    pub time_s: f32,
    /// Whether face and neck show skin.
    pub false_blob: bool,
    /// Moving arms, left first.
    pub sides: Vec<SideTruth>,
}

/// Column names of the truth table.
pub const HEADER: &str = "frame,time_s,side,\
shoulder_x_m,shoulder_y_m,shoulder_z_m,elbow_x_m,elbow_y_m,elbow_z_m,hand_x_m,hand_y_m,hand_z_m,\
shoulder_u_px,shoulder_v_px,elbow_u_px,elbow_v_px,hand_u_px,hand_v_px,hand_visible,false_blob";

impl FrameTruth {
    /// One line per moving arm, in the order of [`HEADER`]; a pixel behind the camera is an empty
    /// cell.
    #[must_use]
    pub fn csv_lines(&self, camera: &Camera) -> String {
        let mut text = String::new();
        for truth in &self.sides {
            let points = [truth.joints.shoulder_m, truth.joints.elbow_m, truth.joints.hand_m];
            let _ = write!(text, "{},{:.4},{}", self.frame, self.time_s, side_name(truth.side));
            for point in &points {
                let _ = write!(text, ",{:.5},{:.5},{:.5}", point.x, point.y, point.z);
            }
            for point in &points {
                match camera.project(point) {
                    Some(pixel) => write!(text, ",{:.2},{:.2}", pixel.u_px, pixel.v_px),
                    None => write!(text, ",,"),
                }
                .unwrap_or(());
            }
            let _ = writeln!(text, ",{},{}", u8::from(truth.hand_visible), u8::from(self.false_blob));
        }
        text
    }
}
