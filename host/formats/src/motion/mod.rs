//! Recorded and generated human motion: readers (BVH, ASF/AMC, exponential maps) and what an arm tracker needs of it.
//!
//! A reader gives a [`Motion`], joint positions in metres over time. [`ArmMotion`] keeps of it the directions of upper
//! arm and forearm in the torso's frame, so that another body can perform it.

pub mod amc;
pub mod anthropometry;
pub mod arm_motion;
pub mod asf;
pub mod bvh;
pub mod c3d;
pub mod clips;
pub mod error;
pub mod exponential_map;
pub mod export;
pub mod joint_names;
pub mod landmarks;
pub mod markers;
pub mod reach;
pub mod space;
pub mod trc;

pub use arm_motion::{ArmDirections, ArmMotion, ArmSide};
pub use error::MotionError;
pub use markers::MarkerMotion;
pub use space::read_space;

use sinew_core::math::Vec3;
use std::path::Path;

/// Positions of named joints over time.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// Frames in a second.
    pub frames_per_second: f32,
    /// Names, in the file's order.
    pub joints: Vec<String>,
    /// Positions in metres, `frames` rows of `joints.len()`, row by row; axes as in the file.
    pub positions_m: Vec<Vec3>,
}

impl Motion {
    /// How many frames there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.positions_m.len().checked_div(self.joints.len()).unwrap_or(0)
    }

    /// Whether there is no frame.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Positions of all joints in one frame, metres.
    ///
    /// # Panics
    /// If `frame` is not below [`Motion::len`].
    #[must_use]
    pub fn frame(&self, frame: usize) -> &[Vec3] {
        let joints = self.joints.len();
        &self.positions_m[frame * joints..(frame + 1) * joints]
    }

    /// Index of the joint called `name`, whatever the case and whatever stands before a colon.
    #[must_use]
    pub fn joint(&self, name: &str) -> Option<usize> {
        self.joints.iter().position(|joint| joint.rsplit(':').next().is_some_and(|j| j.eq_ignore_ascii_case(name)))
    }
}

/// How to read a motion file.
#[derive(Debug, Clone, Default)]
pub struct ReadOptions<'a> {
    /// Skeleton of an AMC file; the only .asf of its folder where there is none.
    pub skeleton: Option<&'a Path>,
    /// Frames in a second of a file that does not say (AMC, exponential maps); 120 where there is none.
    pub frames_per_second: Option<f32>,
    /// Metres per length unit of a BVH file; inferred from the arms where there is none.
    pub metres_per_unit: Option<f32>,
}

/// Frames in a second of the formats that do not say: what the CMU and HDM05 collections were recorded at.
pub const DEFAULT_FRAMES_PER_SECOND: f32 = 120.0;

/// Reads a motion by its file ending: `.bvh`, `.amc`, or `.txt` (exponential maps).
///
/// # Errors
/// Names the file, the line and the rule that it broke.
pub fn read(path: &Path, options: &ReadOptions<'_>) -> Result<Motion, MotionError> {
    let rate = options.frames_per_second.unwrap_or(DEFAULT_FRAMES_PER_SECOND);
    if !(rate > 0.0 && rate.is_finite()) {
        let rule = format!("must be greater than zero, not {rate}");
        return Err(MotionError::Parameter { parameter: "frames_per_second", rule });
    }
    // What is not there is of no kind, whatever its name.
    let unreadable = |reason| MotionError::Unreadable { path: path.to_path_buf(), reason };
    std::fs::metadata(path).map_err(unreadable)?;
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
    match extension.as_str() {
        "bvh" => bvh::read(path, options.metres_per_unit),
        "amc" => {
            let skeleton = match options.skeleton {
                Some(path) => asf::read(path)?,
                None => asf::read(&asf::beside(path)?)?,
            };
            amc::read(path, &skeleton, rate)
        }

        "txt" => exponential_map::read(path, rate),
        _ => Err(MotionError::UnknownKind { path: path.to_path_buf() }),
    }
}
