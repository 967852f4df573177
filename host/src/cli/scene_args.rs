//! What the scenes of `sinew simulate` share: pairs of numbers, and a folder without an older
//! scene.

use anyhow::{Context, Result, bail};
use std::path::Path;
use std::str::FromStr;

/// Two values with a comma between them.
pub(super) fn pair<T: FromStr>(text: &str) -> Result<(T, T), String> {
    let parsed = text.split_once(',').and_then(|(a, b)| Some((a.trim().parse().ok()?, b.trim().parse().ok()?)));
    parsed.ok_or_else(|| "two numbers with a comma between them were expected".to_string())
}

/// So many numbers with commas between them.
pub(super) fn numbers<const N: usize>(text: &str) -> Result<[f32; N], String> {
    let parsed: Option<Vec<f32>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    let wanted = || format!("{N} numbers with commas between them were expected");
    parsed.and_then(|numbers| numbers.try_into().ok()).ok_or_else(wanted)
}

/// Frames of an older scene would mix with the new ones: they are refused, or with `force` removed.
pub(super) fn clear_frames(frames: &Path, start: &str, end: &str, force: bool) -> Result<()> {
    let Ok(entries) = std::fs::read_dir(frames) else { return Ok(()) };
    for entry in entries {
        let path = entry?.path();
        if !force {
            bail!("`{}` already holds files; choose another --out, or replace them with --force", frames.display());
        }
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or("");
        if name.starts_with(start) && name.ends_with(end) {
            std::fs::remove_file(&path).with_context(|| format!("`{}` cannot be removed", path.display()))?;
        }
    }
    Ok(())
}
