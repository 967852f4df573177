//! Pixel scores of a skin model on images with masks.

use anyhow::{Result, bail, ensure};
use rayon::prelude::*;
use serde::Serialize;
use serde_json::json;
use sinew::resume::Cells;
use sinew::skin::SkinModel;
use sinew::skin::confusion::{Confusion, median};
use sinew::skin::folds;
use sinew::skin::pairs::{Pair, PairList};
use sinew::skin::training::{TrainingOptions, pairs_set, train};

/// Scores of one folder pair.
#[derive(Debug, Clone, Serialize)]
pub struct FolderScores {
    /// The folder's name.
    pub images_folder: String,
    /// Images that were read.
    pub images: usize,
    /// Precision over the pixels of all images.
    pub precision: f64,
    /// Recall over the pixels of all images.
    pub recall: f64,
    /// F1 over the pixels of all images.
    pub f1: f64,
    /// Median over the images of their own F1.
    pub median_image_f1: f64,
}

/// Decisions on each image, or why it could not be read.
pub type Judged = Vec<Result<Confusion, String>>;

/// Images of one cell.
const IMAGES_OF_CELL: usize = 10;

/// Judges each pair by `model`, after the tracker's opening and closing where `morphology` is set.
///
/// # Errors
/// An image without pixels, a mask of another size; as [`Cells::cell`].
pub fn judge(pairs: &[Pair], model: &SkinModel, morphology: bool, cells: &Cells<'_>) -> Result<Judged> {
    let of_cell = |(index, pairs): (usize, &[Pair])| {
        cells.cell(&json!(["images", index]), || pairs.par_iter().map(|pair| one(pair, model, morphology)).collect())
    };
    let judged: Vec<Judged> = pairs.par_chunks(IMAGES_OF_CELL).enumerate().map(of_cell).collect::<Result<_>>()?;
    Ok(judged.into_iter().flatten().collect())
}

fn one(pair: &Pair, model: &SkinModel, morphology: bool) -> Result<Result<Confusion, String>> {
    let (image, truth) = match pair.load()? {
        Ok(loaded) => loaded,
        Err(unreadable) => return Ok(Err(unreadable.to_string())),
    };
    let mut found = model.classify(&image)?;
    if morphology {
        found.clean()?;
    }
    Ok(Ok(Confusion::of(&found, &truth)))
}

/// Judges each pair by a model that was trained on the images of the `count` - 1 folds in which it
/// is not. It does so once for each of `morphologies`. A cell is a fold.
///
/// # Errors
/// An image that cannot be read, fewer images than folds, images without skin; as [`judge`].
pub fn cross_validate<const N: usize>(
    list: &PairList,
    count: usize,
    options: TrainingOptions,
    morphologies: [bool; N],
    cells: &Cells<'_>,
) -> Result<[Judged; N]> {
    let (set, skipped) = pairs_set(list, options.seed)?;
    if let Some((path, reason)) = skipped.first() {
        bail!("`{}`: {reason}; remove the pair before a cross-validation", path.display());
    }
    let images = set.units.len();
    ensure!(count <= images, "--cross-validate {count} needs as many images; there are {images}");
    let fold_of = folds::assign(images, count, options.seed);
    let of_fold = |fold: usize| -> Result<Vec<Judged>> {
        let model = train(&set.subset(|index| fold_of[index] != fold), options)?.0;
        let own: Vec<&Pair> =
            (0..images).filter(|index| fold_of[*index] == fold).map(|index| &list.pairs[index]).collect();
        let judged = |morphology| own.par_iter().map(|pair| one(pair, &model, morphology)).collect();
        morphologies.iter().map(|morphology| judged(*morphology)).collect()
    };
    let kept = |fold: usize| cells.cell(&json!(["fold", fold]), || of_fold(fold));
    let of_folds: Vec<Vec<Judged>> = (0..count).into_par_iter().map(kept).collect::<Result<_>>()?;
    let mut rest: Vec<Vec<_>> =
        of_folds.into_iter().map(|of_fold| of_fold.into_iter().map(Judged::into_iter).collect()).collect();
    Ok(std::array::from_fn(|of| {
        // In the order of the list: each fold's are in that order.
        fold_of.iter().filter_map(|fold| rest[*fold][of].next()).collect()
    }))
}

/// The scores of each folder pair.
///
/// # Errors
/// A folder of which no pair can be read.
pub fn by_folder(list: &PairList, judged: &Judged) -> Result<Vec<FolderScores>> {
    let mut rows = Vec::new();
    for (group, name) in list.groups.iter().enumerate() {
        let of_group = list.pairs.iter().zip(judged).filter(|(pair, _)| pair.group == group);
        let confusions: Vec<&Confusion> = of_group.filter_map(|(_, image)| image.as_ref().ok()).collect();
        let mut pooled = Confusion::default();
        confusions.iter().for_each(|confusion| pooled.merge(confusion));
        let Some(median_image_f1) = median(confusions.iter().map(|confusion| confusion.scores().f1).collect()) else {
            bail!("no image-mask pair of {name} can be read");
        };
        let scores = pooled.scores();
        rows.push(FolderScores {
            images_folder: name.clone(),
            images: confusions.len(),
            precision: scores.precision,
            recall: scores.recall,
            f1: scores.f1,
            median_image_f1,
        });
    }
    Ok(rows)
}
