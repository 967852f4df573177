//! Named points in space over time, some of them missing: marker files (TRC, C3D), and motions seen
//! as such.

use super::recording::Motion;
use super::shortfall::Shortfall;
use sinew_core::math::Vec3;

/// Positions of named points over time.
#[derive(Debug, Clone, PartialEq)]
pub struct MarkerMotion {
    /// Frames in a second.
    pub frames_per_second: f32,
    /// Names, in the file's order.
    pub names: Vec<String>,
    /// Positions in metres, one row of `names.len()` a frame; `None` where the point was not seen.
    pub positions_m: Vec<Vec<Option<Vec3>>>,
    /// How many frames its header promises, where these are more than there are.
    pub shortfall: Option<Shortfall>,
}

impl From<&Motion> for MarkerMotion {
    fn from(motion: &Motion) -> Self {
        Self {
            frames_per_second: motion.frames_per_second,
            names: motion.joints.clone(),
            positions_m: (0..motion.len())
                .map(|frame| motion.frame(frame).iter().copied().map(Some).collect())
                .collect(),
            shortfall: motion.shortfall,
        }
    }
}

/// Metres per length unit of this name; `None` for a unit that is not known.
#[must_use]
pub fn metres_per_unit(unit: &str) -> Option<f32> {
    match unit.trim().to_ascii_lowercase().as_str() {
        "m" | "metre" | "metres" | "meter" | "meters" => Some(1.0),
        "cm" => Some(0.01),
        "mm" => Some(0.001),
        "in" | "inch" | "inches" => Some(0.0254),
        _ => None,
    }
}
