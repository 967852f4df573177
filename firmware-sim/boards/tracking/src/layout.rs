//! How the recordings lie in flash; the build script writes them so.

/// Angles of a frame of the walk.
pub const ANGLES: usize = 13;
/// Frames of the walk, at the model's rate.
pub const WALK_FRAMES: usize = 600;
/// What a recorded angle counts, for a radian.
pub const UNITS_PER_RAD: f32 = 8192.0;
/// Pixels of a line.
pub const WIDTH: usize = 320;
/// Lines of a frame.
pub const HEIGHT: usize = 240;
/// Frames of the camera.
pub const FRAMES: usize = 12;
