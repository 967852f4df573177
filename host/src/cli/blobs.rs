//! `sinew blobs`: features and hand likelihood of each blob.

use super::console::Console;
use super::image_run::{Skipped, load_each};
use super::skin_args::SkinArgs;
use crate::blob_rows::{BlobRow, COLUMNS, blobs_alone};
use crate::csv_text::name_cell;
use crate::frames::FrameReader;
use crate::images::ImageInput;
use crate::images::video::frame_name;
use crate::output::{check_writable_file, write_atomically};
use anyhow::Result;
use clap::{Args, ValueEnum};
use serde_json::json;
use sinew_core::vision::blobs::LikelyBlob;
use sinew_core::vision::edges::EdgeDetector;
use sinew_core::vision::hand_likelihood::HandLikelihood;
use std::path::{Path, PathBuf};

/// Options of `sinew blobs`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  sinew simulate arm --motion builtin --frames 5 --out scene
  sinew blobs scene/frames --out blobs.csv")]
pub struct BlobsArgs {
    /// Folder of images, one image, or a video (read by ffmpeg).
    #[arg(value_name = "IMAGE|FOLDER|VIDEO")]
    pub input: PathBuf,
    /// Form of the table.
    #[arg(long, value_enum, default_value = "csv")]
    pub format: TableFormat,
    /// File to write [default: standard output].
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Skin model and calibration.
    #[command(flatten)]
    pub skin: SkinArgs,
    /// Stop at the first image that cannot be read.
    #[arg(long)]
    pub strict: bool,
}

/// How a table is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum TableFormat {
    /// Comma-separated values with a header.
    Csv,
    /// A JSON list with an object a row.
    Json,
}

/// Finds the blobs of each image alone and writes the table.
///
/// # Errors
/// Bad input, no image that can be read, or an output that cannot be written.
pub fn run(args: &BlobsArgs, console: &Console) -> Result<()> {
    let mut model = args.skin.load()?;
    let input = ImageInput::open(&args.input)?;
    if let Some(path) = &args.out {
        check_writable_file(path)?;
    }
    let likelihood = HandLikelihood::default();
    let mut reader = FrameReader::new(likelihood, EdgeDetector::default())?;
    let mut found: Vec<(String, u32, Vec<LikelyBlob>)> = Vec::new();
    let mut skipped = Skipped::new(args.strict, *console);
    load_each(&input, &args.skin, &mut model, &mut skipped, |model, index, image| {
        let view = blobs_alone(&mut reader, model, image)?;
        let name = match &input {
            ImageInput::Files(files) => file_name(&files[index]),
            ImageInput::Video(file) => frame_name(file, index),
        };
        if view.dropped_blobs > 0 {
            console.note(format!("`{name}`: {} less likely blobs are left out", view.dropped_blobs));
        }
        found.push((name, image.width() * image.height(), view.blobs));
        Ok(())
    })?;
    let rows: Vec<BlobRow<'_>> = found
        .iter()
        .flat_map(|(name, area, blobs)| {
            blobs.iter().enumerate().map(move |(number, blob)| BlobRow::new((name, number), blob, likelihood, *area))
        })
        .collect();
    let text = match args.format {
        TableFormat::Csv => csv_text(&rows)?,
        TableFormat::Json => serde_json::to_string_pretty(&rows)? + "\n",
    };
    match &args.out {
        Some(path) => {
            write_atomically(path, |writer| Ok(writer.write_all(text.as_bytes())?))?;
            let (images, blobs, reasons) = (found.len(), rows.len(), skipped.reasons());
            console.answer("", &json!({ "images": images, "blobs": blobs, "skipped": reasons, "out": path }))?;
        }
        None => console.answer(&text, &rows)?,
    }
    skipped.whole()
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn csv_text(rows: &[BlobRow<'_>]) -> Result<String> {
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    writer.write_record(COLUMNS)?;
    for row in rows {
        writer.serialize(BlobRow { image: &name_cell(row.image), ..*row })?;
    }
    Ok(String::from_utf8(writer.into_inner()?)?)
}
