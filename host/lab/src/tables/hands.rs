//! Hands on webcam frames with reference boxes.

use super::markdown::{Rows, line};
use crate::hand_ranking::{BlobScores, blob_scores};
use crate::hands::{ReferenceBox, load_frames, read_boxes};
use crate::hands_report::{DEFAULT_OPTIONS, report};
use anyhow::Result;
use image::RgbImage;
use sinew::config::Config;
use sinew::resume::Cells;
use sinew::skin::SkinModel;
use sinew::skin::model::DEFAULT_SKIN;
use std::path::Path;

/// The sequences.
const SEQUENCES: [&str; 2] = ["hand1", "hand2"];

fn sequence(recordings: &Path, name: &str) -> Result<(Vec<Option<RgbImage>>, Vec<ReferenceBox>)> {
    let folder = recordings.join("video/handtracking");
    Ok((load_frames(&folder.join(name))?, read_boxes(&folder.join(format!("{name}_boxes.csv")))?))
}

pub fn in_boxes(recordings: &Path) -> Result<Rows> {
    let skin = SkinModel::from_option(DEFAULT_SKIN)?;
    let constant = "two constant points: inside, near";
    let mut rows = vec![line(["sequence", "view", "inside the box", "near its centre", "confused frames", constant])];
    for name in SEQUENCES {
        let (frames, boxes) = sequence(recordings, name)?;
        let report = report(&frames, &boxes, DEFAULT_OPTIONS, &Config::default(), &skin, &Cells::not_kept())?;
        for (view, scores) in [("whole", report.whole), ("window", report.window)] {
            let medians = [scores.inside, scores.centred, scores.confused].map(|share| format!("{:.3}", share.median));
            let mut row = line([format!("{name}, {} boxes", scores.boxes), view.to_owned()]);
            row.extend(medians);
            row.push(format!("{:.3}, {:.3}", scores.constant_inside, scores.constant_centred));
            rows.push(row);
        }
    }
    Ok(rows)
}

pub fn ranking(recordings: &Path) -> Result<Rows> {
    let mut rows = vec![line(["segmentation", "sequence", "hands / others", "filled", "paper", "area alone"])];
    for (skin, described) in [("gaussian", "gaussian (UCI, distance 2.25)"), ("histogram", "histogram")] {
        let skin = SkinModel::from_option(skin)?;
        let mut both = BlobScores::default();
        for (index, name) in SEQUENCES.iter().enumerate() {
            let (frames, boxes) = sequence(recordings, name)?;
            let scores = blob_scores(&frames, &boxes, &skin)?;
            rows.push(ranking_row(if index == 0 { described } else { "" }, name, &scores));
            both.merge(scores);
        }
        rows.push(ranking_row("", "both", &both));
    }
    Ok(rows)
}

fn ranking_row(segmentation: &str, sequence: &str, scores: &BlobScores) -> Vec<String> {
    let area = |area: Option<f64>| area.map_or_else(|| "none".to_owned(), |area| format!("{area:.2}"));
    let ranking = scores.ranking();
    let counts = format!("{} / {}", ranking.hands, ranking.others);
    let filled = format!("**{}**", area(ranking.filled_area));
    let (paper, alone) = (area(ranking.paper_area), area(scores.area_alone()));
    line([segmentation.to_owned(), sequence.to_owned(), counts, filled, paper, alone])
}
