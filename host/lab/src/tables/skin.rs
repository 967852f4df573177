//! Scores of the two skin models on the labelled images.

use super::markdown::{Rows, line};
use crate::skin_faces::Faces;
use crate::skin_scores::{Judge, Judged, Part, by_folder, cross_validate, judge};
use anyhow::Result;
use sinew::person::FaceDetector;
use sinew::resume::Cells;
use sinew::skin::SkinModel;
use sinew::skin::model::ModelKind;
use sinew::skin::pairs::{PairList, find};
use sinew::skin::training::TrainingOptions;
use std::path::Path;

/// The labelled sets.
const SETS: [&str; 2] = ["ecu", "pratheepan"];
/// Folds of the cross-validation, and of each choice of a threshold.
const FOLDS: usize = 10;

fn pairs(recordings: &Path) -> Result<PairList> {
    let folder = |part: &str| SETS.map(|set| recordings.join("skin").join(set).join(part)).to_vec();
    Ok(find(&folder("images"), &folder("masks"))?)
}

pub fn scores(recordings: &Path) -> Result<Rows> {
    let list = pairs(recordings)?;
    let mut rows = vec![line(["model", "set", "precision", "recall", "F1", "median F1 of an image"])];
    let gaussian = SkinModel::from_option("gaussian")?;
    let judged =
        |morphology| judge(&list.pairs, Judge { model: &gaussian, faces: None, morphology }, &Cells::not_kept());
    rows.extend(of_model("`gaussian`, shipped (saw neither set)", &list, [judged(false)?, judged(true)?])?);
    let options = TrainingOptions { kind: ModelKind::Histogram, folds: FOLDS, seed: 1 };
    let judged = cross_validate(&list, FOLDS, options, [false, true], &Cells::not_kept())?;
    rows.extend(of_model("`histogram`, 10-fold cross-validated by image", &list, judged)?);
    Ok(rows)
}

/// A row a set, from raw masks and from those after opening and closing.
fn of_model(name: &str, list: &PairList, [raw, cleaned]: [Judged; 2]) -> Result<Rows> {
    let (raw, cleaned) = (by_folder(list, &raw, false)?, by_folder(list, &cleaned, false)?);
    let names = std::iter::once(name).chain(std::iter::repeat(""));
    let rows = names.zip(SETS).zip(raw.iter().zip(&cleaned)).map(|((name, set), (raw, cleaned))| {
        let (precision, recall) = (format!("{:.3}", raw.precision), format!("{:.3}", raw.recall));
        let f1 = format!("{:.3} ({:.3})", raw.f1, cleaned.f1);
        line([name.to_owned(), set.to_owned(), precision, recall, f1, format!("{:.3}", raw.median_image_f1)])
    });
    Ok(rows.collect())
}

/// What the colour of the face is worth on each set, and on pale skin.
pub fn faces(recordings: &Path) -> Result<Rows> {
    let list = pairs(recordings)?;
    let gaussian = SkinModel::from_option("gaussian")?;
    let mut rows = vec![line(["skin by", "images", "number", "precision", "recall", "F1", "F1 outside heads"])];
    for (name, adapt) in [("`gaussian`, shipped", false), ("the colour of the face", true)] {
        let faces = Faces { detector: FaceDetector::new()?, adapt };
        let by = Judge { model: &gaussian, faces: Some(&faces), morphology: false };
        let judged = judge(&list.pairs, by, &Cells::not_kept())?;
        let scores = by_folder(&list, &judged, true)?;
        let names = std::iter::once(name).chain(std::iter::repeat(""));
        let chosen = scores.iter().filter(|row| row.part != Part::Face);
        rows.extend(names.zip(chosen).map(|(name, row)| {
            let set = row.images_folder.trim_end_matches("/images");
            let images = if row.part == Part::Pale { format!("{set}, pale") } else { set.to_owned() };
            let number = |value: f64| format!("{value:.3}");
            let outside = row.f1_outside_head.map(number).unwrap_or_default();
            let [precision, recall, f1] = [row.precision, row.recall, row.f1].map(number);
            line([name.to_owned(), images, row.images.to_string(), precision, recall, f1, outside])
        }));
    }
    Ok(rows)
}
