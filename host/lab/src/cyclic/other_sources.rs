//! Walks of two sources that no shipped model was trained on. They are kept for reporting.

use super::rate::DEFAULT_RATE_HZ;
use super::tempo::Walk;
use anyhow::{Context, Result};
use sinew::cyclic::AngleRow;
use sinew::cyclic::cutting::{CuttingOptions, cycles};
use sinew::cyclic::recording::{RecordingOptions, angles};
use std::ops::Range;
use std::path::Path;

/// Their files below the folder of recorded motions.
pub const WALKS: [&str; 8] = [
    "bandai/dataset-1_walk_feminine_001.bvh",
    "bandai/dataset-1_walk_happy_001.bvh",
    "bandai/dataset-1_walk_tired_001.bvh",
    "bandai/dataset-2_walk_elderly_001.bvh",
    "bandai/dataset-2_walk_elderly_002.bvh",
    "bandai/dataset-2_walk_normal_001.bvh",
    "bandai/dataset-2_walk_normal_002.bvh",
    "pymo/AV_8Walk_Meredith_HVHA_Rep1.bvh",
];

/// A part of a recording: its file, the file of its skeleton where that is another, and frames.
pub type Excerpt = (&'static str, Option<&'static str>, Range<usize>);

/// Angles of a part of a recording below `mocap`, a row a frame.
///
/// # Errors
/// The recording cannot be read.
pub fn excerpt(mocap: &Path, (file, skeleton, frames): Excerpt) -> Result<Vec<AngleRow>> {
    let skeleton = skeleton.map(|skeleton| mocap.join(skeleton));
    let options = RecordingOptions { rate_hz: Some(DEFAULT_RATE_HZ), skeleton, ..RecordingOptions::default() };
    let rows = angles(&mocap.join(file), &options)?.table.rows().to_vec();
    Ok(rows.into_iter().take(frames.end).skip(frames.start).collect())
}

/// [`WALKS`] below `mocap`, from the first cycle that `sinew cut` finds to the end of the last.
///
/// # Errors
/// A recording cannot be read, or shows no cycles.
pub fn walks(mocap: &Path) -> Result<Vec<Walk>> {
    WALKS.iter().map(|file| walk(mocap, file).with_context(|| format!("`{file}`"))).collect()
}

fn walk(mocap: &Path, file: &str) -> Result<Walk> {
    let options = RecordingOptions { rate_hz: Some(DEFAULT_RATE_HZ), ..RecordingOptions::default() };
    let table = angles(&mocap.join(file), &options)?.table;
    let cuts = cycles(&table, file, CuttingOptions::default())?;
    let (first, last) = cuts.first().zip(cuts.last()).context("there is no cycle")?;
    let (first_frame, last_frame) = (first.start_frame, last.end_frame);
    let rows = table.rows().iter().filter(|row| (first_frame..=last_frame).contains(&row.frame)).cloned().collect();
    let borders = cuts.iter().map(|cut| cut.start_frame - first_frame).chain([last_frame - first_frame]).collect();
    Ok(Walk { name: file.to_owned(), rows, borders })
}
