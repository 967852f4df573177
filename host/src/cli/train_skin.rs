//! `sinew train skin`: a skin model from labelled pixels or from images with masks.

use super::console::Console;
use super::data_error;
use crate::output::{check_writable_file, write_atomically};
use crate::skin::model::{ModelKind, SkinModel};
use crate::skin::model_file;
use crate::skin::pairs::{self, PairList};
use crate::skin::training::{TrainingOptions, pairs_set, pixels_set, train};
use crate::skin::training_set::TrainingSet;
use anyhow::Result;
use clap::Args;
use serde_json::json;
use std::path::PathBuf;

/// Options of `sinew train skin`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  sinew simulate arm --motion builtin --frames 20 --out scene
  sinew segment scene/frames --out masks
  sinew train skin --images scene/frames --masks masks --out my_skin.json")]
pub struct TrainSkinArgs {
    /// Labelled pixels: rows `B G R label`, label 1 = skin, 2 = not (the UCI "Skin Segmentation"
    /// form).
    #[arg(long, value_name = "FILE", required_unless_present = "images", conflicts_with_all = ["images", "masks"])]
    pub pixels: Option<PathBuf>,
    /// Folder of images; may be given several times, each with its --masks.
    #[arg(long, value_name = "DIR", requires = "masks")]
    pub images: Vec<PathBuf>,
    /// Folder of masks, brighter than 127 = skin, named like their images (or NAME_skin_NAME).
    #[arg(long, value_name = "DIR", requires = "images")]
    pub masks: Vec<PathBuf>,
    /// Model file to write.
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    /// Kind of model [default: gaussian for --pixels, histogram for --images].
    #[arg(long, value_enum)]
    pub kind: Option<ModelKind>,
    /// Folds of the cross-validation.
    #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u32).range(2..=1000))]
    pub folds: u32,
    /// Seed of sampling and shuffling.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Refuse to run if an image cannot be read or has no mask.
    #[arg(long)]
    pub strict: bool,
}

/// Trains, prints the cross-validated scores, writes the model.
///
/// # Errors
/// Bad input, or an output that cannot be written.
pub fn run(args: &TrainSkinArgs, console: &Console) -> Result<()> {
    check_writable_file(&args.out)?;
    let (set, default_kind) = match &args.pixels {
        Some(path) => (pixels_set(path, args.seed)?, ModelKind::Gaussian),
        None => (read_pairs(args, console)?, ModelKind::Histogram),
    };
    let kind = args.kind.unwrap_or(default_kind);
    let (model, _) = train(&set, TrainingOptions { kind, folds: args.folds as usize, seed: args.seed })?;
    let json = model_file::to_json(&model)?;
    write_atomically(&args.out, |writer| Ok(writer.write_all(json.as_bytes())?))?;
    let report = summary(&model) + &format!("wrote {}\n", args.out.display());
    console.answer_beside(
        &args.out,
        &report,
        &json!({ "kind": model.kind(), "trained_on": model.trained_on, "out": args.out }),
    )
}

fn read_pairs(args: &TrainSkinArgs, console: &Console) -> Result<TrainingSet> {
    let list = pairs::find(&args.images, &args.masks)?;
    report_unmasked(&list, console);
    let (set, skipped) = pairs_set(&list, args.seed)?;
    for (path, reason) in &skipped {
        console.note(format!("skipped `{}`: {reason}", path.display()));
    }
    if args.strict && !(skipped.is_empty() && list.without_mask.is_empty()) {
        let count = skipped.len() + list.without_mask.len();
        return Err(data_error(format!("{count} images cannot be used, and --strict was given")));
    }
    if !skipped.is_empty() {
        console.note(format!("{} image-mask pairs were skipped", skipped.len()));
    }
    Ok(set)
}

/// Counts and names the images without a mask on standard error.
pub fn report_unmasked(list: &PairList, console: &Console) {
    if !list.without_mask.is_empty() {
        let names: Vec<String> = list.without_mask.iter().map(|path| path.display().to_string()).collect();
        console.note(format!("{} images have no mask and are left out: {}", names.len(), names.join(", ")));
    }
}

/// What was trained, on what, and its scores.
fn summary(model: &SkinModel) -> String {
    let on = &model.trained_on;
    let unit = if on.images > 0 { format!("{} images", on.images) } else { "different rows".to_owned() };
    let scores = on.cross_validated;
    format!(
        "{:?} model from {} ({unit}: {} skin and {} other pixels)\n\
         cross-validated, {} folds: precision {:.3}, recall {:.3}, F1 {:.3}\n",
        model.kind(),
        on.sources.join(", "),
        on.skin_pixels,
        on.other_pixels,
        on.folds,
        scores.precision,
        scores.recall,
        scores.f1
    )
}
