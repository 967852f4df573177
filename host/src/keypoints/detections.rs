//! What a file of keypoints holds.

use super::layout::DetectedFrame;

/// Keypoints of all people in all frames, and what is known of their recording.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Detections {
    /// The frames, rising in number.
    pub frames: Vec<DetectedFrame>,
    /// Frames per second, where the file has times.
    pub rate_hz: Option<f64>,
    /// Width and height of the pictures, pixels, where they are known.
    pub image_size_px: Option<[f64; 2]>,
    /// Name of the order of the points, such as `COCO, 17 points`.
    pub layout: String,
    /// What a user should know, one sentence a line.
    pub notes: Vec<String>,
    /// What makes results doubtful, each with its remedy.
    pub doubts: Vec<String>,
}
