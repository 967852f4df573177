//! Pixel scores of a skin model on images with masks.

use crate::skin_faces::{Faces, by_face, outside_head, skin_lightness};
use anyhow::{Result, bail, ensure};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use serde_json::json;
use sinew::resume::Cells;
use sinew::signal::median::median;
use sinew::skin::SkinModel;
use sinew::skin::confusion::Confusion;
use sinew::skin::folds;
use sinew::skin::pairs::{Pair, PairList};
use sinew::skin::training::{TrainingOptions, pairs_set, train};

/// L* above which skin is pale: the upper quartile of the images of `skin/ecu` and
/// `skin/pratheepan`.
pub const MIN_PALE_LIGHTNESS: f64 = 71.0;

/// Images that are scored together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Part {
    /// All.
    All,
    /// Those whose face gave the colour of skin.
    Face,
    /// Those whose skin has a median L* above [`MIN_PALE_LIGHTNESS`].
    Pale,
}

impl Part {
    /// Whether an image belongs to it.
    #[must_use]
    pub fn has(self, image: &JudgedImage) -> bool {
        match self {
            Self::All => true,
            Self::Face => image.is_by_face,
            Self::Pale => image.lightness.is_some_and(|lightness| lightness > MIN_PALE_LIGHTNESS),
        }
    }
}

/// Scores of a part of one folder pair, or of all.
#[derive(Debug, Clone, Serialize)]
pub struct FolderScores {
    /// The folder's name.
    pub images_folder: String,
    /// Which of its images.
    pub part: Part,
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
    /// F1 over the pixels outside of the heads that were found; none where no face was looked for.
    pub f1_outside_head: Option<f64>,
}

/// Decisions on one image.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct JudgedImage {
    /// On all pixels.
    pub pixels: Confusion,
    /// On those outside of the head, if a face was looked for.
    pub outside_head: Option<Confusion>,
    /// Whether the colour of a face decided.
    pub is_by_face: bool,
    /// Median L* of the labelled skin.
    pub lightness: Option<f64>,
}

/// Decisions on each image, or why it could not be read.
pub type Judged = Vec<Result<JudgedImage, String>>;

/// What judges images.
#[derive(Debug, Clone, Copy)]
pub struct Judge<'a> {
    /// The model, for images without a face.
    pub model: &'a SkinModel,
    /// Where faces are looked for.
    pub faces: Option<&'a Faces>,
    /// Whether masks are opened and closed as the tracker's are.
    pub morphology: bool,
}

/// Images of one cell.
const IMAGES_OF_CELL: usize = 10;

/// Judges each pair.
///
/// # Errors
/// An image without pixels, a mask of another size; as [`Cells::cell`].
pub fn judge(pairs: &[Pair], judge: Judge<'_>, cells: &Cells<'_>) -> Result<Judged> {
    let of_cell = |(index, pairs): (usize, &[Pair])| {
        cells.cell(&json!(["images", index]), || pairs.par_iter().map(|pair| one(pair, judge)).collect())
    };
    let judged: Vec<Judged> = pairs.par_chunks(IMAGES_OF_CELL).enumerate().map(of_cell).collect::<Result<_>>()?;
    Ok(judged.into_iter().flatten().collect())
}

fn one(pair: &Pair, judge: Judge<'_>) -> Result<Result<JudgedImage, String>> {
    let (image, truth) = match pair.load()? {
        Ok(loaded) => loaded,
        Err(unreadable) => return Ok(Err(unreadable.to_string())),
    };
    let face = judge.faces.and_then(|faces| faces.detector.find(image.as_raw(), image.dimensions()));
    let adapting = face.filter(|_| judge.faces.is_some_and(|faces| faces.adapt));
    let by_face = adapting.and_then(|face| by_face(&image, &face)).transpose()?;
    let is_by_face = by_face.is_some();
    let mut found = by_face.map_or_else(|| judge.model.classify(&image), Ok)?;
    if judge.morphology {
        found.clean()?;
    }
    let lightness = skin_lightness(&image, &truth)?;
    let pixels = Confusion::of(&found, &truth);
    let outside_head = judge.faces.map(|_| outside_head(found, truth, face.map(|face| face.head))).transpose()?;
    Ok(Ok(JudgedImage { pixels, outside_head, is_by_face, lightness }))
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
        let judged = |morphology| {
            own.par_iter().map(|pair| one(pair, Judge { model: &model, faces: None, morphology })).collect()
        };
        morphologies.into_iter().map(judged).collect()
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

/// The scores of each folder pair, and with `faces` those of its parts and of all pairs together.
///
/// # Errors
/// A folder of which no pair can be read.
pub fn by_folder(list: &PairList, judged: &Judged, faces: bool) -> Result<Vec<FolderScores>> {
    let images = |group: Option<usize>| -> Vec<JudgedImage> {
        let of_group = list.pairs.iter().zip(judged).filter(|(pair, _)| group.is_none_or(|group| pair.group == group));
        of_group.filter_map(|(_, image)| image.as_ref().ok().copied()).collect()
    };
    let parts = if faces { [Part::All, Part::Face, Part::Pale].as_slice() } else { &[Part::All] };
    let mut rows = Vec::new();
    for (group, name) in list.groups.iter().enumerate() {
        let images = images(Some(group));
        if images.is_empty() {
            bail!("no image-mask pair of {name} can be read");
        }
        rows.extend(parts.iter().filter_map(|part| of_part(name, *part, &images)));
    }
    if faces && list.groups.len() > 1 {
        rows.extend(parts.iter().filter_map(|part| of_part("all folders", *part, &images(None))));
    }
    Ok(rows)
}

/// The scores of a part of some images; `None` where it has none.
fn of_part(name: &str, part: Part, images: &[JudgedImage]) -> Option<FolderScores> {
    let images: Vec<&JudgedImage> = images.iter().filter(|image| part.has(image)).collect();
    let mut f1: Vec<f64> = images.iter().map(|image| image.pixels.scores().f1).collect();
    let median_image_f1 = median(&mut f1)?;
    let pooled = |of: fn(&JudgedImage) -> Option<Confusion>| {
        let mut pooled = Confusion::default();
        images.iter().try_for_each(|image| of(image).map(|counts| pooled.merge(&counts))).map(|()| pooled.scores())
    };
    let scores = pooled(|image| Some(image.pixels))?;
    Some(FolderScores {
        images_folder: name.to_owned(),
        part,
        images: images.len(),
        precision: scores.precision,
        recall: scores.recall,
        f1: scores.f1,
        median_image_f1,
        f1_outside_head: pooled(|image| image.outside_head).map(|scores| scores.f1),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    fn image(true_positive: f64, lightness: f64, is_by_face: bool) -> JudgedImage {
        let pixels = Confusion { true_positive, false_positive: 2.0, false_negative: 2.0 };
        JudgedImage { pixels, outside_head: Some(pixels), is_by_face, lightness: Some(lightness) }
    }

    #[test]
    fn parts_are_scored_in_each_folder_and_over_all() {
        let pair = |group| Pair { image: PathBuf::new(), mask: PathBuf::new(), group };
        let groups = ["a", "b"].map(str::to_owned).to_vec();
        let list = PairList { pairs: vec![pair(0), pair(0), pair(1)], without_mask: Vec::new(), groups };
        let judged = vec![Ok(image(6.0, 80.0, true)), Ok(image(2.0, 50.0, false)), Ok(image(10.0, 75.0, true))];
        let rows = by_folder(&list, &judged, true).unwrap();
        let of = |row: &FolderScores| (row.images_folder.clone(), row.part, row.images, row.f1);
        let expected = [
            ("a", Part::All, 2, 8.0 / 12.0),
            ("a", Part::Face, 1, 0.75),
            ("a", Part::Pale, 1, 0.75),
            ("b", Part::All, 1, 10.0 / 12.0),
            ("b", Part::Face, 1, 10.0 / 12.0),
            ("b", Part::Pale, 1, 10.0 / 12.0),
            ("all folders", Part::All, 3, 18.0 / 24.0),
            ("all folders", Part::Face, 2, 16.0 / 20.0),
            ("all folders", Part::Pale, 2, 16.0 / 20.0),
        ];
        let expected = expected.map(|(name, part, images, f1)| (name.to_owned(), part, images, f1));
        assert_eq!(rows.iter().map(of).collect::<Vec<_>>(), expected);
        assert!(rows.iter().all(|row| row.f1_outside_head == Some(row.f1)));
        assert_eq!(by_folder(&list, &judged, false).unwrap().len(), 2);
    }
}
