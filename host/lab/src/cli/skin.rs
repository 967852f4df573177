//! `sinew evaluate skin`: pixel scores of a skin model on images with masks.

use super::{cells_in, until_signal};
use crate::skin_faces::Faces;
use crate::skin_scores::{FolderScores, Judge, MIN_PALE_LIGHTNESS, Part, by_folder, cross_validate, judge};
use anyhow::{Error, Result};
use clap::Args;
use serde::Serialize;
use serde_json::json;
use sinew::cli::console::Console;
use sinew::cli::train_skin::report_unmasked;
use sinew::output::OutputDir;
use sinew::person::FaceDetector;
use sinew::resume::{Begun, Stop, identity, text_crc32};
use sinew::skin::model::{DEFAULT_SKIN, ModelKind};
use sinew::skin::pairs::{self, PairList};
use sinew::skin::training::TrainingOptions;
use sinew::skin::{SkinModel, model_file};
use std::fmt::Write;
use std::path::PathBuf;

/// Options of `sinew evaluate skin`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  sinew simulate arm --motion builtin --frames 20 --out scene
  sinew segment scene/frames --out masks
  sinew evaluate skin --images scene/frames --masks masks --out skin")]
pub struct EvaluateSkinArgs {
    /// Folder of images; may be given several times, each with its --masks.
    #[arg(long, value_name = "DIR", required = true)]
    pub images: Vec<PathBuf>,
    /// Folder of masks, brighter than 127 = skin, named like their images (or NAME_skin_NAME).
    #[arg(long, value_name = "DIR", required = true)]
    pub masks: Vec<PathBuf>,
    /// Skin model: gaussian or histogram (shipped), or a FILE made by `sinew train skin`.
    #[arg(long, value_name = "gaussian|histogram|FILE", default_value = DEFAULT_SKIN)]
    pub skin: String,
    /// Look for a face in each image, whose colour takes the place of the model, as in `sinew track
    /// arm`. Scores pale skin and the pixels outside of heads, too.
    #[arg(long)]
    pub face: bool,
    /// Train anew on K folds of these images, and score each image by a model that was not trained
    /// on it.
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(2..=1000), conflicts_with_all = ["skin", "face"])]
    pub cross_validate: Option<u32>,
    /// Kind of model that --cross-validate trains.
    #[arg(long, value_enum, default_value = "histogram", requires = "cross_validate")]
    pub kind: ModelKind,
    /// Seed of the folds.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Score masks after the tracker's opening and closing; without it, each pixel by its own
    /// colour.
    #[arg(long)]
    pub morphology: bool,
    /// Folder for the scores as skin.csv and skin.json.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Go on with the evaluation in --out that a signal ended; the other options have to be the
    /// same.
    #[arg(long, requires = "out")]
    pub resume: bool,
}

#[derive(Debug, Serialize)]
struct Report<'a> {
    format: &'static str,
    version: u32,
    sinew_version: &'static str,
    model: &'a str,
    cross_validated: bool,
    face: bool,
    morphology: bool,
    rows: Vec<FolderScores>,
    skipped: Vec<String>,
}

/// Scores the model and prints a table.
///
/// # Errors
/// Bad input, no image that can be read, or [`sinew::resume::Interrupted`].
pub fn run(args: &EvaluateSkinArgs, console: &Console) -> Result<()> {
    match args.out {
        Some(_) => until_signal(console, |stop| run_until(args, console, stop)),
        None => run_until(args, console, &|| false),
    }
}

/// As [`run`], ended by `stop` in the place of a signal.
///
/// # Errors
/// As [`run`].
pub fn run_until(args: &EvaluateSkinArgs, console: &Console, stop: Stop<'_>) -> Result<()> {
    let list = pairs::find(&args.images, &args.masks)?;
    let output = args.out.as_deref().map(OutputDir::create).transpose()?;
    report_unmasked(&list, console);
    let shipped = SkinModel::from_option(&args.skin)?;
    let cells = cells_in(output.as_ref(), &begun(args, &list, &shipped)?, args.resume, stop)?;
    let (judged, model) = match args.cross_validate {
        Some(count) => {
            let options = TrainingOptions { kind: args.kind, folds: 10, seed: args.seed };
            let [judged] = cross_validate(&list, count as usize, options, [args.morphology], &cells)?;
            (judged, format!("{:?}, cross-validated", args.kind).to_lowercase())
        }
        None => {
            warn_if_trained_on(&shipped, &list, console);
            let faces = args.face.then(|| Ok::<_, Error>(Faces { detector: FaceDetector::new()?, adapt: true }));
            let faces = faces.transpose()?;
            let by = Judge { model: &shipped, faces: faces.as_ref(), morphology: args.morphology };
            (judge(&list.pairs, by, &cells)?, args.skin.clone())
        }
    };
    let skipped: Vec<String> = judged.iter().filter_map(|image| image.as_ref().err().cloned()).collect();
    skipped.iter().for_each(|reason| console.note(format!("skipped: {reason}")));
    let rows = by_folder(&list, &judged, args.face)?;
    let cross_validated = args.cross_validate.is_some();
    let report = Report {
        format: "sinew-evaluate-skin",
        version: 1,
        sinew_version: env!("CARGO_PKG_VERSION"),
        model: &model,
        cross_validated,
        face: args.face,
        morphology: args.morphology,
        rows,
        skipped,
    };
    if let Some(output) = output {
        output.write("skin.json", |writer| Ok(serde_json::to_writer_pretty(writer, &report)?))?;
        output.write("skin.csv", |writer| {
            let mut table = csv::Writer::from_writer(writer);
            report.rows.iter().try_for_each(|row| table.serialize(row))?;
            Ok(table.flush()?)
        })?;
    }
    cells.end()?;
    console.answer(&summary(&report), &report)
}

/// What the cells depend on.
fn begun(args: &EvaluateSkinArgs, list: &PairList, model: &SkinModel) -> Result<Begun> {
    let options = json!({
        "images": args.images,
        "masks": args.masks,
        "skin": args.skin,
        "face": args.face,
        "cross_validate": args.cross_validate,
        "kind": args.kind,
        "seed": args.seed,
        "morphology": args.morphology,
    });
    let files = list.pairs.iter().flat_map(|pair| [&pair.image, &pair.mask]).map(|file| identity(file)).collect();
    let begun = Begun::new("evaluate skin", &options, &[])?.with_frames(files);
    Ok(begun.reading("the skin model", text_crc32(&model_file::to_json(model)?)))
}

/// A training image's score says nothing about other images.
fn warn_if_trained_on(model: &SkinModel, list: &PairList, console: &Console) {
    for name in list.groups.iter().filter(|name| model.trained_on.sources.contains(name)) {
        let remedy = "if it is this one, use --cross-validate";
        console.note(format!("note: the model was trained on a folder named {name}; {remedy}"));
    }
}

fn summary(report: &Report<'_>) -> String {
    let by = if report.face { "the colour of the face, or " } else { "" };
    let mut text = format!("model: {by}{}\n", report.model);
    let more = if report.face { "  F1 outside heads" } else { "" };
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{:<24} images  precision  recall  F1     median image F1{more}", "folder");
    for row in &report.rows {
        let name = match row.part {
            Part::All => row.images_folder.clone(),
            Part::Face => "  with a face".to_owned(),
            Part::Pale => format!("  skin above L* {MIN_PALE_LIGHTNESS}"),
        };
        let _ = write!(
            text,
            "{name:<24} {:>6}  {:>9.3}  {:>6.3}  {:.3}  {:>15.3}",
            row.images, row.precision, row.recall, row.f1, row.median_image_f1
        );
        let _ = row.f1_outside_head.map(|f1| write!(text, "  {f1:>16.3}"));
        text.push('\n');
    }
    text
}
