//! What a reader of motions is given beside the file.

use std::path::Path;

/// How to read a motion file.
#[derive(Debug, Clone, Default)]
pub struct ReadOptions<'a> {
    /// Skeleton of an AMC file; the only .asf of its folder where there is none.
    pub skeleton: Option<&'a Path>,
    /// Frames per second of a file that does not store it; [`DEFAULT_FRAMES_PER_SECOND`] if `None`.
    pub frames_per_second: Option<f32>,
    /// Metres per length unit of a BVH file; inferred from the arms where there is none.
    pub metres_per_unit: Option<f32>,
    /// Take a recording with fewer frames than its header promises, such as a file that was cut
    /// off; an error if not.
    pub partial: bool,
    /// File of names for points of the motion: lines as `left_hip,NAME`, or `left_hip,NAME,NAME`
    /// for the middle of two. Joints: hips, neck, and left and right shoulder, elbow, wrist, hip,
    /// knee, ankle, heel, toe.
    pub names: Option<&'a Path>,
}

impl ReadOptions<'_> {
    /// Frames per second of a file that does not store its rate.
    #[must_use]
    pub fn rate(&self) -> f32 {
        self.frames_per_second.unwrap_or(DEFAULT_FRAMES_PER_SECOND)
    }
}

/// Frames per second of formats that do not store it: the rate of the CMU and HDM05 collections.
pub const DEFAULT_FRAMES_PER_SECOND: f32 = 120.0;
