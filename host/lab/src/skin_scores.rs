//! Pixel scores of a skin model on images with masks.

use anyhow::{Result, bail, ensure};
use rayon::prelude::*;
use serde::Serialize;
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

/// Judges each pair by the model that `model_of` has for its number, after the tracker's opening
/// and closing where `morphology` is set.
///
/// # Errors
/// An image without pixels, a mask of another size.
pub fn judge<'m>(pairs: &[Pair], model_of: impl Fn(usize) -> &'m SkinModel + Sync, morphology: bool) -> Result<Judged> {
    let one = |(index, pair): (usize, &Pair)| -> Result<Result<Confusion, String>> {
        let (image, truth) = match pair.load()? {
            Ok(loaded) => loaded,
            Err(unreadable) => return Ok(Err(unreadable.to_string())),
        };
        let mut found = model_of(index).classify(&image)?;
        if morphology {
            found.clean()?;
        }
        Ok(Ok(Confusion::of(&found, &truth)))
    };
    pairs.par_iter().enumerate().map(one).collect()
}

/// The folds of a cross-validation with their models.
#[derive(Debug)]
pub struct Folds {
    fold_of: Vec<usize>,
    models: Vec<SkinModel>,
}

impl Folds {
    /// Trains a model for each of `count` folds on the images of the others.
    ///
    /// # Errors
    /// An image that cannot be read, fewer images than folds, images without skin.
    pub fn train(list: &PairList, count: usize, options: TrainingOptions) -> Result<Self> {
        let seed = options.seed;
        let (set, skipped) = pairs_set(list, seed)?;
        if let Some((path, reason)) = skipped.first() {
            bail!("`{}`: {reason}; remove the pair before a cross-validation", path.display());
        }
        let images = set.units.len();
        ensure!(count <= images, "--cross-validate {count} needs as many images; there are {images}");
        let fold_of = folds::assign(images, count, seed);
        let train_fold = |fold: usize| {
            let rest = set.subset(|index| fold_of[index] != fold);
            Ok(train(&rest, options)?.0)
        };
        let models: Vec<SkinModel> = (0..count).into_par_iter().map(train_fold).collect::<Result<_>>()?;
        Ok(Self { fold_of, models })
    }

    /// Judges each pair by the model that was not trained on it.
    ///
    /// # Errors
    /// As [`judge`].
    pub fn judge(&self, list: &PairList, morphology: bool) -> Result<Judged> {
        judge(&list.pairs, |index| &self.models[self.fold_of[index]], morphology)
    }
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
