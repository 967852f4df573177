//! A folder of video frames, as `sinew track arm` takes it.

use super::diagnosis::{Diagnosis, Severity};
use crate::images::load_rgb;
use crate::pixels::{GREY, is_grey};
use crate::skin::SkinModel;
use crate::skin::model::DEFAULT_SKIN;
use crate::track::gaps::Numbering;
use image::RgbImage;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Images whose pixels are looked at.
const SAMPLES: usize = 8;
/// Mean of the brightest colour of a pixel below which a frame counts as dark.
const DARK: f64 = 50.0;
/// Share of a frame that may be skin-coloured: less and no hand is seen, more and the background
/// is.
const SKIN_SHARES: [f64; 2] = [0.002, 0.35];

pub(super) fn examine(path: &Path, files: &[PathBuf]) -> Diagnosis {
    let mut diagnosis = Diagnosis::new(path, "folder of images");
    let read: Vec<Result<(u32, u32), String>> = files
        .par_iter()
        .map(|file| load_rgb(file).map(|image| image.dimensions()).map_err(|error| error.to_string()))
        .collect();
    diagnosis.add(Severity::Good, format!("{} images, tracked in natural order of their names", files.len()));
    for reason in read.iter().filter_map(|size| size.as_ref().err()) {
        diagnosis.add(Severity::Warning, format!("{reason}; the frame would be a prediction"));
    }
    let mut sizes: BTreeMap<(u32, u32), usize> = BTreeMap::new();
    read.iter().flatten().for_each(|size| *sizes.entry(*size).or_default() += 1);
    let words: Vec<String> =
        sizes.iter().map(|((width, height), count)| format!("{count} of {width}x{height}")).collect();
    match words.as_slice() {
        [] => diagnosis.add(Severity::Problem, "no image can be read; give a folder of intact images"),
        [one] => diagnosis.add(Severity::Good, format!("one size: {one} pixels")),
        _ => {
            diagnosis
                .add(Severity::Problem, format!("images differ in size ({}); take odd ones out", words.join(", ")));
        }
    }
    numbering(&mut diagnosis, files);
    pixels(&mut diagnosis, files);
    diagnosis
}

/// Gaps in the numbers of the names.
fn numbering(diagnosis: &mut Diagnosis, files: &[PathBuf]) {
    let Some(numbering) = Numbering::of(files) else {
        diagnosis.add(Severity::Warning, "the names do not number the frames; see that their order is that of time");
        return;
    };
    let ([first, last], predicted, missing) = (numbering.ends(), numbering.missing(), numbering.unused());
    if predicted > 0 {
        let text = format!("{predicted} pictures between {first} and {last} are missing; their frames are predictions");
        diagnosis.add(Severity::Warning, text);
    } else if missing > 0 {
        let text = format!(
            "{missing} numbers between {first} and {last} have no image; frames are taken as evenly spaced, give --rate accordingly"
        );
        diagnosis.add(Severity::Warning, text);
    }
}

/// Light and skin in some of the images.
fn pixels(diagnosis: &mut Diagnosis, files: &[PathBuf]) {
    let step = files.len().div_ceil(SAMPLES).max(1);
    let images: Vec<RgbImage> = files.iter().step_by(step).filter_map(|file| load_rgb(file).ok()).collect();
    if images.is_empty() {
        return;
    }
    let mean = |values: Vec<f64>| values.iter().sum::<f64>() / values.len().max(1) as f64;
    let light = mean(images.iter().map(brightness).collect());
    if light < DARK {
        diagnosis.add(
            Severity::Warning,
            format!("the images are dark (mean brightness {light:.0} of 255); skin is found badly: more light"),
        );
    }
    let Ok(model) = SkinModel::from_option(DEFAULT_SKIN) else { return };
    let share = mean(images.iter().filter_map(|image| skin_share(&model, image)).collect());
    let percent = 100.0 * share;
    if images.iter().all(is_grey) {
        diagnosis.add(Severity::Warning, format!("the images are grey; {GREY}"));
        return;
    }
    let [least, most] = SKIN_SHARES;
    let remedy = "show the tracker skin by --calibrate X,Y,W,H, or train a model (docs/skin.md)";
    if share < least {
        diagnosis.add(Severity::Warning, format!("only {percent:.2} % of the pixels are skin-coloured; {remedy}"));
    } else if share > most {
        diagnosis.add(
            Severity::Warning,
            format!("{percent:.0} % of the pixels are skin-coloured, the background too; {remedy}"),
        );
    } else {
        diagnosis.add(Severity::Good, format!("{percent:.1} % of the pixels are skin-coloured"));
    }
}

fn brightness(image: &RgbImage) -> f64 {
    let sum: u64 = image.pixels().map(|pixel| u64::from(pixel.0.into_iter().max().unwrap_or(0))).sum();
    sum as f64 / f64::from(image.width() * image.height()).max(1.0)
}

fn skin_share(model: &SkinModel, image: &RgbImage) -> Option<f64> {
    let mask = model.classify(image).ok()?.to_gray();
    let skin = mask.pixels().filter(|pixel| pixel.0[0] > 0).count();
    Some(skin as f64 / f64::from(image.width() * image.height()).max(1.0))
}
