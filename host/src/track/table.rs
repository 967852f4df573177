//! The rows of `track.csv`.

use super::arms::ArmView;
use crate::csv_text::name_cell;
use crate::wording::{side_name, status_name};
use sinew_core::camera::{Camera, Pixel};
use sinew_core::math::Vec3;
use sinew_core::tracker::arm::Status;

/// Column names of `track.csv`.
pub const HEADER: [&str; 31] = [
    "frame",
    "image",
    "side",
    "status",
    "time_s",
    "hand_u_px",
    "hand_v_px",
    "elbow_u_px",
    "elbow_v_px",
    "shoulder_u_px",
    "shoulder_v_px",
    "hand_x_m",
    "hand_y_m",
    "hand_z_m",
    "elbow_x_m",
    "elbow_y_m",
    "elbow_z_m",
    "shoulder_x_m",
    "shoulder_y_m",
    "shoulder_z_m",
    "elevation_rad",
    "deviation_rad",
    "rotation_rad",
    "flexion_rad",
    "hand_likelihood",
    "blob_count",
    "effective_sample_size",
    "hand_std_m",
    "log_evidence",
    "dropped_blobs",
    "degenerate",
];

/// One frame of one arm.
#[derive(Debug, Clone)]
pub struct TrackRow {
    /// Number of the frame, from 0 in natural order.
    pub frame: usize,
    /// File name of the image.
    pub image: String,
    /// Time of the frame, seconds.
    pub time_s: f64,
    /// What the tracker answered.
    pub view: ArmView,
    /// Blobs of the frame; `None` where the image is missing.
    pub blob_count: Option<usize>,
    /// Blobs that found no room.
    pub dropped_blobs: u32,
}

impl TrackRow {
    /// The cells in the order of [`HEADER`]; a lost arm's places and angles are empty.
    #[must_use]
    pub fn cells(&self, camera: &Camera) -> Vec<String> {
        let estimate = &self.view.estimate;
        let known = estimate.status != Status::Lost;
        let joints = [estimate.joints.hand_m, estimate.joints.elbow_m, estimate.joints.shoulder_m];
        let mut cells = vec![
            self.frame.to_string(),
            name_cell(&self.image).into_owned(),
            side_name(estimate.side).to_owned(),
            status_name(estimate.status).to_owned(),
            format!("{:.6}", self.time_s),
        ];
        cells.extend(joints.iter().flat_map(|joint| pixel_cells(camera.project(joint).filter(|_| known))));
        cells.extend(joints.iter().flat_map(|joint| metre_cells(known.then_some(*joint))));
        cells.extend(estimate.angles_rad.iter().map(|angle| cell(known.then_some(*angle), 5)));
        cells.push(format!("{:.4}", estimate.hand_likelihood));
        cells.push(self.blob_count.map_or_else(String::new, |count| count.to_string()));
        cells.push(format!("{:.2}", estimate.effective_sample_size));
        cells.push(cell(known.then_some(estimate.hand_std_m), 5));
        cells.push(format!("{:.5}", estimate.log_evidence));
        cells.push(self.dropped_blobs.to_string());
        cells.push(u8::from(estimate.degenerate).to_string());
        cells
    }
}

fn cell(value: Option<f32>, decimals: usize) -> String {
    value.filter(|value| value.is_finite()).map_or_else(String::new, |value| format!("{value:.decimals$}"))
}

fn pixel_cells(pixel: Option<Pixel>) -> [String; 2] {
    [cell(pixel.map(|pixel| pixel.u_px), 2), cell(pixel.map(|pixel| pixel.v_px), 2)]
}

fn metre_cells(point: Option<Vec3>) -> [String; 3] {
    [0, 1, 2].map(|axis| cell(point.map(|point| point[axis]), 5))
}
