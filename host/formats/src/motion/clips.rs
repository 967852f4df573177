//! Recorded clips with moving arms, for evaluation on rendered scenes.

use super::arm_motion::{ArmMotion, ArmSide};
use super::error::MotionError;
use super::read_options::ReadOptions;
use super::reading::read;
use std::path::Path;

/// A part of a recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clip {
    /// Short name for tables.
    pub name: &'static str,
    /// Motion file, relative to the folder of recordings.
    pub file: &'static str,
    /// Skeleton of an AMC file, relative to the same folder.
    pub skeleton: Option<&'static str>,
    /// The arm that moves most.
    pub side: ArmSide,
    /// First and last second that are used; all of it where there is none.
    pub between_s: Option<[f32; 2]>,
}

const SKELETON: Option<&str> = Some("cmu-walk/35/35.asf");

const fn clip(
    name: &'static str,
    file: &'static str,
    skeleton: Option<&'static str>,
    side: ArmSide,
    between_s: Option<[f32; 2]>,
) -> Clip {
    Clip { name, file, skeleton, side, between_s }
}

/// The clips, in the order of tables. Arm circles and jumping jacks are cut by the labels of
/// subject 13. The skeleton of subject 13 is not published; that of subject 35 replaces it, since
/// only directions are used.
pub const CLIPS: [Clip; 10] = [
    clip("wave-right-1", "bandai/dataset-2_wave-right-hand_normal_001.bvh", None, ArmSide::Right, None),
    clip("wave-right-2", "bandai/dataset-2_wave-right-hand_normal_002.bvh", None, ArmSide::Right, None),
    clip("wave-both-1", "bandai/dataset-2_wave-both-hands_normal_001.bvh", None, ArmSide::Left, None),
    clip("wave-both-2", "bandai/dataset-2_wave-both-hands_normal_002.bvh", None, ArmSide::Right, None),
    clip("raise-left", "bandai/dataset-2_raise-up-left-hand_normal_001.bvh", None, ArmSide::Left, None),
    clip("arm-circles-1", "cmu-exercise/13_29.amc", SKELETON, ArmSide::Right, Some([10.1, 16.0])),
    clip("arm-circles-2", "cmu-exercise/13_31.amc", SKELETON, ArmSide::Left, Some([17.1, 22.7])),
    clip("jumping-jacks", "cmu-exercise/13_29.amc", SKELETON, ArmSide::Left, Some([0.0, 3.9])),
    clip("traffic", "cmu-expmap/train_directing_traffic_1.txt", None, ArmSide::Right, None),
    clip("basketball", "cmu-expmap/train_basketball_signal_3.txt", None, ArmSide::Right, None),
];

impl Clip {
    /// Whether the clip's files are in `folder`.
    #[must_use]
    pub fn is_available(&self, folder: &Path) -> bool {
        folder.join(self.file).is_file() && self.skeleton.is_none_or(|skeleton| folder.join(skeleton).is_file())
    }

    /// Reads the clip from `folder`, at the recording's own rate.
    ///
    /// # Errors
    /// Names the file, the line and the rule that it broke.
    pub fn read(&self, folder: &Path) -> Result<ArmMotion, MotionError> {
        let path = folder.join(self.file);
        let skeleton = self.skeleton.map(|skeleton| folder.join(skeleton));
        let options = ReadOptions { skeleton: skeleton.as_deref(), ..ReadOptions::default() };
        let motion = ArmMotion::from_motion(&read(&path, &options)?, &path)?;
        Ok(match self.between_s {
            Some([start_s, end_s]) => motion.between(start_s, end_s),
            None => motion,
        })
    }
}

/// The clips whose files are in `folder`.
#[must_use]
pub fn available(folder: &Path) -> Vec<Clip> {
    CLIPS.into_iter().filter(|clip| clip.is_available(folder)).collect()
}
