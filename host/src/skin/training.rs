//! From files to a trained model.

use super::labelled_pixels;
use super::model::TrainedOn;
use super::model::{ModelKind, ModelNumbers, SkinModel};
use super::pairs::{Pair, PairList, short_name};
use super::threshold::Choice;
use super::training_set::{Source, TrainingSet, Unit};
use super::{gaussian, histogram};
use crate::error::{Result, bail, ensure};
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// Fewest units a cross-validation makes sense with.
const MIN_UNITS: usize = 2;

/// How to train.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TrainingOptions {
    /// Kind of model.
    pub kind: ModelKind,
    /// Folds of the cross-validation, at least 2; never more than there are units.
    pub folds: usize,
    /// Seed of sampling and shuffling.
    pub seed: u64,
}

/// The training set of a file of labelled pixels.
///
/// # Errors
/// As [`labelled_pixels::read`].
pub fn pixels_set(path: &Path, seed: u64) -> Result<TrainingSet> {
    let pixels = labelled_pixels::read(path)?;
    Ok(TrainingSet::from_pixels(short_name(path), &pixels, seed))
}

/// The training set of image-mask pairs, and the files that could not be read with the reason, in
/// order.
///
/// # Errors
/// A mask whose size is not that of its image; no pair that can be read.
pub fn pairs_set(list: &PairList, seed: u64) -> Result<(TrainingSet, Vec<(PathBuf, String)>)> {
    let sample = |(index, pair): (usize, &Pair)| -> Result<Result<Unit, (PathBuf, String)>> {
        match pair.load()? {
            Ok((image, mask)) => Ok(Ok(Unit::from_image(&image, &mask, pair.group, seed, index as u32))),
            Err(unreadable) => Ok(Err((unreadable.path.clone(), unreadable.reason))),
        }
    };
    let sampled: Vec<_> = list.pairs.par_iter().enumerate().map(sample).collect::<Result<_>>()?;
    let (mut units, mut skipped) = (Vec::new(), Vec::new());
    for unit in sampled {
        match unit {
            Ok(unit) => units.push(unit),
            Err(unreadable) => skipped.push(unreadable),
        }
    }
    if let (true, Some((path, reason))) = (units.is_empty(), skipped.first()) {
        bail!("no image-mask pair can be read; the first: `{}`: {reason}", path.display());
    }
    Ok((TrainingSet { source: Source::Images, groups: list.groups.clone(), units }, skipped))
}

/// Trains a model on all units, with its threshold chosen by cross-validation.
///
/// # Errors
/// Too few units or folds, or units that lack skin or other pixels.
pub fn train(set: &TrainingSet, options: TrainingOptions) -> Result<(SkinModel, Choice)> {
    ensure!(options.folds >= 2, "--folds {} has to be 2 or more", options.folds);
    ensure!(
        set.units.len() >= MIN_UNITS,
        "cross-validation needs {MIN_UNITS} image-mask pairs or more; {} can be used",
        set.units.len()
    );
    let folds = options.folds.min(set.units.len());
    let (numbers, choice) = match options.kind {
        ModelKind::Gaussian => {
            let (model, choice) = gaussian::train(set, folds, options.seed)?;
            (ModelNumbers::Gaussian(model), choice)
        }
        ModelKind::Histogram => {
            let (model, choice) = histogram::train(set, folds, options.seed)?;
            (ModelNumbers::Histogram(model), choice)
        }
    };
    let (skin_pixels, other_pixels) = set.pixel_counts();
    let images = match set.source {
        Source::Images => set.units.len() as u64,
        Source::PixelList => 0,
    };
    let trained_on = TrainedOn {
        sources: set.groups.clone(),
        images,
        skin_pixels,
        other_pixels,
        folds: folds as u64,
        seed: options.seed,
        cross_validated: choice.scores,
    };
    Ok((SkinModel::new(numbers, trained_on)?, choice))
}
