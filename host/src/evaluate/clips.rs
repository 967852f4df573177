//! Real arm motions that drive the rendered scenes, and the built-in ones that need no file.

use crate::motion::reach::random_reaches;
use crate::motion::{self, ArmMotion, ArmSide, ReadOptions};
use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};

/// One motion for a scene.
#[derive(Debug, Clone)]
pub struct Clip {
    /// Short name for tables.
    pub name: String,
    /// Arm that is shown and tracked.
    pub side: ArmSide,
    source: Source,
}

#[derive(Debug, Clone)]
enum Source {
    /// A file below the mocap folder, with the skeleton it needs and the seconds that are used.
    File { path: PathBuf, skeleton: Option<PathBuf>, seconds: Option<[f32; 2]> },
    /// Random reaches with this seed.
    Builtin { seed: u64 },
}

/// Files below a mocap folder: name, file, arm, used seconds.
const FILES: [(&str, &str, ArmSide, Option<[f32; 2]>); 8] = [
    ("wave-right", "bandai/dataset-2_wave-right-hand_normal_001.bvh", ArmSide::Right, None),
    ("wave-right-2", "bandai/dataset-2_wave-right-hand_normal_002.bvh", ArmSide::Right, None),
    ("wave-both", "bandai/dataset-2_wave-both-hands_normal_001.bvh", ArmSide::Left, None),
    ("raise-right", "bandai/dataset-2_raise-up-right-hand_normal_001.bvh", ArmSide::Right, None),
    ("raise-left", "bandai/dataset-2_raise-up-left-hand_normal_001.bvh", ArmSide::Left, None),
    ("exercise-29", "cmu-exercise/13_29.amc", ArmSide::Right, Some([0.0, 22.5])),
    ("exercise-30", "cmu-exercise/13_30.amc", ArmSide::Left, Some([0.0, 11.8])),
    ("exercise-31", "cmu-exercise/13_31.amc", ArmSide::Right, Some([8.2, 25.2])),
];

/// The skeleton that stands in for the missing one of the exercise recordings.
const EXERCISE_SKELETON: &str = "cmu-walk/35/35.asf";

/// The recorded clips below `mocap`.
///
/// # Errors
/// Names the first file that is missing.
pub fn recorded(mocap: &Path) -> Result<Vec<Clip>> {
    let clip = |(name, file, side, seconds): (&str, &str, ArmSide, Option<[f32; 2]>)| {
        let path = mocap.join(file);
        if !path.is_file() {
            bail!("clip `{}` is missing; give the folder that holds it with --mocap, or use --builtin", path.display());
        }
        let skeleton = file.ends_with("amc").then(|| mocap.join(EXERCISE_SKELETON));
        Ok(Clip { name: name.to_owned(), side, source: Source::File { path, skeleton, seconds } })
    };
    FILES.into_iter().map(clip).collect()
}

/// `count` clips of random reaches.
#[must_use]
pub fn builtin(count: u64) -> Vec<Clip> {
    let side = |seed: u64| if seed.is_multiple_of(2) { ArmSide::Left } else { ArmSide::Right };
    (1..=count)
        .map(|seed| Clip { name: format!("reach-{seed}"), side: side(seed), source: Source::Builtin { seed } })
        .collect()
}

impl Clip {
    /// Reads or makes the motion; a built-in one has `frames` frames at `frames_per_second`.
    ///
    /// # Errors
    /// A file that cannot be read, by name.
    pub fn load(&self, frames_per_second: f32, frames: usize) -> Result<ArmMotion> {
        match &self.source {
            Source::Builtin { seed } => Ok(random_reaches(*seed, frames_per_second, frames)?),
            Source::File { path, skeleton, seconds } => {
                let options = ReadOptions { skeleton: skeleton.as_deref(), ..ReadOptions::default() };
                let motion = motion::read(path, &options).with_context(|| format!("clip `{}`", self.name))?;
                let motion = ArmMotion::from_motion(&motion, path)?;
                Ok(seconds.map_or_else(|| motion.clone(), |[start, end]| motion.between(start, end)))
            }
        }
    }
}
