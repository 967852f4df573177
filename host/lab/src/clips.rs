//! Motions that drive the rendered scenes: recorded ones, and seeded reaches that need no file.

use anyhow::{Context, Result, ensure};
use sinew::motion::clips as recordings;
use sinew::motion::reach::random_reaches;
use sinew::motion::{ArmMotion, ArmSide};
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
    /// A recording in a folder.
    Recorded { clip: recordings::Clip, folder: PathBuf },
    /// Random reaches with this seed.
    Builtin { seed: u64 },
}

/// The clips of [`recordings::CLIPS`] whose files are below `folder`.
///
/// # Errors
/// If there is none.
pub fn recorded(folder: &Path) -> Result<Vec<Clip>> {
    let found = recordings::available(folder);
    ensure!(
        !found.is_empty(),
        "`{}` holds none of the recorded clips; give the folder of the recordings, or leave --mocap out for built-in reaches",
        folder.display()
    );
    let clip = |clip: recordings::Clip| Clip {
        name: clip.name.to_owned(),
        side: clip.side,
        source: Source::Recorded { clip, folder: folder.to_path_buf() },
    };
    Ok(found.into_iter().map(clip).collect())
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
            Source::Recorded { clip, folder } => clip.read(folder).with_context(|| format!("clip `{}`", self.name)),
        }
    }
}
