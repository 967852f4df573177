//! Builds images, by cargo in their folder.

use anyhow::{Context, Result, ensure};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The target of all images.
pub const TARGET: &str = "thumbv7em-none-eabihf";

/// Builds all images in release; `arguments` go to cargo. `SINEW_CARGO` names another cargo, whose
/// arguments may follow.
///
/// # Errors
/// Cargo fails.
pub fn images(arguments: &[&str]) -> Result<()> {
    let cargo = std::env::var("SINEW_CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let mut words = cargo.split_whitespace();
    let program = words.next().context("SINEW_CARGO is empty")?;
    let status = Command::new(program)
        .args(["build", "--release", "--bins"])
        .args(words)
        .args(arguments)
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../firmware-sim"))
        .status()
        .with_context(|| format!("`{program}` cannot be run"))?;
    ensure!(status.success(), "the images cannot be built; `rustup target add {TARGET}` installs their target");
    Ok(())
}

/// Where cargo puts the image `name`.
#[must_use]
pub fn image_path(name: &str) -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target"), PathBuf::from);
    target.join(TARGET).join("release").join(name)
}
