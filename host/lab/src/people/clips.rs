//! A clip of a person with its reference.

use super::reference::{self, Reference};
use anyhow::{Context, Result, ensure};
use image::RgbImage;
use sinew::track::FrameSource;
use std::path::{Path, PathBuf};

/// Frames per second of the clips.
pub const RATE_HZ: f64 = 30.0;

/// Videos in a folder that have a reference beside them, by name.
///
/// # Errors
/// The folder cannot be read, or has none.
pub fn list(folder: &Path) -> Result<Vec<PathBuf>> {
    let entries = folder.read_dir().with_context(|| format!("clips in {}", folder.display()))?;
    let mut clips: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    clips.retain(|path| path.extension().is_some_and(|extension| extension == "mkv"));
    clips.sort();
    ensure!(!clips.is_empty(), "{} has no clips (.mkv)", folder.display());
    Ok(clips)
}

/// The reference of a clip, a row a frame.
///
/// # Errors
/// There is none beside it.
pub fn reference(clip: &Path) -> Result<Vec<Reference>> {
    let name = clip.file_stem().unwrap_or_default().to_string_lossy();
    reference::read(&clip.with_file_name(format!("{name}_points.csv")))
}

/// All pictures of a clip.
///
/// # Errors
/// It cannot be read to its end.
pub fn pictures(clip: &Path) -> Result<Vec<RgbImage>> {
    let mut frames = FrameSource::open(clip, false, RATE_HZ)?;
    let mut pictures = Vec::new();
    while let Some(picture) = frames.load(pictures.len(), 1)?.pop() {
        pictures.push(picture.map_err(|skipped| anyhow::anyhow!("{}: {skipped:?}", clip.display()))?);
    }
    Ok(pictures)
}
