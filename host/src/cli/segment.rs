//! `sinew segment`: skin masks of images.

use super::console::Console;
use super::image_run::{Skipped, load_each};
use super::skin_args::SkinArgs;
use crate::images::ImageInput;
use crate::images::video::frame_name;
use crate::output::OutputDir;
use anyhow::{Result, bail};
use clap::Args;
use image::ImageFormat;
use serde_json::json;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// Options of `sinew segment`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  sinew simulate arm --motion builtin --frames 5 --out scene
  sinew segment scene/frames --out masks")]
pub struct SegmentArgs {
    /// Folder of images, one image, or a video (read by ffmpeg).
    #[arg(value_name = "IMAGE|FOLDER|VIDEO")]
    pub input: PathBuf,
    /// Folder for the masks: 255 = skin, named like their images, .png.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Skin model and calibration.
    #[command(flatten)]
    pub skin: SkinArgs,
    /// Write each pixel's own decision, without the opening and closing that the tracker applies.
    #[arg(long)]
    pub raw: bool,
    /// Stop at the first image that cannot be read.
    #[arg(long)]
    pub strict: bool,
}

/// Segments each image alone.
///
/// # Errors
/// Bad input, no image that can be read, or an output that cannot be written.
pub fn run(args: &SegmentArgs, console: &Console) -> Result<()> {
    let mut model = args.skin.load()?;
    let input = ImageInput::open(&args.input)?;
    let out = OutputDir::create(&args.out)?;
    let files = match &input {
        ImageInput::Files(files) => files.as_slice(),
        ImageInput::Video(_) => &[],
    };
    refuse_own_input(files, out.path())?;
    let names = mask_names(files);
    for (file, name) in files.iter().zip(&names).filter(|(_, name)| name.renamed) {
        console.note(format!(
            "`{}` shares its stem with another image: its mask is `{}`",
            file.display(),
            Path::new(&name.file).display()
        ));
    }
    let mut skipped = Skipped::new(args.strict, *console);
    let mut done = 0;
    load_each(&input, &args.skin, &mut model, &mut skipped, |model, index, image| {
        let mut mask = model.classify(image)?;
        if !args.raw {
            mask.clean()?;
        }
        let mut png = Cursor::new(Vec::new());
        mask.to_gray().write_to(&mut png, ImageFormat::Png)?;
        done += 1;
        let name = names.get(index).map_or_else(|| frame_name(&args.input, index).into(), |name| name.file.clone());
        Ok(out.write_frame(name, |writer| Ok(writer.write_all(png.get_ref())?))?)
    })?;
    let text = format!("{done} masks written to {}\n", out.path().display());
    console.answer(&text, &json!({ "masks": done, "skipped": skipped.reasons(), "out": out.path() }))?;
    skipped.whole()
}

/// A mask would take the name of its image.
fn refuse_own_input(files: &[PathBuf], out: &Path) -> Result<()> {
    let folder = files.first().and_then(|file| file.parent()).filter(|folder| !folder.as_os_str().is_empty());
    let (Ok(from), Ok(to)) = (folder.unwrap_or(Path::new(".")).canonicalize(), out.canonicalize()) else {
        return Ok(());
    };
    if from == to {
        bail!("`--out {}` is the folder of the images, which masks would overwrite; choose another", out.display());
    }
    Ok(())
}

struct MaskName {
    file: OsString,
    renamed: bool,
}

/// STEM.png; where several images share a stem (in any case), NAME.EXTENSION.png for each of them.
fn mask_names(files: &[PathBuf]) -> Vec<MaskName> {
    let plain = |file: &PathBuf| file.file_stem().unwrap_or_default().to_os_string();
    let folded = |name: &OsString| name.to_string_lossy().to_lowercase();
    let mut uses: BTreeMap<String, usize> = BTreeMap::new();
    for file in files {
        *uses.entry(folded(&plain(file))).or_default() += 1;
    }
    let mut taken: BTreeMap<String, usize> = BTreeMap::new();
    let name = |file: &PathBuf| {
        let whole = file.file_name().unwrap_or_default().to_os_string();
        // The whole name of one file may be the stem of another: then that one is renamed, too.
        let renamed = uses[&folded(&plain(file))] > 1
            || files.iter().any(|other| other != file && other.file_name() == Some(&plain(file)));
        let mut stem = if renamed { whole } else { plain(file) };
        let earlier = taken.entry(folded(&stem)).or_default();
        *earlier += 1;
        if *earlier > 1 {
            stem.push(format!("_{earlier}"));
        }
        stem.push(".png");
        MaskName { file: stem, renamed }
    };
    files.iter().map(name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_stems_get_different_masks() {
        let files = ["a.jpg", "a.png", "B.png", "b.ppm", "c.jpg", "d.png.jpg", "d.png", "B.PNG"].map(PathBuf::from);
        let names: Vec<String> =
            mask_names(&files).iter().map(|name| name.file.to_string_lossy().into_owned()).collect();
        let expected = ["a.jpg.png", "a.png.png", "B.png.png", "b.ppm.png", "c.png", "d.png.jpg.png", "d.png"];
        assert_eq!(names[..7], expected);
        let mut folded: Vec<String> = names.iter().map(|name| name.to_lowercase()).collect();
        folded.sort();
        folded.dedup();
        assert_eq!(folded.len(), files.len(), "{names:?}");
    }
}
