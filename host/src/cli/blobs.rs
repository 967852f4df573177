//! `sinew blobs`: features and hand likelihood of each blob.

use super::console::Console;
use super::image_run::{Skipped, load_each};
use super::skin_args::SkinArgs;
use crate::csv_text::name_cell;
use crate::frames::FrameReader;
use crate::images::ImageInput;
use crate::images::video::frame_name;
use crate::output::{check_writable_file, write_atomically};
use anyhow::Result;
use clap::{Args, ValueEnum};
use image::RgbImage;
use serde::Serialize;
use serde_json::json;
use sinew_core::vision::blobs::LikelyBlob;
use sinew_core::vision::edges::EdgeDetector;
use sinew_core::vision::hand_likelihood::{HandLikelihood, LikelihoodForm};
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

/// One blob: a row of the table, the most likely blob of an image first.
#[derive(Debug, Clone, Copy, Serialize)]
struct BlobRow<'a> {
    image: &'a str,
    /// Number of the blob in its image, from 0.
    blob: usize,
    hand_likelihood: f32,
    /// Hand likelihood in the form printed in the paper.
    paper_likelihood: f32,
    area_px: u32,
    centroid_u_px: f32,
    centroid_v_px: f32,
    left_px: u16,
    top_px: u16,
    width_px: u32,
    height_px: u32,
    perimeter_px: f32,
    dt_max_px: f32,
    centrality: f32,
    ellipse_iou: f32,
    filled_area_px: f32,
    filled_perimeter_px: f32,
    filled_dt_max_px: f32,
    filled_centrality: f32,
    filled_ellipse_iou: f32,
    palm_u_px: f32,
    palm_v_px: f32,
    moment_uu_px2: f32,
    moment_uv_px2: f32,
    moment_vv_px2: f32,
}

/// Columns of the table, which has a header even if there is no blob.
const COLUMNS: [&str; 25] = [
    "image",
    "blob",
    "hand_likelihood",
    "paper_likelihood",
    "area_px",
    "centroid_u_px",
    "centroid_v_px",
    "left_px",
    "top_px",
    "width_px",
    "height_px",
    "perimeter_px",
    "dt_max_px",
    "centrality",
    "ellipse_iou",
    "filled_area_px",
    "filled_perimeter_px",
    "filled_dt_max_px",
    "filled_centrality",
    "filled_ellipse_iou",
    "palm_u_px",
    "palm_v_px",
    "moment_uu_px2",
    "moment_uv_px2",
    "moment_vv_px2",
];

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
    let mut found: Vec<(String, AreaPx, Vec<LikelyBlob>)> = Vec::new();
    let mut skipped = Skipped::new(args.strict, *console);
    load_each(&input, &args.skin, &mut model, &mut skipped, |model, index, image| {
        reader.forget_last_frame();
        let view = reader.read(image, &*model.for_image(image)?)?;
        let name = match &input {
            ImageInput::Files(files) => file_name(&files[index]),
            ImageInput::Video(file) => frame_name(file, index),
        };
        if view.dropped_blobs > 0 {
            console.note(format!("`{name}`: {} less likely blobs are left out", view.dropped_blobs));
        }
        found.push((name, area_px(image), view.blobs));
        Ok(())
    })?;
    let rows: Vec<BlobRow<'_>> = found
        .iter()
        .flat_map(|(name, area, blobs)| {
            blobs.iter().enumerate().map(move |(number, blob)| row(name, number, blob, likelihood, *area))
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

/// Area of an image, pixels.
type AreaPx = f32;

fn area_px(image: &RgbImage) -> AreaPx {
    (image.width() * image.height()) as f32
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn row<'a>(
    image: &'a str,
    number: usize,
    entry: &LikelyBlob,
    likelihood: HandLikelihood,
    image_area_px: f32,
) -> BlobRow<'a> {
    let blob = &entry.blob;
    let (bounds, palm) = (blob.bounding_box, blob.palm_centre());
    BlobRow {
        image,
        blob: number,
        hand_likelihood: entry.likelihood,
        paper_likelihood: likelihood.with_form(LikelihoodForm::Paper).evaluate(blob, image_area_px),
        area_px: blob.area_px,
        centroid_u_px: blob.centroid.u_px,
        centroid_v_px: blob.centroid.v_px,
        left_px: bounds.min_u,
        top_px: bounds.min_v,
        width_px: bounds.width_px(),
        height_px: bounds.height_px(),
        perimeter_px: blob.plain.perimeter_px,
        dt_max_px: blob.plain.dt_max_px,
        centrality: blob.plain.centrality(),
        ellipse_iou: blob.plain.ellipse_iou,
        filled_area_px: blob.filled.area_px,
        filled_perimeter_px: blob.filled.perimeter_px,
        filled_dt_max_px: blob.filled.dt_max_px,
        filled_centrality: blob.filled.centrality(),
        filled_ellipse_iou: blob.filled.ellipse_iou,
        palm_u_px: palm.u_px,
        palm_v_px: palm.v_px,
        moment_uu_px2: blob.moments_px2[0],
        moment_uv_px2: blob.moments_px2[1],
        moment_vv_px2: blob.moments_px2[2],
    }
}

fn csv_text(rows: &[BlobRow<'_>]) -> Result<String> {
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    writer.write_record(COLUMNS)?;
    for row in rows {
        writer.serialize(BlobRow { image: &name_cell(row.image), ..*row })?;
    }
    Ok(String::from_utf8(writer.into_inner()?)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_names_the_fields_in_order() {
        let blob = LikelyBlob { likelihood: 0.5, ..a_blob() };
        let row = row("a.png", 0, &blob, HandLikelihood::default(), 1.0e4);
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.serialize(row).unwrap();
        let text = String::from_utf8(writer.into_inner().unwrap()).unwrap();
        assert_eq!(text.lines().next().unwrap(), COLUMNS.join(","));
    }

    fn a_blob() -> LikelyBlob {
        let mut reader = FrameReader::new(HandLikelihood::default(), EdgeDetector::default()).unwrap();
        let skin = crate::skin::SkinModel::from_option("gaussian").unwrap();
        let image = RgbImage::from_fn(90, 90, |u, v| {
            image::Rgb(if (20..60).contains(&u) && (20..60).contains(&v) { [196, 140, 115] } else { [90, 120, 200] })
        });
        reader.read(&image, &skin).unwrap().blobs[0]
    }
}
