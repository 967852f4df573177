//! Scores of the two skin models on the labelled images.

use super::markdown::{Rows, line};
use crate::skin_scores::{Judged, by_folder, cross_validate, judge};
use anyhow::Result;
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

pub fn scores(recordings: &Path) -> Result<Rows> {
    let folder = |part: &str| SETS.map(|set| recordings.join("skin").join(set).join(part)).to_vec();
    let list = find(&folder("images"), &folder("masks"))?;
    let mut rows = vec![line(["model", "set", "precision", "recall", "F1", "median F1 of an image"])];
    let gaussian = SkinModel::from_option("gaussian")?;
    let judged = |morphology| judge(&list.pairs, &gaussian, morphology, &Cells::not_kept());
    rows.extend(of_model("`gaussian`, shipped (saw neither set)", &list, [judged(false)?, judged(true)?])?);
    let options = TrainingOptions { kind: ModelKind::Histogram, folds: FOLDS, seed: 1 };
    let judged = cross_validate(&list, FOLDS, options, [false, true], &Cells::not_kept())?;
    rows.extend(of_model("`histogram`, 10-fold cross-validated by image", &list, judged)?);
    Ok(rows)
}

/// A row a set, from raw masks and from those after opening and closing.
fn of_model(name: &str, list: &PairList, [raw, cleaned]: [Judged; 2]) -> Result<Rows> {
    let (raw, cleaned) = (by_folder(list, &raw)?, by_folder(list, &cleaned)?);
    let names = std::iter::once(name).chain(std::iter::repeat(""));
    let rows = names.zip(SETS).zip(raw.iter().zip(&cleaned)).map(|((name, set), (raw, cleaned))| {
        let (precision, recall) = (format!("{:.3}", raw.precision), format!("{:.3}", raw.recall));
        let f1 = format!("{:.3} ({:.3})", raw.f1, cleaned.f1);
        line([name.to_owned(), set.to_owned(), precision, recall, f1, format!("{:.3}", raw.median_image_f1)])
    });
    Ok(rows.collect())
}
